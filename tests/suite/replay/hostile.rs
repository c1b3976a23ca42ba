//! Records that somebody has made up, and files that are cut or damaged: errors that say what is wrong, and no file but
//! those that the command line names.

use std::fs;
use std::io::Write;
use std::path::Path;

use flate2::write::ZlibEncoder;
use moire::internal::output::{Format, WriteOptions, record, to_bytes_with};
use serde_json::{Value, json};

use super::{FORMATS, SCENE, record_of, refused, rendered, stage};
use crate::support::gradient;

/// Returns the bytes of a small picture with this record.
pub fn picture(format: Format, text: &str) -> Vec<u8> {
    let text = &record::ascii(text);
    to_bytes_with(&gradient(4, 4), format, &WriteOptions { record: Some(text), ..Default::default() })
        .unwrap()
}

pub fn honest() -> Value {
    json!({
        "program": "moire",
        "version": "0.1.0",
        "scene": { "path": "scenes/floor.toml", "bytes": SCENE.len(), "text": SCENE },
        "options": ["--size=8x8", "--spp=1", "--device=oracle"],
        "device": "oracle",
    })
}

/// Writes `x.png` with a record, lets it be made again, and returns what is said.
pub fn told_of(folder: &Path, text: &str) -> String {
    fs::write(folder.join("x.png"), picture(Format::Png, text)).unwrap();
    refused(folder, &["--from", "x.png", "-o", "y.png"])
}

#[test]
fn an_honest_record_is_obeyed() {
    let folder = stage();
    fs::write(folder.path().join("x.png"), picture(Format::Png, &honest().to_string())).unwrap();
    rendered(folder.path(), &["--from", "x.png", "-o", "y.png"]);
}

#[test]
fn a_picture_of_a_programs_arrays_is_not_made_again_without_them() {
    let folder = stage();
    let mut record = honest();
    record["scene"]["arrays"] = json!(["floor"]);
    let told = told_of(folder.path(), &record.to_string());
    assert!(told.contains("texture \"floor\" was an array of the program that rendered it"), "{told}");
    assert!(!folder.path().join("y.png").exists());
}

#[test]
fn options_that_decide_no_pixels_are_refused() {
    let folder = stage();
    let own = folder.path().join("stolen.png");
    for option in [
        format!("-o={}", own.display()),
        format!("-o{}", own.display()),
        format!("--output={}", own.display()),
        format!("--out={}", own.display()),
        "--from=x.png".into(),
        "--no-metadata".into(),
        "--json".into(),
        "--aov=level".into(),
        "--format=png".into(),
        "--unknown".into(),
        "--".into(),
        "scenes/floor.toml".into(),
        "-v".into(),
        "".into(),
        "--spp\u{0}=1".into(),
    ] {
        let mut record = honest();
        record["options"] = json!(["--spp=1", option]);
        let told = told_of(folder.path(), &record.to_string());
        assert!(told.contains("decides no pixels"), "{option}: {told}");
    }
    assert!(!own.exists() && !folder.path().join("y.png").exists());
}

#[test]
fn options_with_values_that_are_none_are_told_as_of_the_record() {
    let folder = stage();
    for (option, what) in
        [("--spp=many", "many"), ("--tone-map=sepia", "sepia"), ("--size", "--size"), ("--budget=-1", "-1")]
    {
        let mut record = honest();
        record["options"] = json!([option]);
        let told = told_of(folder.path(), &record.to_string());
        assert!(told.contains("x.png: with the options of its record") && told.contains(what), "{told}");
    }
}

#[test]
fn texts_that_are_no_record_are_told() {
    let folder = stage();
    let nested = "[".repeat(100_000);
    let deep = format!("{{\"program\":\"moire\",\"settings\":{nested}");
    for (text, what) in [
        ("{", "its record cannot be read"),
        ("{}", "missing field"),
        ("{\"program\":7}", "invalid type"),
        (deep.as_str(), "recursion limit"),
        ("Made by hand", "does not say how it was made"),
        ("", "does not say how it was made"),
    ] {
        let told = told_of(folder.path(), text);
        assert!(told.contains("x.png") && told.contains(what), "{what}: {told}");
    }
    let mut other = honest();
    other["program"] = json!("another");
    assert!(told_of(folder.path(), &other.to_string()).contains("of another program, \"another\""));
}

#[test]
fn scenes_of_records_keep_the_rules_of_scenes() {
    let folder = stage();
    let mut record = honest();
    // As long as it was.
    record["scene"]["text"] = json!(SCENE.replace("vertical_fov", "vertical_fog"));
    let told = told_of(folder.path(), &record.to_string());
    assert!(told.contains("vertical_fog") && told.contains("the record of x.png"), "{told}");
    // Without a text the record would have to name a file that is there.
    record["scene"] = json!({ "path": "/none/secret.toml", "bytes": 3, "crc32": 3 });
    let told = told_of(folder.path(), &record.to_string());
    assert!(told.contains("secret.toml is missing"), "{told}");
    record["scene"] = json!({ "path": "-", "bytes": 3 });
    assert!(told_of(folder.path(), &record.to_string()).contains("has no ending of a scene"));
}

