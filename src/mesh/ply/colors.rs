//! How a PLY file writes colours. Input: a property's type. Output: the light of its codes.

use ply_rs_bw::ply::{ElementDef, PropertyType, ScalarType};

use crate::core::color::srgb_to_linear;

/// How a file writes a share of light: whole numbers are codes of sRGB up to the greatest of their type, others linear.
#[derive(Clone, Copy)]
pub(super) struct Encoding {
    most: f64,
    is_srgb: bool,
}

impl Encoding {
    pub fn of(element: &ElementDef, name: &str) -> Encoding {
        let most = match element.properties.get(name).map(|property| &property.data_type) {
            Some(PropertyType::Scalar(ScalarType::UChar)) => 255.0,
            Some(PropertyType::Scalar(ScalarType::UShort)) => 65535.0,
            _ => return Encoding { most: 1.0, is_srgb: false },
        };
        Encoding { most, is_srgb: true }
    }

    pub fn share(self, code: f64) -> f64 {
        code / self.most
    }

    /// Returns the light of a code.
    pub fn light(self, code: f64) -> f64 {
        let share = self.share(code);
        if self.is_srgb { srgb_to_linear(share) } else { share }
    }
}
