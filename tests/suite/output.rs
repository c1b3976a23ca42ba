//! Writing pictures: each format reads back as written, and a failure leaves nothing behind.

use std::fs;
use std::path::Path;

use moire::internal::core::color::{linear_to_srgb, srgb_to_linear};
use moire::internal::core::film::{Film, Placement};
use moire::internal::lab::metrics::{read_picture, read_placed};
use moire::internal::output::{ENDINGS, Format, WriteOptions, check_writable, to_bytes, write, write_all};
use moire::internal::texture::data::{ColorSpace, TexelFormat, TextureData};
use moire::internal::texture::decode::decode;
use tempfile::tempdir;

use crate::support::{gradient, told};

fn stored(path: &Path) -> TextureData {
    decode(path, "t", ColorSpace::Linear, false).unwrap()
}

fn names(folder: &Path) -> Vec<String> {
    let mut names: Vec<_> =
        fs::read_dir(folder).unwrap().map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

#[test]
fn exr_round_trip_is_bit_exact_with_nan_infinity_and_negative_values() {
    let folder = tempdir().unwrap();
    let path = folder.path().join("a.exr");
    let mut film = gradient(37, 11);
    film.pixels[5] = [f32::NAN, f32::INFINITY, -0.0];
    film.pixels[6] = [-3.5, 1e30, 1e-40];
    write(&film, &path, &WriteOptions::default()).unwrap();
    let back = read_picture(&path).unwrap();
    let bits = |f: &Film| f.pixels.iter().flat_map(|p| p.map(f32::to_bits)).collect::<Vec<_>>();
    assert_eq!((back.width, back.height), (37, 11));
    assert_eq!(bits(&back), bits(&film));
}

/// The four numbers of a box in an EXR header: attribute name, type "box2i", length 16, then little-endian.
fn exr_box(bytes: &[u8], name: &str) -> [i32; 4] {
    let head = [name.as_bytes(), b"\0box2i\0\x10\0\0\0"].concat();
    let start =
        bytes.windows(head.len()).position(|w| w == head).unwrap_or_else(|| panic!("no {name}")) + head.len();
    let (numbers, _) = bytes[start..start + 16].as_chunks::<4>();
    std::array::from_fn(|i| i32::from_le_bytes(numbers[i]))
}

#[test]
fn exr_of_a_part_has_its_data_window_within_the_picture() {
    let folder = tempdir().unwrap();
    let path = folder.path().join("part.exr");
    let film = gradient(5, 3);
    let placement = Placement { corner: [7, 2], full: [20, 11] };
    write(&film, &path, &WriteOptions { placement: Some(placement), ..Default::default() }).unwrap();
    let bytes = fs::read(&path).unwrap();
    assert_eq!(exr_box(&bytes, "dataWindow"), [7, 2, 11, 4]);
    assert_eq!(exr_box(&bytes, "displayWindow"), [0, 0, 19, 10]);
    let (back, at) = read_placed(&path).unwrap();
    assert_eq!((&back.pixels, at), (&film.pixels, placement));
    // As a texture: the whole picture, black around the part.
    let texture = stored(&path);
    assert_eq!((texture.width, texture.height), (20, 11));
    for (x, y) in [(0, 0), (7, 2), (11, 4), (12, 4), (19, 10)] {
        let inside = (7..12).contains(&x) && (2..5).contains(&y);
        let want = if inside { film.pixels[((y - 2) * 5 + x - 7) as usize] } else { [0.0; 3] };
        assert_eq!([0, 1, 2].map(|c| texture.value(x, y, c) as f32), want, "at ({x}, {y})");
    }
}

#[test]
fn hdr_round_trip_is_within_half_a_step_of_the_shared_exponent() {
    let folder = tempdir().unwrap();
    let path = folder.path().join("a.hdr");
    let film = gradient(37, 11);
    write(&film, &path, &WriteOptions::default()).unwrap();
    let mut sum = 0.0;
    for (p, q) in film.pixels.iter().zip(read_picture(&path).unwrap().pixels) {
        let largest = p[0].max(p[1]).max(p[2]);
        for c in 0..3 {
            // Eight bits of mantissa: a step is at most 1/128 of the largest channel.
            assert!((p[c] - q[c]).abs() <= largest / 256.0, "{p:?} came back as {q:?}");
            sum += f64::from(q[c] - p[c]);
        }
    }
    // Truncation would lose about 1.5e-3 on average; rounding has no bias.
    assert!((sum / film.pixels.len() as f64 / 3.0).abs() < 2e-4);
}

#[test]
fn eight_bit_png_and_tiff_hold_the_rounded_srgb_value() {
    let folder = tempdir().unwrap();
    let mut film = gradient(64, 64);
    film.pixels[0] = [-1.0, 2.0, f32::NAN];
    for name in ["a.png", "a.tif", "a.tiff", "A.PNG"] {
        let path = folder.path().join(name);
        write(&film, &path, &WriteOptions::default()).unwrap();
        let texture = stored(&path);
        assert_eq!((texture.format, texture.file_channels), (TexelFormat::Rgba8, 3));
        assert_eq!(texture.texels[..3], [0, 255, 0], "clipped, NaN is 0");
        for (p, t) in film.pixels.iter().zip(texture.texels.chunks(4)).skip(1) {
            let want = p.map(|v| (linear_to_srgb(f64::from(v)) * 255.0).round() as u8);
            assert_eq!(t[..3], want, "{name}");
        }
    }
}

#[test]
fn sixteen_bit_png_holds_the_rounded_srgb_value() {
    let folder = tempdir().unwrap();
    let path = folder.path().join("a.png");
    let film = gradient(64, 64);
    write(&film, &path, &WriteOptions { png_bits: 16, ..Default::default() }).unwrap();
    let texture = stored(&path);
    assert_eq!(texture.format, TexelFormat::Rgba16);
    for (i, p) in film.pixels.iter().enumerate() {
        for (c, &v) in p.iter().enumerate() {
            let got = texture.value(i as u32 % 64, i as u32 / 64, c) * 65_535.0;
            assert_eq!(got.round(), (linear_to_srgb(f64::from(v)) * 65_535.0).round());
        }
    }
}

#[test]
fn png_of_eight_bit_values_survives_a_round_trip() {
    let folder = tempdir().unwrap();
    let path = folder.path().join("a.png");
    let mut film = Film::new(16, 16, 1);
    film.pixels.iter_mut().enumerate().for_each(|(i, p)| *p = [srgb_to_linear(i as f64 / 255.0) as f32; 3]);
    write(&film, &path, &WriteOptions::default()).unwrap();
    assert_eq!(read_picture(&path).unwrap().pixels, film.pixels);
}

#[test]
fn jpeg_of_a_flat_picture_is_within_two_codes() {
    let folder = tempdir().unwrap();
    for name in ["a.jpg", "a.jpeg"] {
        let path = folder.path().join(name);
        let mut film = Film::new(24, 16, 1);
        film.pixels.fill([0.2, 0.4, 0.1]);
        write(&film, &path, &WriteOptions::default()).unwrap();
        let want = [0.2, 0.4, 0.1].map(|v| linear_to_srgb(v) * 255.0);
        for t in stored(&path).texels.chunks(4) {
            (0..3).for_each(|c| assert!((f64::from(t[c]) - want[c]).abs() <= 2.0, "{t:?} for {want:?}"));
        }
    }
}

/// Colours of single pixels stay where they are at each quality: halved in resolution, they would be the mean of two.
#[test]
fn jpeg_keeps_the_resolution_of_colors_at_every_quality() {
    let mut film = Film::new(32, 32, 1);
    for (i, pixel) in film.pixels.iter_mut().enumerate() {
        // Red and blue of equal luma.
        *pixel = if i % 2 == 0 { [0.4, 0.05, 0.05] } else { [0.05, 0.12, 0.6] };
    }
    for jpeg_quality in [60, 80, 89, 90] {
        let folder = tempdir().unwrap();
        let path = folder.path().join("a.jpg");
        write(&film, &path, &WriteOptions { jpeg_quality, ..WriteOptions::default() }).unwrap();
        let texels = stored(&path).texels;
        let redness = |x: usize| i32::from(texels[4 * x]) - i32::from(texels[4 * x + 2]);
        let contrast = (0..16).map(|x| redness(2 * x) - redness(2 * x + 1)).sum::<i32>() / 16;
        assert!(contrast > 150, "quality {jpeg_quality}: {contrast}");
    }
}

#[test]
fn unknown_and_missing_endings_list_the_known_ones() {
    let folder = tempdir().unwrap();
    for (name, what) in [("a.bmp", ".bmp is unknown"), ("a", "no ending"), (".png", "no ending")] {
        let path = folder.path().join(name);
        for message in
            [told(write(&gradient(2, 2), &path, &WriteOptions::default())), told(check_writable(&path))]
        {
            assert!(message.contains(what) && message.contains(".exr, .hdr, .png"), "{message}");
        }
    }
    assert!(names(folder.path()).is_empty());
}

#[test]
fn unwritable_places_are_refused_before_and_while_writing() {
    let folder = tempdir().unwrap();
    let in_folder = |name: &str| folder.path().join(name);
    fs::create_dir(in_folder("dir.png")).unwrap();
    fs::write(in_folder("file"), b"").unwrap();
    let long = format!("{}.png", "n".repeat(300));
    for (name, what) in [
        ("none/a.png", "none does not exist"),
        ("dir.png", "this is a folder"),
        ("file/a.png", "file is not a folder"),
        ("a.png/", "names a folder"),
        (long.as_str(), "cannot be written"),
    ] {
        let path = in_folder(name);
        for message in
            [told(check_writable(&path)), told(write(&gradient(2, 2), &path, &WriteOptions::default()))]
        {
            assert!(message.contains(what) && message.contains(path.to_str().unwrap()), "{message}");
        }
    }
    assert_eq!(names(folder.path()), ["dir.png", "file"]);
}

/// Not even root can create files there.
#[cfg(target_os = "linux")]
#[test]
fn folder_that_takes_no_files_is_not_writable() {
    let message = told(check_writable(Path::new("/proc/a.png")));
    assert!(message.contains("/proc is not writable"), "{message}");
}

#[test]
fn check_writable_leaves_no_trace_and_harms_no_file() {
    let folder = tempdir().unwrap();
    let path = folder.path().join("a.png");
    check_writable(&path).unwrap();
    assert!(names(folder.path()).is_empty());
    fs::write(&path, b"precious").unwrap();
    check_writable(&path).unwrap();
    assert_eq!(fs::read(&path).unwrap(), b"precious");
}

#[test]
fn failed_write_leaves_the_old_file_and_no_temporary() {
    let folder = tempdir().unwrap();
    let path = folder.path().join("a.jpg");
    fs::write(&path, b"precious").unwrap();
    // A JPEG is at most 65535 pixels wide: the encoder fails after the file was begun.
    let message = told(write(&Film::new(65_536, 1, 1), &path, &WriteOptions::default()));
    assert!(message.contains("65536×1") && message.contains("a.jpg"), "{message}");
    assert_eq!(fs::read(&path).unwrap(), b"precious");
    assert_eq!(names(folder.path()), ["a.jpg"]);
}

#[test]
fn existing_file_is_replaced_and_nothing_else_appears() {
    let folder = tempdir().unwrap();
    let path = folder.path().join("a.exr");
    fs::write(&path, b"old").unwrap();
    write(&gradient(4, 4), &path, &WriteOptions::default()).unwrap();
    assert_eq!(read_picture(&path).unwrap().pixels, gradient(4, 4).pixels);
    assert_eq!(names(folder.path()), ["a.exr"]);
}

#[test]
fn bit_depths_other_than_8_and_16_are_refused() {
    let folder = tempdir().unwrap();
    let path = folder.path().join("a.png");
    assert!(
        told(write(&gradient(2, 2), &path, &WriteOptions { png_bits: 12, ..Default::default() }))
            .contains("12 bits")
    );
}

#[cfg(unix)]
#[test]
fn permissions_are_those_of_any_new_file() {
    use std::os::unix::fs::PermissionsExt;
    let folder = tempdir().unwrap();
    let (ours, plain) = (folder.path().join("a.png"), folder.path().join("plain"));
    write(&gradient(2, 2), &ours, &WriteOptions::default()).unwrap();
    fs::write(&plain, b"").unwrap();
    let mode = |path| fs::metadata(path).unwrap().permissions().mode();
    assert_eq!(mode(&ours), mode(&plain));
}

#[cfg(unix)]
#[test]
fn symbolic_link_stays_a_link() {
    let folder = tempdir().unwrap();
    let (link, file) = (folder.path().join("link.png"), folder.path().join("file.png"));
    fs::write(&file, b"old").unwrap();
    std::os::unix::fs::symlink(&file, &link).unwrap();
    write(&gradient(2, 2), &link, &WriteOptions::default()).unwrap();
    assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
    assert_eq!(stored(&file).width, 2);
}

#[test]
fn of_several_pictures_all_are_written_or_none() {
    let folder = tempdir().unwrap();
    // JPEG has 16 bits for a side.
    let paths = ["a.exr", "b.jpg"].map(|name| folder.path().join(name));
    assert!(told(write_all(&gradient(70_000, 1), &paths, &WriteOptions::default())).contains("b.jpg"));
    assert!(names(folder.path()).is_empty(), "{:?}", names(folder.path()));
    write_all(&gradient(7, 1), &paths, &WriteOptions::default()).unwrap();
    assert_eq!(names(folder.path()), ["a.exr", "b.jpg"]);
}

/// Rows of an EXR file are written by all threads at once.
#[test]
fn files_have_the_bytes_of_a_stream() {
    let folder = tempdir().unwrap();
    for (width, height) in [(1, 1), (7, 3000), (1500, 90)] {
        let film = gradient(width, height);
        for format in [Format::Exr, Format::Hdr, Format::Png, Format::Tiff] {
            let path =
                folder.path().join("a.exr").with_extension(ENDINGS.iter().find(|e| e.1 == format).unwrap().0);
            write(&film, &path, &WriteOptions::default()).unwrap();
            assert!(
                fs::read(&path).unwrap() == to_bytes(&film, format).unwrap(),
                "{format} of {width}×{height}"
            );
        }
    }
}
