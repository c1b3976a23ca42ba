//! The scene as plain f64 data, after every reference is resolved to an index and every number is
//! known to be finite. Units: scene units, degrees, linear RGB. Nothing here knows a device.

use std::path::PathBuf;

use glam::DVec3;

pub use super::bsdf::Model;
pub use super::camera::{Camera, Lens, Projection};
pub use super::geometry::kinds::*;
pub use super::geometry::{Bounds, Facets, Shape, Shapes};
pub use super::mapping::{Entity, Mapping, MappingKind, Space};
pub use super::material::{BumpMap, Green, Maps, Material, OwnUv, Sides, TextureUse};
pub use super::pixel_filter::{PixelFilter, PixelFilterKind};
pub use super::sampling::{Algorithm, Footprint, Pattern, Precision, Quantity, Sampling};
use crate::core::named::named_enum;
pub use crate::schema::enums::{AlphaMode, BumpKind};
use crate::texture::sampler_spec::{Address, SamplerSpec};
pub use crate::texture::source::{TextureContent, TextureSource};

/// In place of an index: the default material, or the default sampler.
pub const DEFAULT: usize = usize::MAX;

/// All that is rendered, every reference an index.
#[derive(Clone, Debug)]
pub struct Scene {
    /// The scene file, for messages and the default output name.
    pub path: PathBuf,
    /// Where it is seen from.
    pub camera: Camera,
    /// Pixels of the picture in a row.
    pub width: u32,
    /// Rows of the picture.
    pub height: u32,
    /// The reconstruction filter of pixels.
    pub pixel_filter: PixelFilter,
    /// The sampling of the picture.
    pub sampling: Sampling,
    /// The radiance of rays that hit nothing.
    pub background: Background,
    /// The textures of materials and of the environment.
    pub textures: Vec<TextureSource>,
    /// The samplers of textures.
    pub samplers: Vec<SamplerSpec>,
    /// The materials of surfaces.
    pub materials: Vec<Material>,
    /// All shapes; triangles that have no area are left out.
    pub shapes: Shapes,
    /// Triangles that have no area: no ray meets them.
    pub dropped_triangles: usize,
    /// Where the first of them stood.
    pub first_dropped: String,
    /// All lights.
    pub lights: Vec<Light>,
    /// Files of meshes and their materials that the scene was read from, beside its own.
    pub sources: Vec<PathBuf>,
    /// What replaced values of its file, as it was written.
    pub settings: Vec<String>,
    /// What a reader of its files has to tell, for warnings.
    pub notes: Vec<String>,
}

/// The radiance of rays that hit nothing.
#[derive(Clone, Debug, Default)]
pub struct Background {
    /// Without an environment all there is; with one it multiplies the texture.
    pub color: DVec3,
    /// A texture around the scene.
    pub environment: Option<Environment>,
}

/// A texture around the whole scene.
#[derive(Clone, Copy, Debug)]
pub struct Environment {
    /// Index into `Scene::textures`.
    pub texture: usize,
    /// Index into `Scene::samplers`.
    pub sampler: usize,
    /// The mapping of directions to the texture.
    pub layout: EnvironmentLayout,
    /// Degrees about +y, counter-clockwise from above.
    pub rotate: f64,
    /// The address of v that the scene states and that has no effect: rows go on over the poles.
    pub idle_address: Option<Address>,
    /// Left and right exchanged, before it is turned: what the picture has at +x lies at -x.
    pub mirror: bool,
}

named_enum! {
    /// The mapping of directions to an environment's texture (`[background] layout`).
    pub enum EnvironmentLayout {
        /// The image's centre looks along -z, +x to its right, v = 0 at +y.
        Equirectangular = "equirectangular",
        Cube = "cube",
    }
}

/// A light source.
#[derive(Clone, Copy, Debug)]
pub enum Light {
    /// Intensity in W/sr.
    Point {
        /// Where its middle is.
        position: DVec3,
        /// W/sr, red, green and blue.
        intensity: DVec3,
    },
    /// A point that shines within a cone.
    Spot {
        /// Where it is.
        position: DVec3,
        /// The axis of its cone, away from it; any length.
        direction: DVec3,
        /// Along the axis, W/sr, red, green and blue.
        intensity: DVec3,
        /// The angle from the axis up to which it is as bright, in degrees.
        inner: f64,
        /// The angle from the axis at which it ends, in degrees up to 180.
        outer: f64,
        /// The distance at which it ends; infinite for none.
        range: f64,
    },
    /// What rays see that hit nothing, as a light.
    Environment,
    /// Direction towards the light (any length); irradiance in W/m² on a facing surface.
    Directional {
        /// Towards the light; any length.
        direction: DVec3,
        /// W/m² on a facing surface, red, green and blue.
        irradiance: DVec3,
    },
    /// A ball that far away shines like a point of this intensity.
    Sphere {
        /// Where its middle is.
        position: DVec3,
        /// In scene units.
        radius: f64,
        /// W/sr, red, green and blue.
        intensity: DVec3,
    },
    /// Its middle and sides; it shines where edge_u × edge_v points, alike in all directions.
    Rectangle {
        /// Where its middle is.
        position: DVec3,
        /// One side.
        edge_u: DVec3,
        /// The other side.
        edge_v: DVec3,
        /// W/(m² sr), red, green and blue.
        radiance: DVec3,
    },
    /// A disc of the sky of this angular diameter in degrees, above 0; irradiance on a facing surface.
    Sun {
        /// Towards the light; any length.
        direction: DVec3,
        /// Its angular diameter in degrees.
        angle: f64,
        /// W/m² on a facing surface, red, green and blue.
        irradiance: DVec3,
    },
}

impl Light {
    /// Returns whether it shines from more than one place or direction.
    pub fn has_extent(&self) -> bool {
        matches!(
            self,
            Light::Sphere { .. } | Light::Rectangle { .. } | Light::Sun { .. } | Light::Environment
        )
    }
}

impl Scene {
    /// Returns the sampler by which a material's coordinates are placed: the default without a texture. Where its
    /// textures have several, whole tiles leave the coordinates that change none of them.
    pub fn sampler_of(&self, material: &Material) -> SamplerSpec {
        let mut spec = self.samplers.get(material.sampler).copied().unwrap_or_default();
        let procedural = |t: usize| self.textures.get(t).is_some_and(|t| t.content.procedural().is_some());
        if material.texture.is_some_and(procedural) {
            // A pattern repeats nowhere: no whole tiles may leave its coordinates.
            let clamp = Address::ClampToEdge;
            return SamplerSpec { address: [clamp; 2], address_w: clamp, ..spec };
        }
        for other in material.textures().filter_map(|used| self.samplers.get(used.sampler)) {
            let [u, v] = spec.address;
            spec.address = [u.in_common(other.address[0]), v.in_common(other.address[1])];
        }
        spec
    }
}
