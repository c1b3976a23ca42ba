//! The colour spaces of display-referred pictures. In: linear colours of sRGB, in which scenes are rendered. Out: the
//! matrix to the primaries of another space, and the numbers by which files name it.

use glam::{DMat3, DVec2, DVec3};

use crate::core::named::named_enum;

named_enum! {
    /// The primaries of a display-referred picture; white is D65 and the transfer function that of sRGB in each.
    pub enum Gamut {
        /// IEC 61966-2-1, the primaries of Rec. ITU-R BT.709.
        Srgb = "srgb",
        /// SMPTE EG 432-1: the wider primaries of digital cinema, as screens have them.
        DisplayP3 = "display-p3",
    }
}

/// The chromaticity of D65, white of both spaces.
pub const D65: DVec2 = DVec2::new(0.3127, 0.3290);

impl Gamut {
    /// Returns the chromaticities of red, green and blue.
    pub fn primaries(self) -> [DVec2; 3] {
        match self {
            Gamut::Srgb => [DVec2::new(0.640, 0.330), DVec2::new(0.300, 0.600), DVec2::new(0.150, 0.060)],
            Gamut::DisplayP3 => {
                [DVec2::new(0.680, 0.320), DVec2::new(0.265, 0.690), DVec2::new(0.150, 0.060)]
            }
        }
    }

    /// Returns the matrix from linear colours to CIE XYZ, in which white has Y = 1.
    pub fn to_xyz(self) -> DMat3 {
        let [r, g, b] = self.primaries().map(xyz_of);
        let primaries = DMat3::from_cols(r, g, b);
        primaries * DMat3::from_diagonal(primaries.inverse() * xyz_of(D65))
    }

    /// Returns the matrix from linear colours of sRGB to linear ones of this space.
    pub fn from_srgb(self) -> DMat3 {
        self.to_xyz().inverse() * Gamut::Srgb.to_xyz()
    }

    /// Returns the number of the primaries in Rec. ITU-T H.273, which the chunk cICP of PNG states.
    pub const fn code_point(self) -> u8 {
        match self {
            Gamut::Srgb => 1,
            Gamut::DisplayP3 => 12,
        }
    }
}

/// Returns the colour of this chromaticity with Y = 1.
pub fn xyz_of(xy: DVec2) -> DVec3 {
    DVec3::new(xy.x / xy.y, 1.0, (1.0 - xy.x - xy.y) / xy.y)
}
