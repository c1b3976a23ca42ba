//! All limits of a scene. Input: single values, or several that must be consistent. Output: whether they are valid, for
//! scenes of any format, for those built in code and for options of the command line alike.

use std::ops::RangeInclusive;

use glam::DVec3;

use super::model::{Pattern, Scene};
use crate::core::error::{Error, ErrorKind, Result};
use crate::texture::data::Dimension;
use crate::texture::sampler_spec::{Filter, Method, SamplerSpec};

/// Pixels along one side of a picture.
pub const MAX_SIZE: u32 = 16384;
/// Samples per pixel: sample positions are multiples of 2⁻²⁴, so more could not be distinguished.
pub const MAX_SPP: u32 = 1 << 24;
/// Bounces after the camera ray.
pub const MAX_DEPTH: u32 = 64;
/// Shapes of all kinds together, a mesh being one: devices test each of them for every ray.
pub(super) const MAX_SHAPES: usize = 65535;
/// Triangles of a mesh file: devices number those of a shape in f32.
pub(super) const MAX_TRIANGLES: usize = 1 << 24;
pub(super) const MAX_TEXTURES: usize = 1024;
/// Texels of a ramp, files of a stack, and texels along each side of a raw volume.
pub(super) const MAX_TEXELS: u32 = 65_536;
/// Largest radius of a pixel filter, in pixels.
pub const MAX_RADIUS: f64 = 8.0;
/// Footprints more elongated than this are blurred.
pub const MAX_ANISOTROPY: u32 = 64;

pub(super) const SIZE: RangeInclusive<u32> = 1..=MAX_SIZE;
pub(super) const SPP: RangeInclusive<u32> = 1..=MAX_SPP;
pub(super) const DEPTH: RangeInclusive<u32> = 0..=MAX_DEPTH;
pub(super) const ANISOTROPY: RangeInclusive<u32> = 1..=MAX_ANISOTROPY;
pub(super) const TEXELS: RangeInclusive<u32> = 1..=MAX_TEXELS;
pub(super) const DIMENSIONS: RangeInclusive<u32> = 2..=3;

/// The set of valid finite numbers. All are below 1e30, which leaves headroom in single precision (3.4e38), and lengths
/// are above 1e-30, where it would underflow.
pub(super) struct Limits {
    /// Completes "a number".
    pub words: &'static str,
    pub allow: fn(f64) -> bool,
}

pub(super) const COORDINATE: Limits = Limits { words: "between -1e30 and 1e30", allow: |x| x.abs() <= 1e30 };
pub(super) const LENGTH: Limits =
    Limits { words: "above 0 (1e-30 to 1e30)", allow: |x| (1e-30..=1e30).contains(&x) };
pub(super) const NOT_NEGATIVE: Limits =
    Limits { words: "that is not negative (0 to 1e30)", allow: |x| (0.0..=1e30).contains(&x) };
pub(super) const UNIT: Limits = Limits { words: "from 0 to 1", allow: |x| (0.0..=1.0).contains(&x) };
pub(super) const CAP: Limits =
    Limits { words: "from 0 to 180 degrees", allow: |x| (0.0..=180.0).contains(&x) };
pub(super) const COLOR: Limits =
    Limits { words: "that are not negative (0 to 1e30)", allow: |x| (0.0..=1e30).contains(&x) };
pub(super) const FOV: Limits =
    Limits { words: "above 0 and below 180 degrees", allow: |x| x > 0.0 && x < 180.0 };
pub(super) const SCALE: Limits =
    Limits { words: "other than 0 (magnitude 1e-30 to 1e30)", allow: |x| (1e-30..=1e30).contains(&x.abs()) };
pub(super) const IOR: Limits = Limits { words: "from 0.01 to 100", allow: |x| (0.01..=100.0).contains(&x) };
pub(super) const EXPONENT: Limits = Limits { words: "from 1 to 1e6", allow: |x| (1.0..=1e6).contains(&x) };
pub(super) const RADIUS: Limits =
    Limits { words: "above 0 and at most 8 (pixels)", allow: |x| (1e-30..=MAX_RADIUS).contains(&x) };
pub(super) const LACUNARITY: Limits = Limits { words: "from 1 to 16", allow: |x| (1.0..=16.0).contains(&x) };
pub(super) const GAIN: Limits = Limits { words: "from 0.01 to 1", allow: |x| (0.01..=1.0).contains(&x) };
pub(super) const DISTORTION: Limits =
    Limits { words: "from 0 to 100", allow: |x| (0.0..=100.0).contains(&x) };
pub(super) const ASPECT: Limits =
    Limits { words: "from 0.01 to 100", allow: |x| (0.01..=100.0).contains(&x) };

impl Limits {
    /// Returns true if a value of single precision is one of those numbers, rounded.
    pub fn allow_f32(&self, x: f32) -> bool {
        let ulp = f64::from(f32::EPSILON);
        [1.0, 1.0 - ulp, 1.0 + ulp].iter().any(|factor| (self.allow)(f64::from(x) * factor))
    }
}

/// Two directions with a smaller sine between them count as parallel: far below any intended angle, far above the
/// rounding errors of double precision components.
const MIN_SINE: f64 = 1e-9;
/// A triangle counts as a line if its height is below this fraction of its longest edge.
const MIN_HEIGHT: f64 = 1e-12;

