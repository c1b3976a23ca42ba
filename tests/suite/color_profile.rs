//! Pictures whose colours are not those of sRGB: ICC profiles in JPEG, PNG, TIFF and WebP files, and code points in PNG
//! files. Textures and compared pictures have the colours that the published primaries and transfer functions give.

use std::fs;
use std::path::{Path, PathBuf};

use glam::{DMat3, DVec3};
use image::codecs::jpeg::JpegEncoder;
use image::codecs::png::PngEncoder;
use image::{ExtendedColorType, ImageEncoder};
use moire::internal::core::color::{linear_to_srgb, srgb_to_linear};
use moire::internal::core::film::Film;
use moire::internal::lab::metrics::read_picture;
use moire::internal::output::{DisplayTransform, Format, Gamut, WriteOptions, to_bytes_with};
use moire::internal::texture::data::{ColorSpace, Dimension, TextureData};
use moire::internal::texture::load::load_with_notes;
use moire::internal::texture::source::{ProfileUse, ReadOptions, TextureContent};
use moxcms::ColorProfile;
use tempfile::tempdir;

use crate::display::NEUTRAL;
use crate::support::{data, moire, texture_source};

/// Colours of 5 × 5 texels, saturated ones among them.
const SIDE: u32 = 5;

fn codes() -> Vec<u8> {
    let level = [0, 60, 128, 200, 255];
    (0..25).flat_map(|i| [level[i % 5], level[i / 5], level[(i * 3 + 1) % 5]]).collect()
}

fn png(icc: &[u8], pixels: &[u8], color: ExtendedColorType) -> Vec<u8> {
    let mut file = Vec::new();
    let mut encoder = PngEncoder::new(&mut file);
    encoder.set_icc_profile(icc.to_vec()).unwrap();
    encoder.write_image(pixels, SIDE, SIDE, color).unwrap();
    file
}

fn rgb_png(profile: &ColorProfile) -> Vec<u8> {
    png(&profile.encode().unwrap(), &codes(), ExtendedColorType::Rgb8)
}

fn written(folder: &Path, name: &str, bytes: &[u8]) -> PathBuf {
    let path = folder.join(name);
    fs::write(&path, bytes).unwrap();
    path
}

/// Reads a texture; returns its notes, too.
fn read_as(path: &Path, space: ColorSpace, color_profile: ProfileUse) -> (TextureData, Vec<String>) {
    let reading = ReadOptions { color_profile, ..ReadOptions::default() };
    let mut source = texture_source(TextureContent::File(path.to_owned()), Dimension::Two, reading);
    source.color_space = space;
    load_with_notes(&source, Default::default()).unwrap()
}

fn read(path: &Path) -> (TextureData, Vec<String>) {
    read_as(path, ColorSpace::Srgb, ProfileUse::Apply)
}

/// From linear Display P3 and from linear Adobe RGB (1998) to linear sRGB, by rows (W3C, CSS Color 4, 18: the products of
/// its matrices).
const P3_TO_SRGB: [f64; 9] = [
    1.224_940_2,
    -0.224_940_2,
    0.0, //
    -0.042_057_0,
    1.042_057_0,
    0.0, //
    -0.019_637_6,
    -0.078_636_1,
    1.098_273_6,
];
const ADOBE_TO_SRGB: [f64; 9] = [
    1.398_355_7,
    -0.398_355_7,
    0.0, //
    0.0,
    1.0,
    0.0, //
    0.0,
    -0.042_928_9,
    1.042_928_9,
];

fn to_srgb(rows: [f64; 9], transfer: impl Fn(f64) -> f64, codes: [u8; 3]) -> DVec3 {
    let linear = DVec3::from(codes.map(|code| transfer(f64::from(code) / 255.0)));
    DMat3::from_cols_array(&rows).transpose() * linear
}

/// The distance, in codes of 8 bits, of a texel to a linear colour as sRGB has it.
fn off(texel: [u8; 3], color: DVec3) -> f64 {
    let coded = color.to_array().map(|v| 255.0 * linear_to_srgb(v.clamp(0.0, 1.0)));
    (DVec3::from(coded) - DVec3::from(texel.map(f64::from))).abs().max_element()
}

fn rgb(texture: &TextureData) -> impl Iterator<Item = [u8; 3]> {
    texture.texels.as_chunks::<4>().0.iter().map(|t| [t[0], t[1], t[2]])
}

