//! The picture while and after it is made: one linear RGB mean per pixel in f32, row 0 on top,
//! and how many samples stand behind each.

/// A finished picture, also one that was read from a file.
#[derive(Clone, Debug, PartialEq)]
pub struct Film {
    /// Pixels in a row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// `width · height` pixels, linear RGB, means over `samples`.
    pub pixels: Vec<[f32; 3]>,
    /// Samples per pixel behind every mean; 0 where that is not known.
    pub samples: u32,
}

impl Film {
    /// Returns a black film of this size.
    pub fn new(width: u32, height: u32, samples: u32) -> Film {
        Film { width, height, pixels: vec![[0.0; 3]; width as usize * height as usize], samples }
    }
}

/// Where a film lies in a larger picture, in its pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Placement {
    /// Of the film's first pixel.
    pub corner: [u32; 2],
    /// Width and height of the picture.
    pub full: [u32; 2],
}

impl Placement {
    /// A picture of its own.
    pub const fn whole(width: u32, height: u32) -> Placement {
        Placement { corner: [0; 2], full: [width, height] }
    }
}
