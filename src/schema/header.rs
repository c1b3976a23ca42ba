//! The record at the front of the scene buffer, which has no list. As in `records.rs`, `f64` and vectors of it are reals,
//! and positions are relative to the eye.

header! {
    /// Camera, picture and sampling.
    Header {
        /// Unit view direction.
        forward: DVec3,
        /// One pixel to the right: added to the direction of perspective rays, to the origin of parallel ones.
        step_x: DVec3,
        /// Side of the part of a pixel that a sample represents; 0 without a footprint.
        sample_side: f64,
        /// One pixel down.
        step_y: DVec3,
        /// Side of a pixel.
        pixel_side: f64,
        /// From the eye to the point that it looks at.
        view: DVec3,
        up: DVec3,
        /// Displacement between the times 0 and 1.
        eye_motion: DVec3,
        view_motion: DVec3,
        background: Vec3,
        projection: ProjectionKind,
        image_size: UVec2,
        /// Column and row of the film's first pixel.
        crop: UVec2,
        film_size: UVec2,
        max_depth: u32,
        footprint: Footprint,
        pattern: Pattern,
        strata_side: u32,
        samples: u32,
        seed: u32,
        /// All pixels have the same sample positions.
        shares_pattern: bool,
        /// One bit for each `SampleDimension` in use.
        sample_dimensions: u32,
        camera_moves: bool,
        /// Side of a tile culling cell in pixels; 0 without tile culling.
        cell_side: u32,
        /// Material of the environment, or `NO_MATERIAL`.
        environment_material: u32,
        environment_projection: u32,
        /// Cells of the distribution of its light: of a row, and rows; 0 if it does not light surfaces.
        environment_columns: u32,
        environment_rows: u32,
        pixel_filter: PixelFilterKind,
        /// In sides of a pixel at distance 1; 0 without a lens.
        lens_radius: f32,
        inverse_focus_distance: f32,
        shutter_opens: f32,
        /// Duration for which the shutter is open.
        shutter_time: f32,
        /// In pixels, as is the width.
        filter_radius: f32,
        /// Width of the box that has the filter's variance.
        filter_width: f32,
        /// First step from the centre, of 2^24, at which the filter is negative.
        first_negative_step: u32,
        quantity: Quantity,
    }
}