#[test]
fn wide_colors_become_those_of_srgb() {
    let folder = tempdir().unwrap();
    let adobe = |v: f64| v.powf(563.0 / 256.0);
    type Transfer = fn(f64) -> f64;
    let spaces = [
        ("p3", ColorProfile::new_display_p3(), P3_TO_SRGB, srgb_to_linear as Transfer),
        ("adobe", ColorProfile::new_adobe_rgb(), ADOBE_TO_SRGB, adobe as Transfer),
    ];
    for (name, profile, rows, transfer) in spaces {
        let path = written(folder.path(), &format!("{name}.png"), &rgb_png(&profile));
        let (texture, notes) = read(&path);
        assert!(notes.is_empty(), "{notes:?}");
        let mut changed = 0;
        for (seen, code) in rgb(&texture).zip(codes().as_chunks::<3>().0) {
            // Half a code of rounding, and the profile's own numbers of 16 bits.
            let off = off(seen, to_srgb(rows, transfer, *code));
            assert!(off < 0.6, "{name}: {code:?} became {seen:?}, {off} codes off");
            changed += u32::from(seen != *code);
        }
        assert!(changed > 10, "{name}: {changed}");
        // Colours outside of sRGB are kept where they are compared.
        let film = read_picture(&path).unwrap();
        for (seen, code) in film.pixels.iter().zip(codes().as_chunks::<3>().0) {
            let expected = to_srgb(rows, transfer, *code);
            let off = (DVec3::from(seen.map(f64::from)) - expected).abs().max_element();
            assert!(off < 5e-4, "{name}: {code:?} is {seen:?}, not {expected}");
        }
    }
}

#[test]
fn profiles_are_found_in_every_kind_of_file() {
    let folder = tempdir().unwrap();
    let icc = ColorProfile::new_display_p3().encode().unwrap();
    let flat = [200, 60, 60].repeat(25);
    let mut jpeg = Vec::new();
    let mut encoder = JpegEncoder::new_with_quality(&mut jpeg, 100);
    encoder.set_icc_profile(icc.clone()).unwrap();
    encoder.write_image(&flat, SIDE, SIDE, ExtendedColorType::Rgb8).unwrap();
    let mut webp = Vec::new();
    let mut encoder = image_webp::WebPEncoder::new(&mut webp);
    encoder.set_icc_profile(icc.clone());
    encoder.encode(&flat, SIDE, SIDE, image_webp::ColorType::Rgb8).unwrap();
    let plain = png(&icc, &flat, ExtendedColorType::Rgb8);
    for (name, file) in [("a.jpg", jpeg), ("a.webp", webp), ("a.png", plain)] {
        let (texture, notes) = read(&written(folder.path(), name, &file));
        let seen = rgb(&texture).next().unwrap();
        // The colours of JPEG are within two codes.
        assert!(off(seen, to_srgb(P3_TO_SRGB, srgb_to_linear, [200, 60, 60])) < 3.0, "{name}: {seen:?}");
        assert!(seen[0] > 212 && notes.is_empty(), "{name}: {seen:?}, {notes:?}");
    }
    // Pictures of this program in either gamut are the same colours; PNG files say it by code points, too.
    let file = |format, gamut| {
        let display = DisplayTransform { gamut, ..NEUTRAL };
        let film = Film { width: 2, height: 2, pixels: vec![[0.8, 0.1, 0.1]; 4], samples: 1 };
        to_bytes_with(&film, format, &WriteOptions { display, ..WriteOptions::default() }).unwrap()
    };
    for (name, format) in [("b.png", Format::Png), ("b.jpg", Format::Jpeg), ("b.tif", Format::Tiff)] {
        let plain = read(&written(folder.path(), name, &file(format, Gamut::Srgb))).0;
        let wide = read(&written(folder.path(), name, &file(format, Gamut::DisplayP3))).0;
        let stored = read_as(&folder.path().join(name), ColorSpace::Srgb, ProfileUse::Ignore).0;
        let farthest = |other: &TextureData| {
            plain.texels.iter().zip(&other.texels).map(|(a, b)| a.abs_diff(*b)).max().unwrap()
        };
        let (wide, stored) = (farthest(&wide), farthest(&stored));
        assert!(wide < 4 && stored > 8, "{name}: {wide}, {stored}");
    }
}

