//! What the builder checks of each item. In: an item and its key. Out: the first thing that is wrong with it.

mod shape;
mod surface;
mod texture;
mod view;

pub(super) use shape::{light, plane, sphere, triangle};
pub(super) use surface::{background, bounds, material, sampler};
pub(super) use texture::texture;
pub(super) use view::{camera, image, sampling};
