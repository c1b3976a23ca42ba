//! Converts luminance and chroma of an OpenEXR file to RGB in the file's own primaries (Kainz et
//! al., Technical Introduction to OpenEXR, "Luminance/Chroma Images"): Y = w·(R, G, B), RY = (R −
//! Y)⁄Y, BY = (B − Y)⁄Y, with w the luminances of the primaries.

use std::path::Path;

use exr::math::Vec2;
use exr::meta::attribute::Chromaticities;
use glam::{DMat3, DVec3};

use crate::core::error::{Error, Result};

/// The primaries of a file without a chromaticities attribute: Rec. ITU-R BT.709.
const REC_709: Chromaticities = Chromaticities {
    red: Vec2(0.64, 0.33),
    green: Vec2(0.30, 0.60),
    blue: Vec2(0.15, 0.06),
    white: Vec2(0.3127, 0.3290),
};

/// Returns the luminance of each primary relative to white.
pub(super) fn luminances(file: Option<Chromaticities>, path: &Path) -> Result<DVec3> {
    let file = file.unwrap_or(REC_709);
    // X, Y and Z of a colour of this chromaticity, up to a scale factor.
    let xyz = |Vec2(x, y): Vec2<f32>| DVec3::new(x.into(), y.into(), 1.0 - f64::from(x) - f64::from(y));
    let primaries = DMat3::from_cols(xyz(file.red), xyz(file.green), xyz(file.blue));
    let white = xyz(file.white) / f64::from(file.white.1);
    // Coincident primaries leave only rounding errors in the determinant; those of BT.709 have
    // 0.11.
    if primaries.determinant().abs() > 1e-6 {
        let weights = primaries.inverse() * white * primaries.row(1);
        if weights.is_finite() && weights.y != 0.0 {
            return Ok(weights);
        }
    }
    Err(Error::with_help(
        format!("{}: the chromaticities of this OpenEXR file span no colours", path.display()),
        "mend the attribute `chromaticities`, or store R, G and B",
    ))
}

/// Replaces (Y, RY, BY) in the first three of each texel's four floats by (R, G, B).
pub(super) fn to_rgb(texels: &mut [u8], weights: DVec3) {
    for texel in texels.as_chunks_mut::<16>().0 {
        let (values, _) = texel.as_chunks_mut::<4>();
        let [y, ry, by] = [0, 1, 2].map(|i| f64::from(f32::from_ne_bytes(values[i])));
        let (r, b) = ((ry + 1.0) * y, (by + 1.0) * y);
        let g = (y - r * weights.x - b * weights.z) / weights.y;
        // Grey stays bitwise unchanged, as in OpenEXR's own reader.
        let rgb = if ry == 0.0 && by == 0.0 { [y; 3] } else { [r, g, b] };
        values.iter_mut().zip(rgb).for_each(|(to, value)| *to = (value as f32).to_ne_bytes());
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn luminances_of_the_defaults_are_those_of_rec_709() {
        let weights = luminances(None, Path::new("a.exr")).expect("the defaults span all colours");
        // ITU-R BT.709-6, 3.2, four digits.
        assert!((weights - DVec3::new(0.2126, 0.7152, 0.0722)).abs().max_element() < 5e-5, "{weights}");
        let flat = Chromaticities { green: Vec2(0.64, 0.33), ..REC_709 };
        assert!(luminances(Some(flat), Path::new("a.exr")).is_err());
    }
}