#[test]
fn code_points_come_before_a_profile_and_unknown_ones_are_told() {
    let folder = tempdir().unwrap();
    let with_points = |points: [u8; 4]| {
        let file = rgb_png(&ColorProfile::new_srgb());
        let body = [&b"cICP"[..], &points].concat();
        let chunk = [&4u32.to_be_bytes()[..], &body, &crc32fast::hash(&body).to_be_bytes()].concat();
        written(folder.path(), "points.png", &[&file[..33], &chunk, &file[33..]].concat())
    };
    let (wide, notes) = read(&with_points([12, 13, 0, 1]));
    assert!(notes.is_empty(), "{notes:?}");
    for (seen, code) in rgb(&wide).zip(codes().as_chunks::<3>().0) {
        assert!(off(seen, to_srgb(P3_TO_SRGB, srgb_to_linear, *code)) < 0.6, "{code:?} became {seen:?}");
    }
    let (plain, _) = read(&with_points([1, 13, 0, 1]));
    assert!(rgb(&plain).eq(codes().as_chunks::<3>().0.iter().copied()));
    // PQ, HLG, a narrow range, unspecified and unknown primaries.
    for points in [[9, 16, 0, 1], [9, 18, 0, 1], [1, 13, 0, 0], [2, 13, 0, 1], [250, 13, 0, 1]] {
        let (texture, notes) = read(&with_points(points));
        assert!(rgb(&texture).eq(codes().as_chunks::<3>().0.iter().copied()), "{points:?}");
        assert!(notes[0].contains("code points") && notes[0].contains("read as those of sRGB"), "{notes:?}");
    }
}

#[test]
fn srgb_by_profile_is_read_bit_by_bit() {
    let folder = tempdir().unwrap();
    let (texture, notes) = read(&written(folder.path(), "s.png", &rgb_png(&ColorProfile::new_srgb())));
    assert!(rgb(&texture).eq(codes().as_chunks::<3>().0.iter().copied()));
    assert!(notes.is_empty());
}

#[test]
fn grey_follows_its_curve_and_sixteen_bits_stay() {
    let folder = tempdir().unwrap();
    let icc = ColorProfile::new_gray_with_gamma(1.8).encode().unwrap();
    let values: Vec<u8> = (0..25).map(|i| i * 10).collect();
    let (texture, _) = read(&written(folder.path(), "g.png", &png(&icc, &values, ExtendedColorType::L8)));
    for (seen, code) in texture.texels.iter().zip(&values) {
        let linear = (f64::from(*code) / 255.0).powf(1.8);
        assert!(off([*seen; 3], DVec3::splat(linear)) < 1.0, "{code} became {seen}");
    }
    let wide: Vec<u8> = codes().iter().flat_map(|&code| (u16::from(code) * 257).to_ne_bytes()).collect();
    let icc = ColorProfile::new_display_p3().encode().unwrap();
    let (texture, _) = read(&written(folder.path(), "w.png", &png(&icc, &wide, ExtendedColorType::Rgb16)));
    let texels: &[[u8; 2]] = texture.texels.as_chunks().0;
    for (seen, code) in texels.chunks(4).zip(codes().as_chunks::<3>().0) {
        let seen = [0, 1, 2].map(|i| f64::from(u16::from_ne_bytes(seen[i])) / 257.0);
        let want = to_srgb(P3_TO_SRGB, srgb_to_linear, *code).to_array();
        let want = want.map(|v| 255.0 * linear_to_srgb(v.clamp(0.0, 1.0)));
        let off = (DVec3::from(seen) - DVec3::from(want)).abs().max_element();
        // The numbers of a profile are multiples of 1/65536, of which each is 0.05 codes where sRGB is steepest.
        assert!(off < 0.2, "{code:?} became {seen:?}, not {want:?}");
    }
}

#[test]
fn linear_values_and_ignored_profiles_stay_as_stored() {
    let folder = tempdir().unwrap();
    let path = written(folder.path(), "p.png", &rgb_png(&ColorProfile::new_display_p3()));
    for (space, on) in [
        (ColorSpace::Linear, ProfileUse::Apply),
        (ColorSpace::Linear, ProfileUse::Ignore),
        (ColorSpace::Srgb, ProfileUse::Ignore),
    ] {
        let (texture, notes) = read_as(&path, space, on);
        assert!(rgb(&texture).eq(codes().as_chunks::<3>().0.iter().copied()), "{space} {on}");
        assert!(notes.is_empty());
    }
}

