//! Queries and answers of the probes in the memory layout of the shaders.

use bytemuck::{Pod, Zeroable};

/// One texture lookup through the material `slot`. `dx` and `dy` are the differentials of the
/// coordinate over the footprint, used in scenes whose footprint is not `none`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct LookupQuery {
    pub texture: u32,
    pub sampler: u32,
    pub slot: u32,
    /// The seed of the stochastic filter.
    pub seed: u32,
    /// u, v, w, or a direction.
    pub uv: [f32; 4],
    pub dx: [f32; 4],
    pub dy: [f32; 4],
}

/// One ray, relative to the eye; `direction[3]` is the largest distance of the occlusion query.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct RayQuery {
    pub origin: [f32; 4],
    pub direction: [f32; 4],
}

/// The hit of a ray.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct RayAnswer {
    pub point: [f32; 3],
    pub t: f32,
    /// The unit normal, facing the ray.
    pub normal: [f32; 4],
    pub uv: [f32; 4],
    /// The shape's index, or `NO_SHAPE` on a miss.
    pub shape: u32,
    pub occluded: u32,
    pub padding: [u32; 2],
}

/// One ray in f64.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct DoubleRay {
    pub origin: [f64; 4],
    pub direction: [f64; 4],
}

/// The hit of a ray in f64.
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

/// One lookup of a procedural texture, averaged over the footprint that `dx` and `dy` span.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct ProceduralQuery {
    /// The index into `PackedScene::procedurals`.
    pub procedural: u32,
    pub padding: [u32; 3],
    pub at: [f32; 4],
    pub dx: [f32; 4],
    pub dy: [f32; 4],
}

/// A point of the unit square with the height of the cap to which it is mapped and alpha of the
/// microfacet distribution from which it samples a normal; the incident ray and the surface normal,
/// both of unit length.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct WarpQuery {
    pub square: [f32; 2],
    pub height: f32,
    pub alpha: f32,
    pub direction: [f32; 4],
    /// The normal; its last component is the height of a point above a rectangle's plane.
    pub normal: [f32; 4],
    /// Centre and half sides of that rectangle relative to the point.
    pub rectangle: [f32; 4],
}

/// The mapped point; the microfacet normal and its reflectance; the position on the rectangle and
/// its solid angle.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct WarpAnswer {
    pub disc: [f32; 4],
    pub cap: [f32; 4],
    pub facet: [f32; 4],
    pub rectangle: [f32; 4],
}

/// A ray that meets an interface of two refractive indices, given as the ratio of incident to
/// transmitted. The normal has unit length and opposes the ray.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct GlassQuery {
    pub direction: [f32; 3],
    pub ratio: f32,
    pub normal: [f32; 4],
}