/// Only what ends as scenes do is opened, and only if it is the recorded file: nothing of others is shown.
#[test]
fn files_that_are_not_the_recorded_scene_are_neither_read_nor_shown() {
    let folder = stage();
    let secret = "token = \"s3cret\"\n";
    for name in ["passwd", "own.toml", "own.obj", "own.ply"] {
        fs::write(folder.path().join(name), secret).unwrap();
        let right =
            json!({ "path": name, "bytes": secret.len(), "crc32": crc32fast::hash(secret.as_bytes()) });
        for scene in [
            json!({ "path": name, "bytes": secret.len() }),
            json!({ "path": name, "bytes": secret.len(), "crc32": 7 }),
            if name == "passwd" { right } else { json!({ "path": name, "bytes": 0, "crc32": 0 }) },
        ] {
            let mut record = honest();
            record["scene"] = scene;
            let told = told_of(folder.path(), &record.to_string());
            assert!(!told.contains("s3cret") && !told.contains("token"), "{told}");
            assert!(told.contains(name), "{told}");
        }
    }
}

#[test]
fn a_text_that_is_not_that_of_its_checksum_is_refused() {
    let folder = stage();
    for (key, value) in [("bytes", json!(SCENE.len() - 1)), ("crc32", json!(1))] {
        let mut record = honest();
        record["scene"][key] = value;
        let told = told_of(folder.path(), &record.to_string());
        assert!(told.contains("length and the checksum"), "{told}");
    }
}

/// A few bytes that unpack to 64 MiB.
#[test]
fn a_compressed_bomb_is_refused_and_honest_compressed_text_is_read() {
    let folder = stage();
    let packed = |text: &[u8]| {
        let mut encoder = ZlibEncoder::new(Vec::new(), flate2::Compression::best());
        encoder.write_all(text).unwrap();
        encoder.finish().unwrap()
    };
    let with = |kind: &[u8; 4], data: &[u8]| {
        let plain = picture(Format::Png, "x");
        let mut file = plain[..33].to_vec();
        file.extend((data.len() as u32).to_be_bytes());
        file.extend(kind);
        file.extend(data);
        file.extend(crc32fast::hash(&[kind, data].concat()).to_be_bytes());
        file.extend(&plain[33..]);
        fs::write(folder.path().join("x.png"), file).unwrap();
        folder.path().join("x.png")
    };
    let bomb = packed(&vec![b' '; 64 << 20]);
    for (kind, head) in [(b"zTXt", &b"moire\0\0"[..]), (b"iTXt", b"moire\0\x01\0en\0Moir\xc3\xa9\0")] {
        with(kind, &[head, &bomb].concat());
        let told = refused(folder.path(), &["--from", "x.png", "-o", "y.png"]);
        assert!(told.contains("longer than 4 MiB"), "{told}");
        let path = with(kind, &[head, &packed(honest().to_string().as_bytes())].concat());
        assert_eq!(record_of(&path), Some(honest()));
        with(kind, &[head, b"no zlib"].concat());
        refused(folder.path(), &["--from", "x.png", "-o", "y.png"]);
    }
    let path = with(b"iTXt", &[b"moire\0\0\0\0\0", honest().to_string().as_bytes()].concat());
    assert_eq!(record_of(&path), Some(honest()));
}

#[test]
fn files_that_are_no_pictures_of_ours_are_told() {
    let folder = stage();
    for (name, bytes, what) in [
        ("a.png", &b"GIF89a......"[..], "none of PNG, JPEG"),
        ("b.png", b"", "none of PNG, JPEG"),
        ("c.png", b"\x89PNG\r\n\x1a\n", "ends too early"),
        ("d.hdr", b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 1\n\0\0\0\0", "does not say"),
    ] {
        fs::write(folder.path().join(name), bytes).unwrap();
        let told = refused(folder.path(), &["--from", name, "-o", "y.png"]);
        assert!(told.contains(what), "{told}");
    }
    assert!(refused(folder.path(), &["--from", "none.png"]).contains("none.png"));
    assert!(refused(folder.path(), &["--from", "scenes"]).contains("it is a folder"));
    let grass = refused(folder.path(), &["--from", "scenes/textures/grass.png", "-o", "y.png"]);
    assert!(grass.contains("does not say how it was made"), "{grass}");
}

/// Every cut, and a changed byte at every place: an error, no record, or a record; never a panic or much memory.
#[test]
fn cut_and_damaged_files_are_read_without_harm() {
    let folder = tempfile::tempdir().unwrap();
    let text = record::ascii(&honest().to_string());
    let mut kept = 0;
    for (format, ending) in
        [Format::Png, Format::Jpeg, Format::Tiff, Format::Exr, Format::Hdr].into_iter().zip(FORMATS)
    {
        let whole = picture(format, &text);
        let path = folder.path().join(format!("a.{ending}"));
        fs::write(&path, &whole).unwrap();
        assert_eq!(record::read(&path).unwrap().as_deref(), Some(text.as_str()), "{format}");
        for at in (0..whole.len().min(1200)).chain((1200..whole.len()).step_by(41)) {
            fs::write(&path, &whole[..at]).unwrap();
            assert_ne!(record::read(&path).ok().flatten().as_deref(), Some(""));
            for byte in [0, 0xff, whole[at] ^ 1] {
                let mut damaged = whole.clone();
                damaged[at] = byte;
                fs::write(&path, &damaged).unwrap();
                kept += usize::from(record::read(&path).is_ok_and(|found| found.as_deref() == Some(&text)));
            }
        }
    }
    assert!(kept > 0, "most places of a file are not its record");
}
