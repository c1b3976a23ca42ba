//! The scene as plain f64 data, after every reference is resolved to an index and every number is
//! known to be finite. Units: scene units, degrees, linear RGB. Nothing here knows a device.

use std::path::PathBuf;

use glam::{DVec2, DVec3};

pub use super::camera::{Camera, Lens, Projection};
pub use super::mapping::{Entity, Mapping, MappingKind, Space};
pub use super::pixel_filter::{PixelFilter, PixelFilterKind};
use crate::named::named_enum;
use crate::texture::sampler_spec::{Address, SamplerSpec};
pub use crate::texture::source::{TextureContent, TextureSource};

#[derive(Clone, Debug)]
pub struct Scene {
    /// The scene file, for messages and the default output name.
    pub path: PathBuf,
    pub camera: Camera,
    pub width: u32,
    pub height: u32,
    pub pixel_filter: PixelFilter,
    pub sampling: Sampling,
    pub background: Background,
    pub textures: Vec<TextureSource>,
    pub samplers: Vec<SamplerSpec>,
    pub materials: Vec<Material>,
    pub planes: Vec<Plane>,
    pub spheres: Vec<Sphere>,
    pub triangles: Vec<Triangle>,
    pub lights: Vec<Light>,
}

/// What rays see that hit nothing.
#[derive(Clone, Debug, Default)]
pub struct Background {
    /// Without an environment all there is; with one it multiplies the texture.
    pub color: DVec3,
    pub environment: Option<Environment>,
}

/// A texture around the whole scene.
#[derive(Clone, Copy, Debug)]
pub struct Environment {
    /// Index into `Scene::textures`.
    pub texture: usize,
    /// Index into `Scene::samplers`.
    pub sampler: usize,
    pub layout: EnvironmentLayout,
    /// Degrees about +y, counter-clockwise from above.
    pub rotate: f64,
}

named_enum! {
    /// How directions lie on an environment's texture (`[background] layout`).
    pub enum EnvironmentLayout {
        /// The image's centre looks along -z, +x to its right, v = 0 at +y.
        Equirectangular = "equirectangular",
        Cube = "cube",
    }
}

named_enum! {
    /// How many rays a pixel sends and what becomes of them (`[sampling] algorithm`).
    #[derive(Default)]
    pub enum Algorithm {
        /// As many as asked for, the same number in each pixel.
        #[default]
        Samples = "samples",
        /// More where the picture errs more.
        Adaptive = "adaptive",
        /// One beam a pixel, cut by the polygons that it meets: exact areas, exact integrals.
        Beam = "beam",
        /// What meets the goal of `--budget` or `--target-error` soonest.
        Auto = "auto",
        /// One cone a pixel and no sample (Amanatides 1984).
        Cone = "cone",
    }
}

named_enum! {
    /// Where in the pixel the samples lie (`[sampling] pattern`).
    pub enum Pattern {
        Center = "center",
        Grid = "grid",
        Random = "random",
        Stratified = "stratified",
        /// Kensler 2013, correlated.
        MultiJittered = "multi-jittered",
        /// Bases 2 and 3, nested scrambling.
        Halton = "halton",
        /// A (0,2)-sequence, nested scrambling (Burley 2020).
        SobolOwen = "sobol-owen",
        /// Blocks of one sequence along a shuffled Morton curve of pixels (Ahmed & Wonka 2020).
        BlueNoise = "blue-noise",
        /// Shirley 1991, also known as latin hypercube.
        NRooks = "n-rooks",
    }
}

impl Pattern {
    /// A sequence: positions do not depend on how many samples there are, so that any number of them, from
    /// the first on, is a set of the same kind.
    pub const fn goes_on(self) -> bool {
        matches!(self, Pattern::Center | Pattern::Random | Pattern::Halton | Pattern::SobolOwen)
    }

    /// Whether each pixel may stop at another number of samples.
    pub fn stops_anywhere(self) -> bool {
        self.goes_on() && self != Pattern::Center
    }

    /// Strata along each side of a pixel, of `multi-jittered` columns; 1 where the pattern has none.
    pub const fn strata_side(self, samples: u32) -> u32 {
        match self {
            Pattern::Grid | Pattern::Stratified | Pattern::MultiJittered => samples.isqrt(),
            _ => 1,
        }
    }

    /// Whether all pixels may have one set of displacements.
    pub const fn can_be_shared(self) -> bool {
        use Pattern::{Halton, MultiJittered, NRooks, SobolOwen, Stratified};
        matches!(self, Stratified | MultiJittered | Halton | SobolOwen | NRooks)
    }
}

named_enum! {
    /// Over what a texture look-up is averaged (`[sampling] footprint`).
    pub enum Footprint {
        None = "none",
        /// A width and a spread (Amanatides 1984; Akenine-Möller et al. 2021).
        Cone = "cone",
        /// Two vectors each of origin and direction (Igehy 1999).
        Differentials = "differentials",
    }
}

named_enum! {
    /// In which numbers rays meet shapes and texture coordinates are formed (`[sampling] precision`).
    #[derive(Default)]
    pub enum Precision {
        /// f64 where f32 would misplace a texel or an outline.
        #[default]
        Auto = "auto",
        Single = "single",
        Double = "double",
    }
}

