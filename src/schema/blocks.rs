//! Push constants, and the entries of lists of batches.

blocks! {
    /// The part of the film that one submission renders (`slice.glsl`).
    Slice {
        /// Tiles across the picture.
        tiles_x,
        /// Tiles in this band, or entries of the list of batches.
        tiles,
        /// Stride of the tile order, coprime to `tiles`.
        tile_stride,
        first_tile,
        /// First row of the band.
        band_y,
        band_height,
        first_sample,
        sample_count,
        /// A `Schedule`.
        schedule,
        /// 1: `tiles` entries of the list; 0: the same samples of all pixels.
        listed,
    }

    /// Cells that one submission of `tile_culling_main.glsl` processes: `first` .. `end`.
    CellRange {
        first,
        end,
        /// 1: quarters of divided cells, four of each.
        quarters,
    }

    /// A batch: samples `first` .. `first + count` of one half of a pixel.
    PixelBatch {
        /// Column in the low half, row in the high half; rows count from the first row of the band.
        place,
        /// The half (0 or 1), `BATCH_BARE`, `BATCH_APART`, and the stream of samples.
        part,
        first,
        count,
    }

    /// One level of a mip chain from the previous level (`mip_chain.glsl`).
    Halving {
        /// 1: the previous level is level 0, words of codes; 0: values.
        from_codes,
        /// First word or value of the previous level.
        above,
        /// Offset of the new level in words, and in values.
        word,
        number,
        /// Dimensions of the new level.
        texels,
        columns_log2,
        rows_log2,
        /// One bit per axis: the length is half of the previous one.
        halved,
    }

    /// The number of results of a probe.
    QueryRange {
        count,
    }

    /// Sample positions that `strata.glsl` lists: of `samples` samples per pixel from `first_sample` on.
    PositionRange {
        count,
        samples,
        /// Width of the picture in pixels.
        width,
        /// Index of the pair of dimensions.
        pair,
        first_sample,
    }
}
