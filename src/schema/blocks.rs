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

    /// One step of a pass of sampling to a goal (`glsl/goal`); reals are given by their bits.
    GoalStep {
        /// Of the picture, in pixels.
        width,
        height,
        /// Parts of the picture with partial sums.
        parts,
        /// The number of passes so far.
        pass,
        /// 1: something small and bright is known to be in the scene.
        bright,
        /// 1: beams have resolved some pixels.
        resolves,
        /// Entries of a list, columns of reals, or samples.
        count,
        exponent,
        /// What is wanted: the sum of the pixels' variances, or samples.
        aim,
        /// 1: `aim` is that of the variances.
        aims_at_error,
        /// 1: counts are chosen; 0: they are there.
        chooses,
        growth,
        most,
        /// The rates of an audit's draws, and the first draw.
        even,
        of_variance,
        start,
        /// The samples of an audit, and the `part` of its first means' batches.
        budget,
        batch_part,
        /// Most samples of a part, and which samples of each long batch are taken: from one on, before another.
        part_samples,
        from,
        until,
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
