//! ICC profiles of the colour spaces of pictures (ICC.1:2022, version 4.4): three colorants and the transfer function of
//! sRGB, a few hundred bytes. In: the space. Out: the bytes of the profile, which JPEG, PNG and TIFF carry.

use glam::{DMat3, DVec2, DVec3};

use super::adaptation::bradford;
use super::gamut::{D65, Gamut};

/// The white of profiles, as their header states it: CIE D50.
const D50: DVec3 = DVec3::new(0.9642, 1.0, 0.8249);
const HEADER_BYTES: usize = 128;
const VERSION: u32 = 0x0440_0000;
/// The date of this code, as profiles must have one and pictures be the same every day.
const DATE: [u16; 6] = [2026, 1, 1, 0, 0, 0];

/// Returns the bytes of a profile for pictures in this space.
pub(super) fn profile(gamut: Gamut) -> Vec<u8> {
    let name = match gamut {
        Gamut::Srgb => "sRGB",
        Gamut::DisplayP3 => "Display P3",
    };
    let white = DVec2::new(D50.x, D50.y) / D50.element_sum();
    let adaptation = bradford(D65, white);
    let colorants = adaptation * gamut.to_xyz();
    let colorant = |i: usize| [b"XYZ ".as_slice(), &[0; 4], &fixed(&colorants.col(i).to_array())].concat();
    let white_point = [b"XYZ ".as_slice(), &[0; 4], &fixed(&D50.to_array())].concat();
    // Shared by three tags, so it is last.
    let contents: [(&[&[u8; 4]], Vec<u8>); 8] = [
        (&[b"desc"], text(name)),
        (&[b"cprt"], text("No copyright, use freely")),
        (&[b"wtpt"], white_point),
        (&[b"chad"], [b"sf32".as_slice(), &[0; 4], &rows(&adaptation)].concat()),
        (&[b"rXYZ"], colorant(0)),
        (&[b"gXYZ"], colorant(1)),
        (&[b"bXYZ"], colorant(2)),
        (&[b"rTRC", b"gTRC", b"bTRC"], transfer()),
    ];
    let tags: usize = contents.iter().map(|(names, _)| names.len()).sum();
    let mut table = (tags as u32).to_be_bytes().to_vec();
    let mut data = Vec::new();
    for (names, mut content) in contents {
        let at = HEADER_BYTES + 4 + 12 * tags + data.len();
        for name in names {
            table.extend(*name);
            table.extend((at as u32).to_be_bytes());
            table.extend((content.len() as u32).to_be_bytes());
        }
        content.resize(content.len().next_multiple_of(4), 0);
        data.extend(content);
    }
    [header(HEADER_BYTES + table.len() + data.len()), table, data].concat()
}

/// Returns the header: a profile of a display whose colours are RGB, by way of XYZ.
fn header(bytes: usize) -> Vec<u8> {
    let mut header = Vec::with_capacity(HEADER_BYTES);
    header.extend((bytes as u32).to_be_bytes());
    header.extend([0; 4]);
    header.extend(VERSION.to_be_bytes());
    header.extend(b"mntrRGB XYZ ");
    header.extend(DATE.iter().flat_map(|part| part.to_be_bytes()));
    header.extend(b"acsp");
    // Platform, flags, manufacturer, model, attributes; the intent is perceptual.
    header.extend([0; 28]);
    header.extend(fixed(&D50.to_array()));
    header.resize(HEADER_BYTES, 0);
    header
}

/// Returns numbers as s15Fixed16Number.
fn fixed(numbers: &[f64]) -> Vec<u8> {
    numbers.iter().flat_map(|number| ((number * 65_536.0).round() as i32).to_be_bytes()).collect()
}

fn rows(matrix: &DMat3) -> Vec<u8> {
    fixed(&matrix.transpose().to_cols_array())
}

/// Returns a text of one record, in English.
fn text(words: &str) -> Vec<u8> {
    let units: Vec<u8> = words.encode_utf16().flat_map(u16::to_be_bytes).collect();
    let head = [1, 12, u32::from_be_bytes(*b"enUS"), units.len() as u32, 28].map(u32::to_be_bytes).concat();
    [b"mluc".as_slice(), &[0; 4], &head, &units].concat()
}

/// Returns the parametric curve of type 3 with the constants of IEC 61966-2-1.
fn transfer() -> Vec<u8> {
    let constants = [2.4, 1.0 / 1.055, 0.055 / 1.055, 1.0 / 12.92, 0.04045];
    [b"para".as_slice(), &[0; 4], &[0, 3, 0, 0], &fixed(&constants)].concat()
}
