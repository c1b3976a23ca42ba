//! Volumes from slices, raw texels and NRRD: axes and byte orders, and files that are too short,
//! too long or described incorrectly.

use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};

use flate2::Compression;
use flate2::write::GzEncoder;
use moire::internal::texture::data::{ColorSpace, Dimension, TexelFormat, TextureData};
use moire::internal::texture::load::load;
use moire::internal::texture::source::{Endian, TextureContent, VolumeSource};
use tempfile::tempdir;

use super::{assert_says, grey, read, source};
use crate::support::told;

const SIZE: [u32; 3] = [3, 2, 4];

/// x + 10 y + 100 z
fn codes() -> Vec<u16> {
    let [w, h, d] = SIZE.map(|n| n as u16);
    (0..d).flat_map(|z| (0..h).flat_map(move |y| (0..w).map(move |x| x + 10 * y + 100 * z))).collect()
}

fn native(codes: &[u16]) -> Vec<u8> {
    codes.iter().flat_map(|c| c.to_ne_bytes()).collect()
}

fn bytes(endian: Endian) -> Vec<u8> {
    let of = |c: u16| if endian == Endian::Big { c.to_be_bytes() } else { c.to_le_bytes() };
    codes().into_iter().flat_map(of).collect()
}

fn put(folder: &Path, name: &str, content: &[u8]) -> PathBuf {
    let path = folder.join(name);
    fs::write(&path, content).unwrap();
    path
}

fn file(path: &Path) -> moire::internal::core::error::Result<TextureData> {
    read(Dimension::Three, TextureContent::File(path.to_path_buf()))
}

fn is_the_volume(t: &TextureData) {
    assert_eq!([t.width, t.height, t.depth], SIZE);
    assert_eq!((t.dimension, t.format, t.file_channels), (Dimension::Three, TexelFormat::Grey16, 1));
    assert_eq!(t.texels, native(&codes()));
}

#[test]
fn slices_lie_one_after_the_other_and_flip_each_by_itself() {
    let folder = tempdir().unwrap();
    let slices = (0..3).map(|i| grey(folder.path(), &format!("{i}.png"), 1, 2, vec![10 * i, 10 * i + 1]));
    let mut source = source(Dimension::Three, TextureContent::Slices(slices.collect()));
    let t = load(&source).unwrap();
    assert_eq!(([t.width, t.height, t.depth], &t.texels[..]), ([1, 2, 3], &[0, 1, 10, 11, 20, 21][..]));
    source.flip_v = true;
    assert_eq!(load(&source).unwrap().texels, [1, 0, 11, 10, 21, 20]);
    let odd = grey(folder.path(), "odd.png", 2, 2, vec![0; 4]);
    let message =
        told(read(Dimension::Three, TextureContent::Slices(vec![folder.path().join("0.png"), odd])));
    assert_says(&message, &["texture \"t\"", "odd.png: slice 2 of 2", "2×2", "1×2"]);
}

fn raw(path: &Path, offset: u64, endian: Endian) -> TextureContent {
    let format = TexelFormat::Grey16;
    TextureContent::Volume(VolumeSource { file: path.to_path_buf(), size: SIZE, format, offset, endian })
}

#[test]
fn bare_texels_are_read_from_their_offset_in_both_byte_orders() {
    let folder = tempdir().unwrap();
    for endian in [Endian::Little, Endian::Big] {
        let path = put(folder.path(), "v.raw", &[&b"head "[..], &bytes(endian)].concat());
        is_the_volume(&read(Dimension::Three, raw(&path, 5, endian)).unwrap());
    }
}

