//! Numbers that host and device share.

constants! {
    /// In place of an index: the material has no texture.
    NO_TEXTURE: u32 = u32::MAX;
    /// In place of an index: no shape is hit, or none is left out.
    NO_SHAPE: u32 = u32::MAX;
    /// In place of an index: there is no environment.
    NO_MATERIAL: u32 = u32::MAX;
    /// In place of where a cell begins: all triangles are tested.
    NO_LIST: u32 = u32::MAX;
    /// Value of a specialization constant: "read the number from the scene".
    DYNAMIC: u32 = u32::MAX;
    /// Farther than any hit that counts.
    FAR: f64 = 1e30;

    /// Units of 16 bytes at the front of the scene buffer that are also bound as uniforms: `maxUniformBufferRange`
    /// is at least 16 KiB on every device.
    HEAD_UNITS: u32 = 1024;
    /// Pixels along the side of the square tiles in which work is handed out.
    TILE: u32 = 64;
    /// Samples of a pixel that are summed in f32 as they are; n equal terms are off by 1.5e-8 n at worst.
    MAX_PLAIN: u32 = 64;
    /// Samples of each block into which more samples than that are divided.
    BLOCK: u32 = 32;
    /// Cells of the table by which samples are placed about a pixel.
    PIXEL_FILTER_CELLS: u32 = 512;

    /// In a job's part: without a footprint.
    JOB_BARE: u32 = 2;
    /// In a job's part: its sums go to its own place in the list, not to the pixel's half.
    JOB_APART: u32 = 4;
    /// Above it in a job's part: the stream of samples, each as good as another seed.
    JOB_STREAM_SHIFT: u32 = 8;

    /// Words of a cell of the picture: number of triangles, what it shows, up to `MAX_LISTED` triangles.
    CELL_WORDS: u32 = 64;
    MAX_LISTED: u32 = 62;
    /// What a cell shows: the background alone; one shape whose colour changes little; all else.
    CELL_EMPTY: u32 = 0;
    CELL_UNIFORM: u32 = 1;
    CELL_BUSY: u32 = 2;

    /// Turns of the loop over an ellipse's texels.
    MAX_ELLIPSE_STEPS: u32 = 8192;
    /// Boxes along a footprint by which a procedural texture is averaged.
    MAX_BOXES: u32 = 16;
    /// Cones that one pixel follows.
    MAX_CONES: u32 = 64;
    /// Fragments that one cone keeps.
    MAX_CONE_FRAGMENTS: u32 = 8;
}
