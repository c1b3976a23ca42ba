//! What a picture file says of its colours: an ICC profile in JPEG, PNG, TIFF and WebP files (ICC.1:2022), or code points
//! in the chunk cICP of PNG (Rec. ITU-T H.273), which come first. In: the bytes of the file. Out: the transfer functions
//! and the primaries, by way of which `profile_colors` makes sRGB of codes; or why they cannot be used.

use std::borrow::Cow;

use glam::DMat3;
use moxcms::{CicpProfile, ColorProfile as Icc, DataColorSpace, Matrix3d, ProfileText, ToneReprCurve};

use super::formats::PictureFormat;
use super::profile_colors::ProfileColors;
use super::{read_jpeg, read_png, read_webp, tiff};
use crate::core::panics;

/// Beyond this many letters, the name of a profile is cut.
const MAX_NAME: usize = 60;
/// The least determinant of a matrix of primaries that span colours; those of sRGB have 0.2.
const MIN_DETERMINANT: f64 = 1e-3;

/// The colours of a file as it states them.
#[derive(Clone, Debug)]
pub struct ColorProfile {
    /// By the profile itself, such as "Display P3".
    pub name: String,
    pub(super) meaning: Meaning,
}

/// The meaning of the codes of a picture.
#[derive(Clone, Debug)]
pub(super) enum Meaning {
    /// sRGB, within half a code of 8 bits.
    Srgb,
    /// Others, which are converted.
    Colors(Colors),
    /// Unknown, for a reason that completes "the profile …".
    Unusable(&'static str),
}

/// Transfer functions and primaries.
#[derive(Clone, Debug)]
pub(super) enum Colors {
    Grey(ToneReprCurve),
    /// With the matrix to linear sRGB.
    Rgb(Box<[ToneReprCurve; 3]>, DMat3),
}

/// The form in which a file states its colours.
enum Statement<'a> {
    Icc(Cow<'a, [u8]>),
    /// Primaries, transfer function, matrix, and whether codes use their full range.
    CodePoints([u8; 4]),
}

impl ColorProfile {
    /// Returns the profile of a file, if it states one.
    pub fn of_file(file: &[u8], format: PictureFormat) -> Option<ColorProfile> {
        let icc = |bytes: Option<Vec<u8>>| bytes.map(|bytes| Statement::Icc(Cow::Owned(bytes)));
        let statement = match format {
            PictureFormat::Jpeg => icc(read_jpeg::color_profile(file)),
            PictureFormat::Png => match read_png::code_points(file) {
                Some(points) => Some(Statement::CodePoints(points)),
                None => icc(read_png::color_profile(file)),
            },
            PictureFormat::Tiff => {
                tiff::color_profile(file).map(|bytes| Statement::Icc(Cow::Borrowed(bytes)))
            }
            PictureFormat::WebP => {
                read_webp::color_profile(file).map(|bytes| Statement::Icc(Cow::Borrowed(bytes)))
            }
            PictureFormat::Tga
            | PictureFormat::Hdr
            | PictureFormat::OpenExr
            | PictureFormat::Dds
            | PictureFormat::Ktx2 => None,
        }?;
        let read = || Ok(of_statement(&statement));
        let damaged = || ColorProfile { name: "unknown".into(), meaning: Meaning::Unusable("is damaged") };
        Some(panics::contain(&"reading a colour profile", read).ok().flatten().unwrap_or_else(damaged))
    }

    /// Returns true if codes mean other colours than in sRGB, and can be converted.
    pub fn is_converted(&self) -> bool {
        matches!(self.meaning, Meaning::Colors(_))
    }

    /// Returns why codes cannot be converted, in words that complete "the profile …".
    pub fn fault(&self) -> Option<&'static str> {
        match self.meaning {
            Meaning::Unusable(why) => Some(why),
            Meaning::Srgb | Meaning::Colors(_) => None,
        }
    }
}