#[test]
fn unusable_profiles_are_told_and_damaged_ones_never_end_the_program() {
    let folder = tempdir().unwrap();
    let icc = ColorProfile::new_display_p3().encode().unwrap();
    let told = |icc: &[u8], expected: &str| {
        let path = written(folder.path(), "u.png", &png(icc, &codes(), ExtendedColorType::Rgb8));
        let (texture, notes) = read(&path);
        assert!(rgb(&texture).eq(codes().as_chunks::<3>().0.iter().copied()), "{expected}");
        assert!(notes.len() == 1 && notes[0].contains(expected), "{notes:?}");
    };
    told(b"not a profile", "is damaged");
    told(&icc[..icc.len() / 2], "is damaged");
    told(&ColorProfile::new_lab().encode().unwrap(), "its colour profile");
    let mut inks = icc.clone();
    inks[16..20].copy_from_slice(b"CMYK");
    told(&inks, "printing inks");
    // Each byte of header and table damaged, one at a time, and each length: read as something, without an error.
    for at in 0..icc.len().min(420) {
        let mut damaged = icc.clone();
        damaged[at] ^= 0xff;
        let path = written(folder.path(), "d.png", &png(&damaged, &codes(), ExtendedColorType::Rgb8));
        assert_eq!(read(&path).0.width, SIDE);
        let path = written(folder.path(), "d.png", &png(&icc[..at], &codes(), ExtendedColorType::Rgb8));
        assert_eq!(read(&path).0.width, SIDE);
    }
}

#[test]
fn commands_say_what_became_of_colors() {
    let folder = tempdir().unwrap();
    let path = written(folder.path(), "p.png", &rgb_png(&ColorProfile::new_display_p3()));
    let said = |options: &[&str]| {
        let ran = moire().arg("texture").arg(&path).args(options).output().unwrap();
        assert!(ran.status.success(), "{}", String::from_utf8_lossy(&ran.stderr));
        String::from_utf8(ran.stdout).unwrap()
    };
    assert!(said(&["--color-space", "srgb"]).contains("converted to sRGB; "));
    assert!(said(&[]).contains("it applies to color_space \"srgb\""));
    assert!(!said(&["--color-space", "srgb", "--color-profile", "ignore"]).contains("profile"));
    let json: serde_json::Value = serde_json::from_str(&said(&["--color-space", "srgb", "--json"])).unwrap();
    let clipped = json["color_profile"]["clipped"].as_f64().unwrap();
    assert!((0.1..0.9).contains(&clipped), "{clipped}");

    let scene = fs::read_to_string(data().join("scenes/start/floor.toml")).unwrap();
    let file = scene.lines().find(|line| line.starts_with("file = ")).unwrap();
    let scene = written(folder.path(), "s.toml", scene.replace(file, "file = \"p.png\"").as_bytes());
    for (setting, told) in [("apply", true), ("ignore", false)] {
        let out = folder.path().join("o.png");
        let setting = format!("texture.0.color_profile={setting}");
        let ran = moire()
            .args(["render", "--size", "8x8", "-v", "--set", &setting])
            .arg(&scene)
            .arg("-o")
            .arg(out)
            .output()
            .unwrap();
        let said = String::from_utf8_lossy(&ran.stderr).into_owned();
        assert!(ran.status.success(), "{said}");
        assert_eq!(said.contains("converted from"), told, "{said}");
    }
}

#[test]
fn a_new_scene_names_the_profile_and_tells_one_that_cannot_be_applied() {
    let folder = tempdir().unwrap();
    written(folder.path(), "p.png", &rgb_png(&ColorProfile::new_display_p3()));
    let mut inks = ColorProfile::new_display_p3().encode().unwrap();
    inks[16..20].copy_from_slice(b"CMYK");
    written(folder.path(), "u.png", &png(&inks, &codes(), ExtendedColorType::Rgb8));
    let new = |file: &str| {
        let ran =
            moire().current_dir(folder.path()).args(["new", "quad", "--force", "-t", file]).output().unwrap();
        assert!(ran.status.success());
        let text = fs::read_to_string(folder.path().join("quad.toml")).unwrap();
        (text, String::from_utf8(ran.stderr).unwrap())
    };
    let (text, said) = new("p.png");
    assert!(text.contains("converted from ") && !said.contains("profile"), "{text}{said}");
    let (text, said) = new("u.png");
    assert!(!text.contains("converted") && said.contains("printing inks"), "{text}{said}");
}
