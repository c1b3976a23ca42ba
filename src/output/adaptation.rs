//! White balance: which chromaticity light of a colour temperature has, and the matrix after which it looks white. In:
//! kelvin. Out: chromaticities of CIE 1931, and matrices of linear colours.

use std::ops::RangeInclusive;

use glam::{DMat3, DVec2};

use super::gamut::{D65, Gamut, xyz_of};

/// The colour temperatures, in kelvin, that a white balance takes: from the glow of embers to the blue of the sky.
pub const KELVINS: RangeInclusive<f64> = 1500.0..=25_000.0;
/// Between these temperatures the light is a mixture of a black body and daylight (ANSI/IES TM-30-20, reference
/// illuminants); below there is no daylight, above no black body.
const MIXED: [f64; 2] = [4000.0, 5000.0];

/// Returns the colour temperature that a text states, or what was expected.
pub fn parse_kelvin(text: &str) -> Result<f64, String> {
    let value = text.parse().ok().filter(|value| KELVINS.contains(value));
    value.ok_or_else(|| {
        format!(
            "expected kelvin from {} to {}: lamps have about 2700, daylight 6500",
            KELVINS.start(),
            KELVINS.end()
        )
    })
}

/// Returns the matrix after which linear colours of sRGB that have the chromaticity of light of this temperature are
/// neutral, with the luminance that they had.
pub fn white_balance(kelvin: f64) -> DMat3 {
    let to_xyz = Gamut::Srgb.to_xyz();
    to_xyz.inverse() * bradford(white_of(kelvin), D65) * to_xyz
}

/// Returns the chromatic adaptation from one white to another by the cone responses of Bradford (K. M. Lam 1985, as
/// ICC.1:2022, annex E, states it): a matrix of CIE XYZ.
pub fn bradford(from: DVec2, to: DVec2) -> DMat3 {
    let responses = DMat3::from_cols_array(&[
        0.8951, -0.7502, 0.0389, //
        0.2664, 1.7135, -0.0685, //
        -0.1614, 0.0367, 1.0296,
    ]);
    let gains = (responses * xyz_of(to)) / (responses * xyz_of(from));
    responses.inverse() * DMat3::from_diagonal(gains) * responses
}

/// Returns the chromaticity of light of this correlated colour temperature.
pub fn white_of(kelvin: f64) -> DVec2 {
    let share = ((kelvin - MIXED[0]) / (MIXED[1] - MIXED[0])).clamp(0.0, 1.0);
    if share <= 0.0 {
        return black_body(kelvin);
    }
    if share >= 1.0 {
        return daylight(kelvin);
    }
    // Both with the same luminance.
    let mixed = xyz_of(black_body(kelvin)).lerp(xyz_of(daylight(kelvin)), share);
    DVec2::new(mixed.x, mixed.y) / mixed.element_sum()
}

/// Returns the chromaticity of a black body by the rational fit in CIE 1960 UCS of M. Krystek (1985), which is within
/// 8e-5 in u and 9e-5 in v from 1000 to 15000 K.
fn black_body(kelvin: f64) -> DVec2 {
    let t = kelvin;
    let u = (0.860_117_757 + 1.541_182_54e-4 * t + 1.286_412_12e-7 * t * t)
        / (1.0 + 8.424_202_35e-4 * t + 7.081_451_63e-7 * t * t);
    let v = (0.317_398_726 + 4.228_062_45e-5 * t + 4.204_816_91e-8 * t * t)
        / (1.0 - 2.897_418_16e-5 * t + 1.614_560_53e-7 * t * t);
    DVec2::new(3.0 * u, 2.0 * v) / (2.0 * u - 8.0 * v + 4.0)
}

/// Returns the chromaticity of the illuminant D of this temperature (CIE 15:2018, 3.1), which is defined from 4000 to
/// 25000 K.
fn daylight(kelvin: f64) -> DVec2 {
    let t = 1000.0 / kelvin;
    let x = if kelvin <= 7000.0 {
        0.244_063 + t * (0.099_11 + t * (2.967_8 - t * 4.607_0))
    } else {
        0.237_040 + t * (0.247_48 + t * (1.901_8 - t * 2.006_4))
    };
    DVec2::new(x, -0.275 + x * (2.870 - 3.000 * x))
}