fn of_statement(statement: &Statement<'_>) -> Option<ColorProfile> {
    let (name, meaning) = match statement {
        Statement::Icc(bytes) => {
            let icc = Icc::new_from_slice(bytes).ok()?;
            (name(&icc), of_icc(&icc))
        }
        Statement::CodePoints(points) => of_code_points(*points),
    };
    let Meaning::Colors(colors) = meaning else { return Some(ColorProfile { name, meaning }) };
    let meaning = match ProfileColors::of(&colors) {
        None => Meaning::Unusable("has curves that are no functions"),
        Some(table) if table.are_srgb() => Meaning::Srgb,
        Some(_) => Meaning::Colors(colors),
    };
    Some(ColorProfile { name, meaning })
}

fn of_icc(icc: &Icc) -> Meaning {
    match icc.color_space {
        DataColorSpace::Gray => match &icc.gray_trc {
            Some(_) if icc.pcs != DataColorSpace::Xyz => {
                Meaning::Unusable("is one of lightness, not of light")
            }
            Some(curve) => Meaning::Colors(Colors::Grey(curve.clone())),
            None => Meaning::Unusable("has no curve"),
        },
        DataColorSpace::Rgb => match (&icc.red_trc, &icc.green_trc, &icc.blue_trc) {
            (Some(r), Some(g), Some(b)) if icc.pcs == DataColorSpace::Xyz => {
                let matrix =
                    columns(Icc::new_srgb().rgb_to_xyz_matrix()).inverse() * columns(icc.rgb_to_xyz_matrix());
                if matrix.is_finite() && matrix.determinant().abs() > MIN_DETERMINANT {
                    Meaning::Colors(Colors::Rgb(Box::new([r.clone(), g.clone(), b.clone()]), matrix))
                } else {
                    Meaning::Unusable("has primaries that span no colours")
                }
            }
            _ => Meaning::Unusable("is one of tables, not of three curves and a matrix"),
        },
        DataColorSpace::Cmyk => Meaning::Unusable("is one of printing inks"),
        _ => Meaning::Unusable("is neither one of red, green and blue nor of grey"),
    }
}

/// Returns the colours of four code points, and their name.
fn of_code_points([primaries, transfer, matrix, full]: [u8; 4]) -> (String, Meaning) {
    let mut name = format!("H.273 {primaries}/{transfer}");
    // BT.709 and its like, gamma 2.2 and 2.8, linear, sRGB; the others are of pictures brighter than white.
    if !matches!(transfer, 1 | 4 | 5 | 6 | 8 | 13 | 14 | 15) || (matrix, full) != (0, 1) {
        return (name, Meaning::Unusable("has code points that are not known here"));
    }
    let (Ok(of_primaries), Ok(of_transfer)) = (primaries.try_into(), transfer.try_into()) else {
        return (name, Meaning::Unusable("has code points of no meaning"));
    };
    match (primaries, transfer) {
        (1, 13) => return ("sRGB".into(), Meaning::Srgb),
        (12, 13) => name = "Display P3".into(),
        (9, _) => name = "BT.2020".into(),
        _ => {}
    }
    let mut icc = Icc::new_srgb();
    icc.cicp = None;
    icc.update_rgb_colorimetry_from_cicp(CicpProfile {
        color_primaries: of_primaries,
        transfer_characteristics: of_transfer,
        matrix_coefficients: moxcms::MatrixCoefficients::Identity,
        full_range: true,
    });
    // Unknown primaries leave it as it was.
    match icc.cicp {
        Some(_) => (name, of_icc(&icc)),
        None => (name, Meaning::Unusable("has code points of no meaning")),
    }
}

fn columns(matrix: Matrix3d) -> DMat3 {
    DMat3::from_cols_array_2d(&matrix.v).transpose()
}

/// Returns the description of a profile in one line.
fn name(icc: &Icc) -> String {
    let text = match &icc.description {
        Some(ProfileText::PlainString(text)) => text.as_str(),
        Some(ProfileText::Localizable(texts)) => texts.first().map_or("", |text| text.value.as_str()),
        Some(ProfileText::Description(text)) => text.ascii_string.as_str(),
        None => "",
    };
    let shown: String = text.chars().filter(|c| !c.is_control()).take(MAX_NAME).collect();
    if shown.trim().is_empty() { "unnamed".into() } else { shown.trim().into() }
}
