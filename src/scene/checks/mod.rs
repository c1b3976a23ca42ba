//! What the builder checks of each item. In: an item and its key. Out: the first thing that is wrong with it.

mod light;
mod surface;
mod texture;
mod view;

pub(super) use light::light;
pub(super) use surface::{background, material, sampler};
pub(super) use texture::texture;
pub(super) use view::{camera, image, sampling};
