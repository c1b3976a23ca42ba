//! Push constants, and the entries of lists of jobs.

blocks! {
    /// Which part of the film one submission renders (`slice.glsl`).
    Slice {
        /// Tiles across the picture.
        tiles_x,
        /// Tiles in this band, or entries of the list of jobs.
        tiles,
        /// Coprime to `tiles`: the order in which they are visited.
        tile_stride,
        first_tile,
        /// First row of the band.
        band_y,
        band_height,
        first_sample,
        sample_count,
        /// A `Schedule`.
        schedule,
    }

    /// Cells that one submission of `tile_culling_main.glsl` works off: `first` .. `end`.
    CellRange {
        first,
        end,
    }

    /// Samples `first` .. `first + count` of a pixel's half.
    Job {
        /// Column in the low half, row in the high one; rows count from the band's first.
        place,
        /// The half (0 or 1), `JOB_BARE`, `JOB_APART`, and the stream of samples.
        part,
        first,
        count,
    }

    /// One level of a mip chain from the one above (`mip_chain.glsl`).
    Halving {
        /// 1: the level above is level 0, words of codes; 0: numbers.
        from_codes,
        /// First word or number of the level above.
        above,
        /// Where the new level begins as words, and as numbers.
        word,
        number,
        /// Of the new level.
        texels,
        columns_log2,
        rows_log2,
        /// One bit an axis: the length above is twice as long.
        halved,
    }

    /// Answers that a probe gives.
    QueryRange {
        count,
    }

    /// Sample positions that `strata.glsl` lists: of `samples` samples a pixel from `first_sample` on.
    PositionRange {
        count,
        samples,
        /// Width of the picture in pixels.
        width,
        /// Which pair of dimensions.
        pair,
        first_sample,
    }
}
