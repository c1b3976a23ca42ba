//! The builder's checks of each item. Input: an item and its key. Output: the first rule that it breaks.

mod light;
mod surface;
mod texture;
mod view;

pub(super) use light::light;
pub(super) use surface::{background, material, sampler};
pub(super) use texture::texture;
pub(super) use view::{camera, image, sampling};