#[test]
fn bare_texels_of_another_number_are_refused() {
    let folder = tempdir().unwrap();
    let short = put(folder.path(), "short.raw", &bytes(Endian::Little)[..40]);
    let message = told(read(Dimension::Three, raw(&short, 0, Endian::Little)));
    assert_says(&message, &["texture \"t\"", "short.raw: 40 bytes", "3×2×4", "end at 48", "8 are missing"]);
    let long = put(folder.path(), "long.raw", &[0; 50]);
    let message = told(read(Dimension::Three, raw(&long, 0, Endian::Little)));
    assert_says(&message, &["long.raw: 50 bytes", "2 are left over", "size, format and offset"]);
    let missing = folder.path().join("none.raw");
    assert_says(
        &told(read(Dimension::Three, raw(&missing, 0, Endian::Little))),
        &["none.raw", "no such file"],
    );
    let huge = VolumeSource {
        file: long,
        size: [65_536; 3],
        format: TexelFormat::Grey8,
        offset: 0,
        endian: Endian::Big,
    };
    let message = told(read(Dimension::Three, TextureContent::Volume(huge)));
    assert_says(&message, &["long.raw", "memory", "16 GiB"]);
}

#[test]
fn non_finite_and_srgb_floats_are_refused_in_volumes_too() {
    let folder = tempdir().unwrap();
    let mut floats = [1f32; 24];
    floats[3 + 3 + 6] = f32::NAN;
    let bytes: Vec<u8> = floats.iter().flat_map(|f| f.to_be_bytes()).collect();
    let path = put(folder.path(), "f.raw", &bytes);
    let format = TexelFormat::GreyFloat;
    let raw = VolumeSource { file: path, size: SIZE, format, offset: 0, endian: Endian::Big };
    let mut source = source(Dimension::Three, TextureContent::Volume(raw));
    assert_says(&told(load(&source)), &["texture \"t\"", "f.raw", "texel (0, 0, 2)", "NaN"]);
    source.color_space = ColorSpace::Srgb;
    assert_says(&told(load(&source)), &["f.raw", "linear light, not sRGB"]);
}

const HEAD: &str = "NRRD0004\n# made by hand\ntype: unsigned short\ndimension: 3\nsizes: 3 2 4\n\
                    spacings: 1 1 2.5\nkey:=value: of its own\n";

#[test]
fn nrrd_is_read_attached_detached_raw_and_gzip_in_both_byte_orders() {
    let folder = tempdir().unwrap();
    let folder = folder.path();
    for endian in [Endian::Little, Endian::Big] {
        let texels = bytes(endian);
        let mut gzip = GzEncoder::new(Vec::new(), Compression::default());
        gzip.write_all(&texels).unwrap();
        let gzip = gzip.finish().unwrap();
        let head =
            |encoding: &str, more: &str| format!("{HEAD}endian: {endian}\nencoding: {encoding}\n{more}");
        for (encoding, data) in [("raw", &texels), ("gzip", &gzip), ("GZ", &gzip)] {
            let attached = [head(encoding, "\n").as_bytes(), data].concat();
            is_the_volume(&file(&put(folder, "a.nrrd", &attached)).unwrap());
            put(folder, "a.data", data);
            for field in ["data file: a.data\n", "datafile: a.data"] {
                let header = put(folder, "a.nhdr", head(encoding, field).as_bytes());
                is_the_volume(&file(&header).unwrap());
            }
        }
        put(folder, "b.data", &[&b"one\ntwo\nxyz"[..], &texels].concat());
        for skip in ["line skip: 2\nbyte skip: 3", "byte skip: -1", "lineskip: 1\nbyteskip: 7"] {
            let more = format!("{skip}\ndata file: b.data\n");
            is_the_volume(&file(&put(folder, "b.nhdr", head("raw", &more).as_bytes())).unwrap());
        }
    }
}

#[test]
fn nrrd_channels_lie_on_the_first_of_four_axes() {
    let folder = tempdir().unwrap();
    let put = |channels: usize, kinds: &str| {
        let head = format!(
            "NRRD0001\r\ntype: uint8\r\ndimension: 4\r\nsizes: {channels} 1 2 1\r\nencoding: raw\r\n{kinds}\r\n"
        );
        let texels: Vec<u8> = (1..=2 * channels as u8).collect();
        put(folder.path(), "c.nrrd", &[head.as_bytes(), &texels].concat())
    };
    let t = file(&put(3, "kinds: RGB-color domain domain domain\r\n")).unwrap();
    assert_eq!((t.format, t.file_channels), (TexelFormat::Rgba8, 3));
    assert_eq!(t.texels, [1, 2, 3, 255, 4, 5, 6, 255]);
    assert_eq!(file(&put(2, "")).unwrap().texels, [1, 2, 3, 4]);
    assert_says(&told(file(&put(5, ""))), &["c.nrrd:4: field \"sizes\"", "1 to 4 channels"]);
    let last = "kinds: domain domain domain vector\r\n";
    assert_says(&told(file(&put(4, last))), &["c.nrrd:6: field \"kinds\"", "first of four axes"]);
}

