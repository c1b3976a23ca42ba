//! What a packed scene needs → the specialization constants of its pipelines, and the list of what
//! was left out. `FEATURES` is the one table; every constant of `features.glsl` stands in it or
//! among the places and sizes that a pipeline adds.

mod needs;

use crate::core::named::named_enum;
use crate::pack::{
    EntityKind, LightKind, MapKind, PackedScene, ProjectionKind, SampleDimension, Schedule, TextureKind,
};
use crate::scene::model::{BumpKind, Footprint, Model, Pattern, PixelFilterKind};
use crate::schema::layout::{NO_MATERIAL, NO_TEXTURE};
use crate::texture::data::{ColorSpace, Component, TexelFormat};
use crate::texture::procedural::ProceduralKind;
use crate::texture::sampler_spec::{Address, Filter, Method, MipMode, TexelCenter};

pub use needs::bounces;
use needs::{
    bit, bits, bump_kinds, casts_shadows, chooses, compensates, cone_shapes, counted_samples, filters,
    filters_procedurals, rotates, size_kind, stored, unrolled, warps,
};

named_enum! {
    /// Where the shader finds its texels.
    pub enum TexelSource {
        /// No texture in the scene.
        None = "none",
        /// A texel buffer with all textures one after the other.
        Buffer = "buffer",
        /// One image a texture; the only source of the device's own samplers.
        Image = "image",
        /// Images, those of volumes and cubes among them, beside a texel buffer.
        Solids = "solids",
    }
}

named_enum! {
    /// Powers of two wrap by a mask.
    pub enum TextureSize {
        PowerOfTwo = "power-of-two",
        Any = "any",
    }
}

/// "Read the number from the scene."
pub const DYNAMIC: u32 = u32::MAX;

/// Longer lists are read at run time: unrolled code would grow without end.
const UNROLL: usize = 16;

/// How a constant is narrowed to what the scene uses.
#[derive(Clone, Copy)]
enum Narrow {
    /// A bit mask of the modes that occur, and all their names.
    Modes(&'static [&'static str], fn(&PackedScene) -> u32),
    /// A number known when the pipeline is built, or `DYNAMIC`.
    Count(fn(&PackedScene) -> u32),
    /// Code that is there or not.
    Switch(fn(&PackedScene) -> bool),
}
use Narrow::{Count, Modes, Switch};

