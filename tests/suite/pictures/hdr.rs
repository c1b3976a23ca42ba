//! Radiance pictures: signatures, line ends, header variables, the eight orientations, and the
//! three encodings of a scan line.

use moire::internal::texture::data::TexelFormat;

use super::{assert_refused_as, load_bytes};
use crate::support::told;

const SIZE: [usize; 2] = [9, 4];

/// The bytes of texel (x, y) of the visible picture.
fn rgbe(x: usize, y: usize) -> [u8; 4] {
    [128 + 10 * x as u8, 129 + 20 * y as u8, 130 + (x * y) as u8, 120 + x as u8]
}

fn value(x: usize, y: usize) -> [f64; 4] {
    let [r, g, b, e] = rgbe(x, y);
    let scale = 2f64.powi(i32::from(e) - 136);
    [f64::from(r) * scale, f64::from(g) * scale, f64::from(b) * scale, 1.0]
}

/// Scan lines in the order of a resolution line such as `+X 9 -Y 4`.
fn scan_lines(axes: &str) -> Vec<Vec<[u8; 4]>> {
    let [w, h] = SIZE;
    let along = |axis: &str| -> Vec<usize> {
        let count = if axis.ends_with('X') { w } else { h };
        // x grows to the right, y upwards.
        if ["+X", "-Y"].contains(&axis) { (0..count).collect() } else { (0..count).rev().collect() }
    };
    let (major, minor) = axes.split_once(' ').unwrap();
    let texel = |a, b| if major.ends_with('Y') { rgbe(b, a) } else { rgbe(a, b) };
    along(major).into_iter().map(|a| along(minor).into_iter().map(|b| texel(a, b)).collect()).collect()
}

fn resolution(axes: &str) -> String {
    let (major, minor) = axes.split_once(' ').unwrap();
    let count = |axis: &str| if axis.ends_with('X') { SIZE[0] } else { SIZE[1] };
    format!("{major} {} {minor} {}", count(major), count(minor))
}

fn flat(axes: &str) -> Vec<u8> {
    scan_lines(axes).concat().concat()
}

fn file(head: &str, data: &[u8]) -> Vec<u8> {
    [head.as_bytes(), data].concat()
}

fn assert_is_the_picture(bytes: &[u8], what: &str) -> Vec<String> {
    let (t, notes) = load_bytes(bytes).unwrap();
    assert_eq!((t.width, t.height, t.format, t.file_channels), (9, 4, TexelFormat::RgbaFloat, 3), "{what}");
    for (x, y) in (0..4).flat_map(|y| (0..9).map(move |x| (x, y))) {
        let found = [0, 1, 2, 3].map(|c| t.value(x, y, c));
        assert_eq!(found, value(x as usize, y as usize), "{what}: texel ({x}, {y})");
    }
    notes
}

const FORMAT: &str = "FORMAT=32-bit_rle_rgbe";

#[test]
fn all_eight_orders_of_rows_and_columns_show_the_picture_upright() {
    for y in ["-Y", "+Y"] {
        for x in ["+X", "-X"] {
            for axes in [format!("{y} {x}"), format!("{x} {y}")] {
                let head = format!("#?RADIANCE\n{FORMAT}\n\n{}\n", resolution(&axes));
                assert!(assert_is_the_picture(&file(&head, &flat(&axes)), &axes).is_empty());
            }
        }
    }
}

#[test]
fn signatures_line_ends_and_odd_variables_are_read_over() {
    let data = flat("-Y +X");
    for head in [
        format!("#?RGBE\n{FORMAT}\n-Y 4 +X 9\n"),
        format!("#?RADIANCE\r\n{FORMAT}\r\n\r\n-Y 4 +X 9\r\n"),
        "#?RADIANCE\n\n-Y 4 +X 9\n".into(),
        format!(
            "#?RADIANCE\n# by hand\nEXPOSURE=\nGAMMA=nan\nPIXASPECT= 0.5\n {FORMAT} \nno variable\n=\n\n-Y  4  +X 9 \n"
        ),
        format!(
            "#?RADIANCE\nEXPOSURE=2\nEXPOSURE= 0.5\nCOLORCORR= 1 1 1\n{FORMAT}\nEXPOSURE=-1\n\n-Y 4 +X 9\n"
        ),
    ] {
        let notes = assert_is_the_picture(&file(&head, &data), &head);
        assert!(notes.is_empty(), "{head}: {notes:?}");
    }
}

#[test]
fn exposure_leaves_values_as_stored_and_is_told() {
    let head = format!("#?RADIANCE\n{FORMAT}\nEXPOSURE=4\nEXPOSURE=0.5\nCOLORCORR=1 2 1\n\n-Y 4 +X 9\n");
    let notes = assert_is_the_picture(&file(&head, &flat("-Y +X")), "exposed");
    assert!(notes.len() == 1 && notes[0].contains("(2, 4, 2) times the radiance"), "{notes:?}");
}

#[test]
fn runs_of_channels_and_of_texels_are_expanded() {
    let head = format!("#?RADIANCE\n{FORMAT}\n\n-Y 4 +X 9\n");
    let mut by_channel = Vec::new();
    for line in scan_lines("-Y +X") {
        by_channel.extend([2, 2, 0, 9]);
        for c in 0..4 {
            // Four bytes as they are, one run of one, four as they are.
            by_channel.push(4);
            by_channel.extend(line[..4].iter().map(|t| t[c]));
            by_channel.extend([129, line[4][c], 4]);
            by_channel.extend(line[5..].iter().map(|t| t[c]));
        }
    }
    assert_is_the_picture(&file(&head, &by_channel), "runs of channels");

    // A texel, two more by a run, and 256 more by two codes in a row.
    let old = [[9, 8, 7, 140], [1, 1, 1, 2], [3, 3, 3, 140], [1, 1, 1, 0], [1, 1, 1, 1]].concat();
    let head = format!("#?RADIANCE\n{FORMAT}\n\n-Y 1 +X 260\n");
    let (t, _) = load_bytes(&file(&head, &old)).unwrap();
    let reds: Vec<f64> = (0..260).map(|x| t.value(x, 0, 0) / 16.0).collect();
    assert_eq!(reds, [&[9.0; 3][..], &[3.0; 257]].concat());
}

#[test]
fn xyz_is_refused_by_name_and_a_short_file_as_damaged() {
    assert_refused_as(b"#?RADIANCE\nFORMAT=32-bit_rle_xyze\n\n-Y 1 +X 1\n\x80\x80\x80\x80", "CIE XYZ");
    let whole = file(&format!("#?RADIANCE\n{FORMAT}\n\n-Y 4 +X 9\n"), &flat("-Y +X"));
    for length in 12..whole.len() {
        let message = told(load_bytes(&whole[..length]));
        assert!(message.contains("damaged or truncated"), "cut to {length}: {message}");
    }
    let huge = file(&format!("#?RADIANCE\n{FORMAT}\n\n-Y 30000 +X 30000\n"), &flat("-Y +X"));
    assert!(told(load_bytes(&huge)).contains("cannot hold 30000×30000"));
}
