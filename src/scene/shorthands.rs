//! Shorthands for the parts of a scene in code. Input: the essential values. Output: the part, with the defaults of a
//! scene file for everything else.

use std::path::PathBuf;
use std::sync::Arc;

use glam::DVec3;

use super::model::{Camera, Projection, TextureContent, TextureSource};
use crate::texture::data::{ColorSpace, Component, Dimension, MipKernel, TexelFormat};
use crate::texture::source::{PlainTexels, ReadOptions};

impl Camera {
    /// Returns a pinhole camera at `eye` with `look_at` at the centre of the picture, a vertical field of view in
    /// degrees, and +y upwards.
    pub fn looking(eye: impl Into<DVec3>, look_at: impl Into<DVec3>, vertical_fov: f64) -> Camera {
        Camera {
            eye: eye.into(),
            look_at: look_at.into(),
            up: DVec3::Y,
            projection: Projection::VerticalFov(vertical_fov),
            lens: None,
            shutter: [0.0, 1.0],
            motion: [DVec3::ZERO; 2],
        }
    }
}

impl TextureSource {
    fn of_content(
        name: impl Into<String>,
        content: TextureContent,
        color_space: ColorSpace,
    ) -> TextureSource {
        TextureSource {
            name: name.into(),
            content,
            dimension: Dimension::Two,
            color_space,
            color_space_stated: true,
            reading: ReadOptions::default(),
            flip_v: false,
            mip_kernel: MipKernel::Box,
        }
    }

    /// Returns the texture of a picture file. The name is used in messages.
    pub fn file(name: impl Into<String>, path: impl Into<PathBuf>, color_space: ColorSpace) -> TextureSource {
        TextureSource::of_content(name, TextureContent::File(path.into()), color_space)
    }

    /// Returns a texture of `width · height` texels of 8 bits, red, green, blue and alpha, the top row first.
    pub fn rgba8(
        name: impl Into<String>,
        [width, height]: [u32; 2],
        bytes: Vec<u8>,
        color_space: ColorSpace,
    ) -> TextureSource {
        let texels = PlainTexels { width, height, format: TexelFormat::Rgba8, bytes };
        TextureSource::of_content(name, TextureContent::Texels(Arc::new(texels)), color_space)
    }

    /// Returns a texture of `width · height` linear texels, red, green, blue and alpha, the top row first.
    pub fn rgba_float(
        name: impl Into<String>,
        [width, height]: [u32; 2],
        texels: &[[f32; 4]],
    ) -> TextureSource {
        let (format, bytes) =
            (TexelFormat::new(4, Component::Float32), bytemuck::cast_slice(texels).to_vec());
        let texels = PlainTexels { width, height, format, bytes };
        TextureSource::of_content(name, TextureContent::Texels(Arc::new(texels)), ColorSpace::Linear)
    }
}