/// (constant, what a person calls it, how it is narrowed)
const FEATURES: &[(&str, &str, Narrow)] = &[
    ("PROJECTIONS", "projection", Modes(ProjectionKind::NAMES, |s| bit(s.header.size[2]))),
    ("PATTERNS", "pattern", Modes(Pattern::NAMES, |s| bit(s.header.sampling[0]))),
    ("STRATA_SIDE", "number of strata read at run time", Count(|s| s.header.sampling[1])),
    ("SAMPLES", "number of samples read at run time", Count(counted_samples)),
    ("PLANES", "loop over planes", Count(|s| unrolled(s.planes.len()))),
    ("SPHERES", "loop over spheres", Count(|s| unrolled(s.spheres.len()))),
    ("TRIANGLES", "loop over triangles", Count(|s| unrolled(s.triangles.len()))),
    ("LIGHTS", "loop over lights", Count(|s| unrolled(s.lights.len()))),
    ("MATERIALS", "choice among materials", Count(|s| unrolled(s.materials.len()))),
    ("MAPS", "choice among mappings", Count(|s| unrolled(s.maps.len()))),
    ("TEXTURES", "choice among textures", Count(|s| unrolled(s.textures.len()))),
    ("SAMPLERS", "choice among samplers", Count(|s| unrolled(s.samplers.len()))),
    ("BOUNDED_PLANES", "bounds of planes", Switch(|s| s.planes.iter().any(|p| p.link[3] != 0))),
    ("SMOOTH_NORMALS", "interpolated normals", Switch(|s| s.triangles.iter().any(|t| t.v[3] != 0.0))),
    ("MODELS", "reflection model", Modes(Model::NAMES, |s| bits(s.materials.iter().map(|m| m.link[0])))),
    ("LIGHT_KINDS", "light", Modes(LightKind::NAMES, |s| bits(s.lights.iter().map(|l| l.link[0])))),
    ("SHADOWS", "shadow rays", Switch(casts_shadows)),
    ("BOUNCES", "bounces", Switch(bounces)),
    ("ENVIRONMENT", "environment", Switch(|s| s.header.counts[3] != NO_MATERIAL)),
    ("FOOTPRINTS", "footprint", Modes(Footprint::NAMES, |s| bit(s.header.key[2]))),
    ("RANDOM", "random texels", Switch(chooses)),
    ("MAPPINGS", "mapping", Modes(MapKind::NAMES, |s| bits(s.maps.iter().map(|m| m.link[0])))),
    ("ENTITIES", "entity", Modes(EntityKind::NAMES, |s| bits(s.maps.iter().map(|m| m.link[1])))),
    ("ROTATED_UV", "rotation of texture coordinates", Switch(|s| s.maps.iter().any(rotates))),
    ("TEXTURED", "texture look-ups", Switch(|s| s.materials.iter().any(|m| m.link[1] != NO_TEXTURE))),
    ("UNTEXTURED", "plain materials", Switch(|s| s.materials.iter().any(|m| m.link[1] == NO_TEXTURE))),
    ("BUMPED", "bump or normal map", Switch(|s| s.materials.iter().any(|m| m.detail[0] != NO_TEXTURE))),
    ("BUMP_KINDS", "bump or normal map", Modes(BumpKind::NAMES, bump_kinds)),
    ("METHODS", "look-up method", Modes(Method::NAMES, |s| bits(s.samplers.iter().map(|x| x.link[0])))),
    ("ADDRESSES_U", "address u", Modes(Address::NAMES, |s| bits(s.samplers.iter().map(|x| x.modes[0])))),
    ("ADDRESSES_V", "address v", Modes(Address::NAMES, |s| bits(s.samplers.iter().map(|x| x.modes[1])))),
    ("ADDRESSES_W", "address w", Modes(Address::NAMES, |s| bits(s.samplers.iter().map(|x| x.more[0])))),
    ("POLES", "rows over the poles", Switch(|s| s.samplers.iter().any(|x| x.more[1] != 0))),
    ("FILTERS", "filter", Modes(Filter::NAMES, filters)),
    ("MIPS", "mip mode", Modes(MipMode::NAMES, |s| bits(s.samplers.iter().map(|x| x.link[2])))),
    (
        "TEXEL_CENTERS",
        "texel centre",
        Modes(TexelCenter::NAMES, |s| bits(s.samplers.iter().map(|x| x.modes[3]))),
    ),
    ("TEXTURE_SIZES", "texture size", Modes(TextureSize::NAMES, |s| bits(stored(s).map(size_kind)))),
    (
        "TEXTURE_KINDS",
        "texture kind",
        Modes(TextureKind::NAMES, |s| bits(s.textures.iter().map(|t| t.link[3]))),
    ),
    ("MIPMAPPED", "levels of textures", Switch(|s| s.textures.iter().any(|t| t.link[1] > 1))),
    ("NONFINITE", "texels that are no numbers", Switch(PackedScene::has_nonfinite)),
    ("TEXEL_FORMATS", "texel format", Modes(TexelFormat::NAMES, |s| bits(stored(s).map(|t| t.place[3])))),
    ("COLOR_SPACES", "colour space", Modes(ColorSpace::NAMES, |s| bits(stored(s).map(|t| t.link[0])))),
    ("DEEP_SRGB", "sRGB of 16 bits", Switch(|s| s.has_srgb(Component::Unorm16))),
    ("PROCEDURALS", "choice among procedural textures", Count(|s| unrolled(s.procedurals.len()))),
    (
        "PROCEDURAL_KINDS",
        "procedural",
        Modes(ProceduralKind::NAMES, |s| bits(s.procedurals.iter().map(|p| p.link[0]))),
    ),
    ("PROCEDURAL_FILTERED", "filter of procedural textures", Switch(filters_procedurals)),
    ("COMPENSATED", "second film for rounding errors", Switch(compensates)),
    // More than `MAX_PLAIN` of `render_main.glsl`.
    ("BLOCKS", "sums by blocks", Switch(|s| s.samples > 64 || s.schedule == Schedule::Jobs)),
    ("CONE_SHAPES", "cones through more shapes", Count(cone_shapes)),
    ("SAMPLE_DIMENSIONS", "choice of a sample", Modes(SampleDimension::NAMES, |s| s.header.chances[0])),
    ("MOTIONS", "choice among motions", Count(|s| unrolled(s.motions.len()))),
    ("MOVING_CAMERA", "motion of the camera", Switch(|s| s.header.chances[2] != 0)),
    ("SCHEDULES", "schedule", Modes(Schedule::NAMES, |s| bit(s.schedule as u32))),
    ("PIXEL_FILTERS", "pixel filter", Modes(PixelFilterKind::NAMES, |s| bit(s.header.pixel_filter[0]))),
    ("DIAGNOSED", "counters of what goes beyond a limit", Switch(|s| s.guarded)),
    ("TILE_CULLED", "triangles by cells of the picture", Switch(PackedScene::culls_tiles)),
    ("WARPED", "samples beyond their pixels", Switch(warps)),
];