#[test]
fn bad_nrrd_headers_name_line_and_field() {
    let folder = tempdir().unwrap();
    let whole = format!("{HEAD}endian: little\nencoding: raw\n\n");
    let texels = bytes(Endian::Little);
    for (from, to, words) in [
        ("NRRD0004", "NRRD0009", &["bad.nrrd", "NRRD0001 to NRRD0005"][..]),
        ("NRRD0004", "NRRD", &["no NRRD volume"]),
        ("unsigned short", "block", &[":3: field \"type\"", "one of uchar", "found \"block\""]),
        ("type: unsigned short\n", "", &["no field \"type\"", "dimension, sizes"]),
        ("dimension: 3", "dimension: 2", &[":4: field \"dimension\"", "one of 3, 4", "found \"2\""]),
        ("3 2 4", "3 2", &[":5: field \"sizes\"", "3 whole numbers", "found \"3 2\""]),
        ("3 2 4", "3 0 4", &[":5: field \"sizes\"", "above 0"]),
        ("3 2 4", "3 -2 4", &[":5: field \"sizes\""]),
        ("3 2 4", "3 2 99999", &["3×2×99999", "65536"]),
        ("spacings: 1 1 2.5", "kinds: RGB-color domain domain", &[":6: field \"kinds\"", "three axes"]),
        ("spacings: 1 1 2.5", "spacings", &[":6:", "\"spacings\" is no field", "NAME: VALUE"]),
        ("spacings: 1 1 2.5", "dimension: 3", &[":6:", "\"dimension\" stands on line 4"]),
        ("endian: little\n", "", &["no field \"endian\"", "8 bits"]),
        ("endian: little", "endian: middle", &[":8: field \"endian\"", "little, big"]),
        ("encoding: raw", "encoding: bzip2", &[":9: field \"encoding\"", "raw, gzip", "\"bzip2\""]),
        ("encoding: raw", "encoding: gzip", &["bad.nrrd", "cannot be read"]),
        ("encoding: raw", "encoding: raw\nbyte skip: -2", &[":10: field \"byte skip\"", "from -1"]),
        ("encoding: raw", "encoding: gzip\nbyte skip: -1", &["field \"byte skip\"", "not raw"]),
        ("encoding: raw", "encoding: raw\ndata file: LIST", &[":10: field \"data file\"", "one file"]),
        ("encoding: raw", "encoding: raw\ndata file: x.raw", &["x.raw", "no such file"]),
    ] {
        assert!(whole.contains(from));
        let path =
            put(folder.path(), "bad.nrrd", &[whole.replacen(from, to, 1).as_bytes(), &texels].concat());
        let message = told(file(&path));
        assert_says(&message, words);
        assert_says(&message, &["texture \"t\""]);
    }
    for cut in [whole.len() + texels.len() - 1, whole.len()] {
        let path = put(folder.path(), "cut.nrrd", &[whole.as_bytes(), &texels].concat()[..cut]);
        assert_says(&told(file(&path)), &["cut.nrrd", "ends early", "3×2×4", "48 bytes"]);
    }
    let path = put(folder.path(), "empty.nrrd", b"");
    assert_says(&told(file(&path)), &["empty.nrrd", "no NRRD volume"]);
    let message =
        told(read(Dimension::Two, TextureContent::File(put(folder.path(), "a.png", whole.as_bytes()))));
    assert_says(&message, &["a.png", "NRRD volume", ".nrrd"]);
}
