//! The picture during and after rendering: one linear RGB mean per pixel in f32, the top row first, and the
//! number of samples in each mean.

/// A finished picture, or one that was read from a file.
#[derive(Clone, Debug, PartialEq)]
pub struct Film {
    /// Pixels in a row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// `width · height` pixels, linear RGB, means over `samples`.
    pub pixels: Vec<[f32; 3]>,
    /// Samples per pixel in every mean; 0 if unknown.
    pub samples: u32,
}

impl Film {
    /// Returns a black film of this size.
    pub fn new(width: u32, height: u32, samples: u32) -> Film {
        Film { width, height, pixels: vec![[0.0; 3]; width as usize * height as usize], samples }
    }
}

/// The position of a film in a larger picture, in pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Placement {
    /// Position of the film's first pixel.
    pub corner: [u32; 2],
    /// Width and height of the picture.
    pub full: [u32; 2],
}

impl Placement {
    /// A picture that is not a part of another.
    pub const fn whole(width: u32, height: u32) -> Placement {
        Placement { corner: [0; 2], full: [width, height] }
    }
}
