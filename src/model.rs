//! The parts of a scene that a [`SceneBuilder`](crate::SceneBuilder) takes, in scene units, degrees and linear RGB. An
//! index in a part is one that the builder returned; [`DEFAULT`] is the default material and the default sampler.

pub use crate::scene::geometry::kinds::*;
pub use crate::scene::geometry::{Kind, Shape};
pub use crate::scene::model::DEFAULT;
pub use crate::scene::model::{
    Algorithm, Background, Bounds, BumpKind, BumpMap, Camera, Entity, Environment, EnvironmentLayout,
    Footprint, Lens, Light, Mapping, MappingKind, Material, Model, Pattern, PixelFilter, PixelFilterKind,
    Precision, Projection, Quantity, Sampling, Space,
};
pub use crate::texture::data::{ColorSpace, Dimension, MipKernel, TexelFormat};
pub use crate::texture::procedural::{Procedural, ProceduralKind};
pub use crate::texture::sampler_spec::{Address, Filter, Method, MipMode, SamplerSpec, TexelCenter};
pub use crate::texture::source::{
    CubeLayout, Endian, OrientationUse, PlainTexels, ProfileUse, ReadOptions, TextureContent, TextureSource,
    VolumeSource,
};