/// What one pipeline is built for.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Features {
    /// (constant, value) in the order of the table.
    pub values: Vec<(&'static str, u32)>,
    /// What the pipeline does without, in words.
    pub left_out: Vec<String>,
    pub source: TexelSource,
    /// Does the film have its second half?
    pub compensated: bool,
    /// Rays, shapes and texture coordinates are of f64.
    pub double: bool,
    /// Nothing is left out.
    pub everything: bool,
}

impl Features {
    /// Exactly what the scene needs, or with `keep_everything` all there is.
    pub fn new(scene: &PackedScene, image_source: bool, keep_everything: bool) -> Features {
        let source = match (scene.textures.is_empty(), image_source) {
            (true, _) if !keep_everything => TexelSource::None,
            (false, true) if scene.has_solids() => TexelSource::Solids,
            (false, true) => TexelSource::Image,
            _ => TexelSource::Buffer,
        };
        let mut features = Features {
            values: Vec::new(),
            left_out: Vec::new(),
            source,
            compensated: true,
            double: scene.double,
            everything: keep_everything,
        };
        if keep_everything {
            features.values = FEATURES.iter().map(|&(name, _, narrow)| (name, everything(narrow))).collect();
            return features;
        }
        features.compensated = compensates(scene);
        for &(name, what, narrow) in FEATURES {
            let value = match narrow {
                Modes(_, of) | Count(of) => of(scene),
                Switch(of) => u32::from(of(scene)),
            };
            features.values.push((name, value));
            features.left_out.extend(left_out(what, narrow, value));
        }
        let unused = [
            ("texel buffer", !matches!(source, TexelSource::Buffer | TexelSource::Solids)),
            ("geometry in f64", !scene.double),
            ("images and device samplers", !matches!(source, TexelSource::Image | TexelSource::Solids)),
        ];
        features.left_out.extend(unused.iter().filter(|(_, unused)| *unused).map(|(text, _)| (*text).into()));
        features
    }
}

impl Features {
    /// Whether the code of a switch is there.
    pub fn has(&self, name: &str) -> bool {
        self.values.iter().any(|(other, value)| *other == name && *value != 0)
    }
}

/// The widest value: every mode, run-time numbers, all code.
fn everything(narrow: Narrow) -> u32 {
    match narrow {
        Modes(names, _) => (1 << names.len()) - 1,
        Count(_) => DYNAMIC,
        Switch(_) => 1,
    }
}

fn left_out(what: &str, narrow: Narrow, value: u32) -> Option<String> {
    match narrow {
        Modes(names, _) => {
            let absent: Vec<&str> =
                names.iter().enumerate().filter(|(i, _)| value >> i & 1 == 0).map(|(_, n)| *n).collect();
            (!absent.is_empty()).then(|| format!("{what}: {}", absent.join(", ")))
        }
        Count(_) => (value != DYNAMIC).then(|| what.to_string()),
        Switch(_) => (value == 0).then(|| what.to_string()),
    }
}

/// Names of the constants that describe features, in the order of the table.
pub fn names() -> impl Iterator<Item = &'static str> {
    FEATURES.iter().map(|f| f.0)
}

/// The widest value of each constant, as `features.glsl` has it for its default.
pub fn widest() -> impl Iterator<Item = (&'static str, u32)> {
    FEATURES.iter().map(|&(name, _, narrow)| (name, everything(narrow)))
}
