//! The layers of a picture by name: what each one measures, and its channels.

use crate::core::error::{Error, Result};
use crate::core::named::named_enum;
use crate::scene::model::{Algorithm, Pattern, Quantity, Scene};

named_enum! {
    /// A layer (`--aov`).
    pub enum Aov {
        /// Texels that the pixel covers along the longer and the shorter axis of its footprint.
        Texels = "texels",
        /// log2 of the pixels that a texel covers along the longer axis; above 0 magnified.
        Magnification = "magnification",
        /// The level that the sampler reads for the whole pixel.
        Level = "level",
        /// The footprint's longer axis over its shorter one.
        Anisotropy = "anisotropy",
        /// Different surfaces that samples of the pixel meet; the background is one.
        Surfaces = "surfaces",
        /// The place in the texture.
        Uv = "uv",
        /// The shading normal, towards the camera.
        Normal = "normal",
        /// Distance along the view direction.
        Depth = "depth",
        /// Number of the shape, from 1.
        Instance = "instance",
        /// Number of the material, from 1.
        Material = "material",
        /// Samples of the pixel.
        Samples = "samples",
        /// Estimated error of the pixel's colour.
        Error = "error",
        /// Colour of the material times its texture, averaged as the picture is.
        Albedo = "albedo",
    }
}

impl Aov {
    /// Returns the quantity that a ray through the pixel's centre measures.
    pub(super) fn at_centre(self) -> Option<Quantity> {
        Some(match self {
            Aov::Texels => Quantity::Texels,
            Aov::Magnification => Quantity::Magnification,
            Aov::Level => Quantity::Level,
            Aov::Anisotropy => Quantity::Anisotropy,
            Aov::Uv => Quantity::Uv,
            Aov::Normal => Quantity::Normal,
            Aov::Depth => Quantity::Depth,
            Aov::Instance => Quantity::Instance,
            Aov::Material => Quantity::Material,
            Aov::Surfaces | Aov::Samples | Aov::Error | Aov::Albedo => return None,
        })
    }

    /// Returns the names of its channels.
    pub(super) fn channels(self) -> &'static [&'static str] {
        match self {
            Aov::Texels => &["major", "minor"],
            Aov::Uv => &["U", "V"],
            Aov::Normal => &["X", "Y", "Z"],
            Aov::Albedo => &["R", "G", "B"],
            Aov::Depth => &["Z"],
            _ => &["Y"],
        }
    }

    /// Refuses the estimated error of pictures whose samples would be the same with any seed.
    pub fn check(self, scene: &Scene) -> Result<()> {
        let sampling = &scene.sampling;
        let what = match (sampling.algorithm, sampling.pattern) {
            _ if self != Aov::Error => return Ok(()),
            (Algorithm::Beam | Algorithm::Cone, _) => format!("algorithm \"{}\"", sampling.algorithm),
            (_, Pattern::Center | Pattern::Grid) => format!("pattern \"{}\"", sampling.pattern),
            _ => return Ok(()),
        };
        Err(Error::with_help(
            format!(
                "layer error: {what} takes the same samples with every seed, so two pictures do not differ"
            ),
            "leave error out, or choose a pattern with random numbers, such as --pattern sobol-owen",
        ))
    }
}
