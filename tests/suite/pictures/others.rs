//! TGA pictures, and NRRD volumes of every type of number.

use std::fs;

use moire::internal::texture::data::{Dimension, TexelFormat};
use tempfile::tempdir;

use super::{load, load_bytes};
use crate::support::told;

/// A header of 18 bytes: image type, bits of a map's entry and of a texel, 2×2 texels, flags.
fn tga_header(kind: u8, map: [u8; 2], bits: u8, flags: u8) -> Vec<u8> {
    let [entries, map_bits] = map;
    let has_map = u8::from(entries > 0);
    vec![0, has_map, kind, 0, 0, entries, 0, map_bits, 0, 0, 0, 0, 2, 0, 2, 0, bits, flags]
}

#[test]
fn tga_with_runs_palettes_alpha_and_either_first_row_is_read() {
    const FROM_TOP: u8 = 0x20;
    let rgb = [[1, 2, 3], [4, 5, 6], [7, 8, 9], [10, 11, 12]];
    let bgr = |order: [usize; 4]| order.iter().flat_map(|&i| rgb[i].into_iter().rev()).collect::<Vec<u8>>();
    let want: Vec<u8> = rgb.iter().flat_map(|t| [t[0], t[1], t[2], 255]).collect();
    let of = |header: Vec<u8>, data: &[u8]| load_bytes(&[header, data.to_vec()].concat()).unwrap().0;

    assert_eq!(of(tga_header(2, [0, 0], 24, FROM_TOP), &bgr([0, 1, 2, 3])).texels, want);
    assert_eq!(of(tga_header(2, [0, 0], 24, 0), &bgr([2, 3, 0, 1])).texels, want, "from the bottom");
    let runs = [&[0x03][..], &bgr([0, 1, 2, 3])].concat();
    assert_eq!(of(tga_header(10, [0, 0], 24, FROM_TOP), &runs).texels, want);
    let same = of(tga_header(10, [0, 0], 24, FROM_TOP), &[0x83, 3, 2, 1]);
    assert_eq!(same.texels, [1, 2, 3, 255].repeat(4));
    let mapped = [&bgr([0, 1, 2, 3])[..], &[0, 1, 2, 3]].concat();
    assert_eq!(of(tga_header(1, [4, 24], 8, FROM_TOP), &mapped).texels, want);
    let grey = of(tga_header(3, [0, 0], 8, FROM_TOP), &[5, 6, 7, 8]);
    assert_eq!((grey.format, &grey.texels[..]), (TexelFormat::Grey8, &[5, 6, 7, 8][..]));
    let bgra: Vec<u8> = (0..16).collect();
    let alpha = of(tga_header(2, [0, 0], 32, FROM_TOP | 8), &bgra);
    assert_eq!((alpha.file_channels, &alpha.texels[..8]), (4, &[2, 1, 0, 3, 6, 5, 4, 7][..]));

    let message = told(load_bytes(&[tga_header(2, [0, 0], 24, FROM_TOP), vec![0; 11]].concat()));
    assert!(message.contains("TGA data is damaged or truncated"), "{message}");
}

#[test]
fn nrrd_of_every_type_of_number_is_read() {
    let folder = tempdir().unwrap();
    let path = folder.path().join("a.nrrd");
    for (types, bits, data, want) in [
        (&["uchar", "uint8_t"][..], 8, &[0u8, 51, 255][..], [0.0, 0.2, 1.0]),
        (&["signed char", "int8"], 8, &[0, 0x7f, 0x80], [0.0, 1.0, -1.0]),
        (&["ushort"], 16, &[0, 0, 0x33, 0x33, 0xff, 0xff], [0.0, 0.2, 1.0]),
        (&["short", "signed short int", "int16_t"], 16, &[0, 0, 0x7f, 0xff, 0x80, 1], [0.0, 1.0, -1.0]),
        (&["uint"], 32, &[0, 0, 0, 0, 0x33, 0x33, 0x33, 0x33, 0xff, 0xff, 0xff, 0xff], [0.0, 0.2, 1.0]),
        (&["int", "int32"], 32, &[0, 0, 0, 0, 0x7f, 0xff, 0xff, 0xff, 0x80, 0, 0, 0], [0.0, 1.0, -1.0]),
        (&["float"], 32, &[0, 0, 0, 0, 0x40, 0x20, 0, 0, 0xc2, 0xc8, 0, 0], [0.0, 2.5, -100.0]),
    ] {
        for name in types {
            for endian in ["big", "little"] {
                let mut data = data.to_vec();
                if endian == "little" {
                    data.chunks_exact_mut(bits / 8).for_each(<[u8]>::reverse);
                }
                assert_nrrd(&path, name, endian, &data, want);
            }
        }
    }
    let doubles: Vec<u8> = [0.0, 2.5, -1e30].iter().flat_map(|v: &f64| v.to_le_bytes()).collect();
    assert_nrrd(&path, "double", "little", &doubles, [0.0, 2.5, -1e30]);
    let longs: Vec<u8> = [0, i64::MAX, i64::MIN].iter().flat_map(|v| v.to_le_bytes()).collect();
    assert_nrrd(&path, "long long", "little", &longs, [0.0, 1.0, -1.0]);
    let unsigned: Vec<u8> = [0, u64::MAX / 5, u64::MAX].iter().flat_map(|v| v.to_le_bytes()).collect();
    assert_nrrd(&path, "uint64", "little", &unsigned, [0.0, 0.2, 1.0]);
}

fn assert_nrrd(path: &std::path::Path, kind: &str, endian: &str, data: &[u8], want: [f64; 3]) {
    let head =
        format!("NRRD0004\ntype: {kind}\ndimension: 3\nsizes: 3 1 1\nencoding: raw\nendian: {endian}\n\n");
    fs::write(path, [head.as_bytes(), data].concat()).unwrap();
    let (t, _) = load(path, Dimension::Three).unwrap();
    for (x, want) in want.into_iter().enumerate() {
        let found = t.value(x as u32, 0, 0);
        // One rounding to f32; the values of 8 and 16 bits are exact.
        assert!(
            (found - want).abs() <= want.abs() * 2f64.powi(-24),
            "{kind} {endian} {x}: {found} for {want}"
        );
    }
}

#[test]
fn nrrd_of_blocks_and_of_sizes_beyond_the_file_is_refused() {
    let folder = tempdir().unwrap();
    let path = folder.path().join("a.nrrd");
    let head = "NRRD0004\ndimension: 3\nendian: little\n";
    fs::write(&path, format!("{head}type: block\nsizes: 1 1 1\nencoding: raw\n\n")).unwrap();
    let message = told(load(&path, Dimension::Three));
    assert!(message.contains("\"type\"") && message.contains("double"), "{message}");
    for encoding in ["raw", "gzip"] {
        fs::write(&path, format!("{head}type: short\nsizes: 1000 1000 1000\nencoding: {encoding}\n\n"))
            .unwrap();
        let message = told(load(&path, Dimension::Three));
        assert!(message.contains("the data ends early") && message.contains("2000000000"), "{message}");
    }
}
