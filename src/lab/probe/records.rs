//! What probes are asked and what they answer, as the shaders lay it out in memory.

use bytemuck::{Pod, Zeroable};

/// One texture look-up; `slot` is a material's. `dx` and `dy` are the change of the coordinate over the
/// footprint, which counts in scenes whose footprint is not `none`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct LookUp {
    pub texture: u32,
    pub sampler: u32,
    pub slot: u32,
    /// Of the stochastic filter.
    pub seed: u32,
    /// u, v, w, or a direction.
    pub uv: [f32; 4],
    pub dx: [f32; 4],
    pub dy: [f32; 4],
}

/// One ray, relative to the eye; `direction[3]` bounds the question whether anything lies between.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct RayQuery {
    pub origin: [f32; 4],
    pub direction: [f32; 4],
}

/// What a ray hit.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct RayAnswer {
    pub point: [f32; 3],
    pub t: f32,
    /// Unit, turned towards the ray.
    pub normal: [f32; 4],
    pub uv: [f32; 4],
    /// `NO_SHAPE` on a miss.
    pub shape: u32,
    pub occluded: u32,
    pub padding: [u32; 2],
}

/// The same in f64.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct DoubleRay {
    pub origin: [f64; 4],
    pub direction: [f64; 4],
}

/// What a ray in f64 hit.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct DoubleAnswer {
    pub point: [f64; 3],
    pub t: f64,
    pub normal: [f64; 4],
    pub uv: [f64; 4],
    pub shape: u32,
    pub occluded: u32,
    pub padding: [u32; 2],
}

/// One look-up of a procedural texture, averaged over the footprint that `dx` and `dy` span.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct ProceduralQuery {
    /// Index into `PackedScene::procedurals`.
    pub procedural: u32,
    pub padding: [u32; 3],
    pub at: [f32; 4],
    pub dx: [f32; 4],
    pub dy: [f32; 4],
}

/// A point of the unit square; the height of the cap that it goes to, and alpha of the facets of which it
/// chooses one; the ray that meets it, and the surface's normal, both of unit length.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct WarpQuery {
    pub square: [f32; 2],
    pub height: f32,
    pub alpha: f32,
    pub direction: [f32; 4],
    /// Last, the height of a point over a rectangle's plane.
    pub normal: [f32; 4],
    /// Middle and half sides of that rectangle, as seen from the point.
    pub rectangle: [f32; 4],
}

/// Where that point lies; the facet's normal, and the share of what it mirrors; the place on the rectangle and its
/// solid angle.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct WarpAnswer {
    pub disc: [f32; 4],
    pub cap: [f32; 4],
    pub facet: [f32; 4],
    pub rectangle: [f32; 4],
}

/// A ray that meets a surface between two refractive indices: in front over behind. The normal is of unit
/// length, against the ray.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct GlassQuery {
    pub direction: [f32; 3],
    pub ratio: f32,
    pub normal: [f32; 4],
}
