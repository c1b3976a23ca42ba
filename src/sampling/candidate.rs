//! Ways to make a whole picture at once, of which a backend may have some. Input: none. Output: their names, and what a
//! picture by one of them has taken.

/// A way to make a whole picture without counts that differ from pixel to pixel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Candidate {
    /// The same number of samples in each pixel, without a footprint.
    Samples,
    /// One sample in the centre of each pixel, whose look-ups are averages over the pixel's footprint.
    Prefiltered,
    /// One cone a pixel.
    Cone,
}

/// A picture by a candidate.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Made {
    /// Samples a pixel.
    pub samples: u32,
    /// The weight that cones dropped, summed over all pixels.
    pub dropped: f64,
}
