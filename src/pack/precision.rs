//! Decides whether geometry in f32 is accurate enough for a scene and the sizes of its textures, by
//! first-order analysis of rounding errors (Higham 2002, chapter 3) at rays all over the picture. Two errors
//! count: of rays and outlines, in pixels; and of texture coordinates, in texels. Also rounds scenes that do
//! not need f64.

use glam::DVec3;

use super::PackedScene;
use super::geometry::rounded_shapes;
use super::header::{camera_basis, half_height};
use crate::scene::model::{Entity, Mapping, MappingKind, Material, Scene};
use crate::schema::layout::Record;

/// Unit roundoff of f32.
pub(super) const U: f64 = 1.0 / 16_777_216.0;
/// Rounding errors of a ray's direction, a dot product with it and a product by t, in U, as they add up with
/// random signs.
pub(super) const RAY: f64 = 2.0;
/// Tolerance of a ray or an outline of a sphere, as a fraction of a pixel.
pub(super) const PART_OF_PIXEL: f64 = 1.0 / 32.0;
/// Tolerance of a look-up, as a fraction of a texel ...
const PART_OF_TEXEL: f64 = 1.0 / 256.0;
/// ... except in this fraction of the picture: towards a horizon texels are far smaller than pixels.
const PART_OF_PICTURE: f64 = 1.0 / 3.0;
/// Assumed texels per unit of a procedural texture.
const PROCEDURAL_TEXELS: f64 = 16.0;
/// Outside of these bounds squares and cubes leave the range of f32.
pub(super) const RANGE: [f64; 2] = [1e-12, 1e12];
/// Rays along each side of the picture.
const RAYS: u32 = 16;

/// The errors of f32 that exceed the tolerances.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Need {
    /// Rays and outlines would be visibly displaced.
    pub outlines: bool,
    /// Look-ups would be displaced by texels.
    pub texels: bool,
}

pub(super) struct Camera {
    pub eye: DVec3,
    pub forward: DVec3,
    /// A pixel's side at distance 1, or of parallel rays.
    pub pixel: f64,
    pub parallel: bool,
    pub rays: Vec<[DVec3; 2]>,
}

impl Camera {
    fn new(scene: &Scene) -> Camera {
        let [right, up, forward] = camera_basis(scene);
        let (half, parallel) = half_height(scene);
        let pixel = 2.0 * half / f64::from(scene.height);
        let rays = (0..RAYS * RAYS).map(|i| {
            let part =
                |k: u32, pixels: u32| ((f64::from(k) + 0.5) / f64::from(RAYS) - 0.5) * f64::from(pixels);
            let (x, y) = (part(i % RAYS, scene.width), part(i / RAYS, scene.height));
            let aside = pixel * (x * right - y * up);
            if parallel { [aside, forward] } else { [DVec3::ZERO, forward + aside] }
        });
        Camera { eye: scene.camera.eye, forward, pixel, parallel, rays: rays.collect() }
    }

    /// Returns a pixel's side at that distance.
    pub fn pixel_at(&self, distance: f64) -> f64 {
        if self.parallel { self.pixel } else { self.pixel * distance }
    }
}

/// The number of look-ups that were tested, and of those that f32 displaces.
#[derive(Default)]
struct Count {
    all: u32,
    wrong: u32,
}

impl Count {
    fn add(&mut self, texels: f64) {
        self.all += 1;
        self.wrong += u32::from(texels > PART_OF_TEXEL || texels.is_nan());
    }

    fn too_many(&self) -> bool {
        f64::from(self.wrong) > PART_OF_PICTURE * f64::from(self.all)
    }
}

/// Returns the needs of a scene whose textures have these `sizes` in texels.
pub fn need(scene: &Scene, sizes: &[[u32; 3]]) -> Need {
    let camera = Camera::new(scene);
    let rays_merge = !camera.parallel && RAY * U > camera.pixel * PART_OF_PIXEL;
    let outlines = rays_merge
        || rounded_shapes(scene).any(|shape| shape.misses_outline(&camera))
        || rounded_shapes(scene).any(|shape| !(RANGE[0]..=RANGE[1]).contains(&shape.extent(camera.eye)));
    let texels = |material: usize| {
        let material = &scene.materials[material];
        texels_per_tile(scene, sizes, material).map(|texels| (material, texels))
    };
    // By rays of the picture, and by shapes.
    let mut counts = [Count::default(), Count::default()];
    for shape in rounded_shapes(scene) {
        let Some((material, texels)) = texels(shape.material()) else { continue };
        let count = &mut counts[usize::from(shape.is_small())];
        shape.errors(&camera, &material.mapping, &mut |tiles| count.add(tiles * texels));
    }
    Need { outlines, texels: counts.iter().any(Count::too_many) }
}

/// Returns the texels per tile of the finest texture that the material reads.
fn texels_per_tile(scene: &Scene, sizes: &[[u32; 3]], material: &Material) -> Option<f64> {
    let texels = |texture: usize| {
        let procedural = scene.textures[texture].content.procedural().is_some();
        if procedural { PROCEDURAL_TEXELS } else { f64::from(sizes[texture].into_iter().max().unwrap_or(1)) }
    };
    material.textures().map(|used| texels(used.texture)).reduce(f64::max)
}

/// Returns the largest rate of change of a projecting mapping's coordinate at a point with that normal.
pub(super) fn tiles_a_unit(mapping: &Mapping, place: DVec3, normal: DVec3) -> f64 {
    let scale = mapping.scale.abs().max_element().max(if mapping.kind == MappingKind::Solid {
        mapping.scale_w.abs()
    } else {
        0.0
    });
    let entity = match mapping.entity {
        Entity::Position => place - mapping.origin,
        Entity::Centroid => DVec3::ONE,
        Entity::Normal | Entity::Reflection => normal,
    };
    match mapping.kind {
        MappingKind::Planar | MappingKind::Solid => scale,
        _ => scale / entity.length().max(f64::MIN_POSITIVE),
    }
}

impl PackedScene {
    /// Rounds to f32 if the device has no f64, and returns a warning if that matters.
    pub fn adapt_to_device(&mut self, float64: bool) -> Option<String> {
        if !self.double || float64 {
            return None;
        }
        self.round_reals();
        Some(
            "the device has no f64 in shaders: geometry is of f32, which misplaces outlines or texels here; \
             --precision single says that this is meant"
                .into(),
        )
    }

    /// Rounds all numbers that a device reads as f32.
    pub fn round_reals(&mut self) {
        self.header = self.header.quantize_f32();
        self.records.quantize_f32();
        self.double = false;
    }
}