/// Checks the number of samples: `grid` and `stratified` divide the pixel into n × n cells, so that it must be a
/// square; blocks of `blue-noise` are powers of two.
pub fn check_spp(pattern: Pattern, spp: u32) -> Result<(), String> {
    if !(1..=MAX_SPP).contains(&spp) {
        return Err(format!("spp = {spp} is out of range; use 1 to {MAX_SPP} (2^24)"));
    }
    let root = spp.isqrt();
    match pattern {
        Pattern::Grid | Pattern::Stratified if root * root != spp => {
            let (below, above) = (root * root, (root + 1) * (root + 1));
            Err(format!("spp = {spp} is no square; use {below} or {above} with pattern \"{pattern}\""))
        }
        Pattern::BlueNoise if !spp.is_power_of_two() => {
            let above = spp.next_power_of_two();
            let below = above / 2;
            Err(format!("spp = {spp} is no power of two; use {below} or {above} with pattern \"{pattern}\""))
        }
        _ => Ok(()),
    }
}

pub(super) fn check_mag(mag: Filter) -> Result<(), String> {
    if mag.only_minifies() {
        return Err(format!(
            "filter \"{mag}\" averages over footprints wider than a texel and cannot magnify; \
             use it for min, and {} for mag",
            Filter::names_with(|t| !t.only_minifies, "or")
        ));
    }
    Ok(())
}

/// Checks the features that texture units do not have.
pub(super) fn check_method(spec: &SamplerSpec) -> Result<(), String> {
    match [spec.mag, spec.min].iter().find(|f| !f.traits().in_hardware) {
        Some(filter) if spec.method == Method::Hardware => Err(format!(
            "no device's own sampler has filter \"{filter}\"; use method \"shader\", or filter {}",
            Filter::names_with(|t| t.in_hardware, "or")
        )),
        _ => Ok(()),
    }
}

/// Checks the look-ups of each texture, also after the command line's overrides.
pub fn check_filters(scene: &Scene) -> Result<()> {
    let materials =
        scene.materials.iter().flat_map(|m| m.textures()).map(|used| (used.texture, used.sampler));
    let environment = scene.background.environment.iter().map(|e| (e.texture, e.sampler));
    for (texture, sampler) in materials.chain(environment) {
        let (Some(source), Some(spec)) = (scene.textures.get(texture), scene.samplers.get(sampler)) else {
            continue;
        };
        if source.content.procedural().is_some() {
            continue;
        }
        check_method(spec).map_err(|what| scene_error(format!("texture \"{}\": {what}", source.name)))?;
        let flat = matches!(source.dimension, Dimension::One | Dimension::Two);
        if let Some(filter) = [spec.mag, spec.min].iter().find(|f| !flat && f.traits().needs_flat) {
            return Err(Error::with_help(
                format!(
                    "texture \"{}\" is {}: filter \"{filter}\" reads 2d textures only",
                    source.name, source.dimension
                ),
                format!("give it a sampler with filter {}", Filter::names_with(|t| !t.needs_flat, "or")),
            )
            .of_kind(ErrorKind::Scene));
        }
    }
    Ok(())
}

fn scene_error(message: String) -> Error {
    Error::new(message).of_kind(ErrorKind::Scene)
}

/// Only patterns whose displacements differ between pixels can share them.
pub fn check_shared(pattern: Pattern, shared: bool) -> Result<(), String> {
    if !shared || pattern.can_be_shared() {
        return Ok(());
    }
    if pattern == Pattern::BlueNoise {
        return Err(format!(
            "shared = true gives all pixels one set of samples, but \"{pattern}\" lives by how the sets of \
             neighbouring pixels differ; use pattern \"sobol-owen\" with shared = true"
        ));
    }
    let able: Vec<&str> = Pattern::ALL.iter().filter(|p| p.can_be_shared()).map(|p| p.name()).collect();
    Err(format!(
        "shared = true needs a pattern whose displacements it can share: {}; the pattern is \"{pattern}\"",
        able.join(", ")
    ))
}

/// |a × b| = |a| |b| sin of the angle between them.
pub(super) fn parallel(a: DVec3, b: DVec3) -> bool {
    a.cross(b).length() <= MIN_SINE * a.length() * b.length()
}

/// Twice the area is |e₁ × e₂|: longest edge times height. Vertices far from the origin are accurate to a few ulp only,
/// which is added to the height that counts as zero.
pub(super) fn collinear(vertices: [DVec3; 3]) -> bool {
    let [a, b, c] = vertices;
    let longest = (b - a).length().max((c - a).length()).max((c - b).length());
    let largest = vertices.iter().map(|v| v.abs().max_element()).fold(0.0, f64::max);
    let height = MIN_HEIGHT * longest + 4.0 * f64::EPSILON * largest;
    (b - a).cross(c - a).length() <= longest * height
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn needles_are_triangles_but_rounded_lines_are_not() {
        let line = [0.1, 0.2, 0.3].map(|x| DVec3::new(x, 3.0 * x, 7.0 * x));
        assert!(collinear(line));
        assert!(collinear(line.map(|v| v + 1e6)));
        assert!(!collinear([DVec3::ZERO, DVec3::X, DVec3::new(0.5, 1e-6, 0.0)]));
        assert!(!collinear([DVec3::ZERO, DVec3::X * 1e-30, DVec3::Y * 1e-30]));
        assert!(!collinear([DVec3::ZERO, DVec3::X * 1e30, DVec3::Y * 1e30]));
    }

    #[test]
    fn parallel_looks_at_the_angle_alone() {
        assert!(parallel(DVec3::X * 1e30, DVec3::X * -1e-30));
        assert!(!parallel(DVec3::X * 1e30, DVec3::Y * 1e-30));
        assert!(!parallel(DVec3::X, DVec3::new(1.0, 1e-6, 0.0)));
    }
}