impl Algorithm {
    /// Whether pixels may get different numbers of samples.
    pub fn is_adaptive(self) -> bool {
        matches!(self, Algorithm::Adaptive | Algorithm::Auto)
    }
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sampling {
    pub algorithm: Algorithm,
    pub pattern: Pattern,
    /// Samples per pixel, at least 1; a square for `grid` and `stratified`, a power of two for
    /// `blue-noise`.
    pub spp: u32,
    /// True: one set of displacement vectors for all pixels (the lecture's variant).
    pub shared: bool,
    pub seed: u32,
    /// Mirror bounces after the camera ray; exhausted means black.
    pub max_depth: u32,
    pub footprint: Footprint,
    pub precision: Precision,
}

named_enum! {
    /// Reflection model of a material.
    pub enum Model {
        Unlit = "unlit",
        Lambert = "lambert",
        Mirror = "mirror",
        /// Mirrors or refracts, by Fresnel's share of each.
        Dielectric = "dielectric",
        /// Lambert with a highlight.
        Phong = "phong",
    }
}

impl Model {
    /// Whether lights shine on it.
    pub const fn is_lit(self) -> bool {
        matches!(self, Model::Lambert | Model::Phong)
    }
}

named_enum! {
    /// What a material's relief texture holds.
    pub enum ReliefKind {
        /// Unit normals as 2 rgb - 1: along growing u, along growing v, outward.
        Normal = "normal",
        /// Heights.
        Bump = "bump",
    }
}

/// A texture that turns the shading normal.
#[derive(Clone, Copy, Debug)]
pub struct Relief {
    pub kind: ReliefKind,
    /// Index into `Scene::textures`.
    pub texture: usize,
    /// Normal map: factor of the two components along the surface. Bump map: height of a texel of 1, in
    /// scene units.
    pub strength: f64,
}

#[derive(Clone, Debug)]
pub struct Material {
    pub name: String,
    pub model: Model,
    /// Multiplies the texture.
    pub color: DVec3,
    /// Index into `Scene::textures`.
    pub texture: Option<usize>,
    /// Index into `Scene::samplers`; meaningful where a texture or a relief is set.
    pub sampler: usize,
    pub mapping: Mapping,
    pub relief: Option<Relief>,
    /// Of the highlight of `phong`.
    pub specular: DVec3,
    pub exponent: f64,
    /// Refractive index of `dielectric` behind its surface, over that in front of it.
    pub ior: f64,
    /// Of `mirror` and `dielectric`, from 0, which is smooth, to 1.
    pub roughness: f64,
}

impl Default for Material {
    fn default() -> Self {
        Material {
            name: "default".to_owned(),
            model: Model::Lambert,
            color: DVec3::ONE,
            texture: None,
            sampler: 0,
            mapping: Mapping::default(),
            relief: None,
            specular: DVec3::splat(0.5),
            exponent: 32.0,
            ior: 1.5,
            roughness: 0.0,
        }
    }
}

impl Material {
    /// Whether a map leads to a texture of this material.
    pub fn is_mapped(&self) -> bool {
        self.texture.is_some() || self.relief.is_some()
    }
}

#[derive(Clone, Copy, Debug)]
pub struct Plane {
    pub origin: DVec3,
    pub tangent: DVec3,
    pub bitangent: DVec3,
    /// Bounds |u| and |v|, measured in tangents and bitangents; infinite without.
    pub half_extent: Option<f64>,
    pub material: usize,
    /// How far it moves between the times 0 and 1.
    pub motion: DVec3,
}

#[derive(Clone, Copy, Debug)]
pub struct Sphere {
    pub center: DVec3,
    pub radius: f64,
    pub material: usize,
    pub motion: DVec3,
}

#[derive(Clone, Copy, Debug)]
pub struct Triangle {
    pub vertices: [DVec3; 3],
    pub uvs: [DVec2; 3],
    /// Shading normals (any length, not zero); the geometric normal without.
    pub normals: Option<[DVec3; 3]>,
    pub material: usize,
    pub motion: DVec3,
}

#[derive(Clone, Copy, Debug)]
pub enum Light {
    /// Intensity in W/sr.
    Point { position: DVec3, intensity: DVec3 },
    /// Direction towards the light (any length); irradiance in W/m² on a facing surface.
    Directional { direction: DVec3, irradiance: DVec3 },
    /// A ball that far away shines like a point of this intensity.
    Sphere { position: DVec3, radius: f64, intensity: DVec3 },
    /// Its middle and sides; it shines where edge_u × edge_v points, alike in all directions.
    Rectangle { position: DVec3, edge_u: DVec3, edge_v: DVec3, radiance: DVec3 },
    /// A disc of the sky of this angular diameter in degrees, above 0; irradiance on a facing surface.
    Sun { direction: DVec3, angle: f64, irradiance: DVec3 },
}

impl Light {
    pub fn has_extent(&self) -> bool {
        matches!(self, Light::Sphere { .. } | Light::Rectangle { .. } | Light::Sun { .. })
    }
}

impl Sampling {
    /// Samples that are really taken: all of `center` lie at one place, so one is enough, and a cone is one.
    pub fn samples(&self) -> u32 {
        let one = self.pattern == Pattern::Center || self.algorithm == Algorithm::Cone;
        if one { 1 } else { self.spp }
    }

    pub fn strata_side(&self) -> u32 {
        self.pattern.strata_side(self.spp)
    }
}

impl Scene {
    /// The sampler a material's texture is read through; the default where there is none.
    pub fn sampler_of(&self, material: &Material) -> SamplerSpec {
        let spec = self.samplers.get(material.sampler).copied().unwrap_or_default();
        let procedural = |t: usize| self.textures.get(t).is_some_and(|t| t.content.procedural().is_some());
        if material.texture.is_some_and(procedural) {
            // A pattern repeats nowhere: no whole tiles may leave its coordinates.
            let clamp = Address::ClampToEdge;
            return SamplerSpec { address: [clamp; 2], address_w: clamp, ..spec };
        }
        spec
    }
}
