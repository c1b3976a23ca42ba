//! Constants that host and device share.

constants! {
    /// Replaces an index: the material has no texture.
    NO_TEXTURE: u32 = u32::MAX;
    /// Replaces an index: no shape is hit, or none is excluded.
    NO_SHAPE: u32 = u32::MAX;
    /// Replaces an index: there is no environment.
    NO_MATERIAL: u32 = u32::MAX;
    /// Replaces the offset of a cell: all triangles are tested.
    NO_LIST: u32 = u32::MAX;
    /// Value of a specialization constant: the count is read from the scene.
    DYNAMIC: u32 = u32::MAX;
    /// Distance beyond which no hit counts.
    FAR: f64 = 1e30;

    /// Units of 16 bytes at the front of the scene buffer that are also bound as uniforms: `maxUniformBufferRange` is
    /// at least 16 KiB on every device.
    HEAD_UNITS: u32 = 1024;
    /// Side, in pixels, of the square tiles into which a picture is divided for rendering.
    TILE: u32 = 64;
    /// Number of samples of a pixel that are summed in f32 directly; the error for n equal terms is at most 1.5e-8 n.
    MAX_PLAIN: u32 = 64;
    /// Samples in each block into which larger numbers are divided.
    SAMPLES_PER_BLOCK: u32 = 32;
    /// Cells of the table that places samples around a pixel by its filter.
    PIXEL_FILTER_CELLS: u32 = 512;

    /// In a batch's part: without a footprint.
    BATCH_BARE: u32 = 2;
    /// In a batch's part: its sums go to its own entry in the list, not to the pixel's half.
    BATCH_APART: u32 = 4;
    /// Most samples of a half of a pixel that is sampled to a goal: f32 sums of this many are still accurate enough; and the
    /// octaves of their numbers.
    MAX_HALF_SAMPLES: u32 = 65536;
    COUNT_OCTAVES: u32 = 18;
    /// Cells along each side of the picture from which the pixels of an audit are drawn, parts of an expected draw, and the
    /// least number of samples of each of its two means.
    DRAW_CELLS: u32 = 32;
    DRAW_UNIT: u32 = 524288;
    DRAW_MIN_SAMPLES: u32 = 64;
    /// Threads of a workgroup of `glsl/goal`.
    GOAL_THREADS: u32 = 256;
    /// Pixels on each side of the centre of a window whose variances are pooled, and of the neighbourhood of a discovery and
    /// of an audited pixel.
    GOAL_RADIUS: u32 = 3;
    GOAL_AUDIT_RADIUS: u32 = 4;
    /// Side of the parts of a picture in which pixels of similar counts are pooled, and the number from which on samples count
    /// as many there.
    GOAL_PART_SIDE: u32 = 32;
    GOAL_MANY_SAMPLES: u32 = 64;
    /// Length of a run of pixels of which one is visited.
    GOAL_RUN: u32 = 128;
    /// A half of a pixel has seen nothing if its variance is this many times less than that of the mean half. Least number of halves
    /// that contradict their partners, and least share of the variance that these account for; largest correlation of the halves,
    /// and that of pixels with many samples or in scenes known to contain something small and bright.
    GOAL_NOTHING_RATIO: f64 = 16.0;
    GOAL_MIN_CONTRADICTIONS: u32 = 8;
    GOAL_MIN_UNSEEN_SHARE: f64 = 0.1;
    GOAL_MAX_CORRELATION: f64 = 0.25;
    GOAL_MAX_SURE_CORRELATION: f64 = 0.5;
    /// Least factors by which a count of one, and larger ones, grow.
    GOAL_MIN_GROWTH_OF_ONE: f64 = 1.5;
    GOAL_MIN_GROWTH: f64 = 1.25;
    /// Factor by which the count of a visited pixel grows if it has fewer than `GOAL_FEW_SAMPLES` in each half.
    GOAL_VISIT_GROWTH: u32 = 4;
    GOAL_FEW_SAMPLES: u32 = 64;
    /// A visited pixel has made a discovery if its samples vary this many times more than before; the share of that by which those
    /// around it are assumed to vary.
    GOAL_DISCOVERY: f64 = 4.0;
    GOAL_SHARE_AROUND: f64 = 0.25;
    /// Bins of multipliers, in eighths of an octave, and the one that begins at 1.
    GOAL_BINS: u32 = 512;
    GOAL_MIDDLE_BIN: u32 = 128;
    /// Classes of batches by their length, two in each octave; from which one on they are taken in parts, by several threads
    /// at once, and most samples of a part.
    GOAL_CLASSES: u32 = 36;
    GOAL_LONG_CLASS: u32 = 13;
    GOAL_PART_SAMPLES: u32 = 64;
    /// Arrays of words that a device keeps of each pixel: samples of a half, now and after the pass; the bits of the variances of
    /// its mean and of a sample; that of a visited pixel's sample before, in two arrays by turns; the mean's variances by the halves
    /// and by the samples, and both summed over rows of windows.
    GOAL_COUNTS: u32 = 0;
    GOAL_NEXT: u32 = 1;
    GOAL_VARIANCES: u32 = 2;
    GOAL_SPREADS: u32 = 3;
    GOAL_VISITED: u32 = 4;
    GOAL_PAIRS: u32 = 6;
    GOAL_ROWS: u32 = 8;
    GOAL_ARRAYS: u32 = 10;
    /// Words about the whole picture. Sums over all pixels: of the squared differences of the halves and their squares, of
    /// variances, of resolved pixels, of 1 / cost and of cost times variance, where the cost is that of an audit's draw; then the
    /// largest count and that of all bits inverted, and sums of the lower and the upper half of the counts' bits.
    GOAL_DIFFERENCE: u32 = 0;
    GOAL_SQUARES: u32 = 1;
    GOAL_VARIANCE: u32 = 2;
    GOAL_RESOLVED_PIXELS: u32 = 3;
    GOAL_INVERSE_COST: u32 = 4;
    GOAL_COST_VARIANCE: u32 = 5;
    GOAL_MOST: u32 = 6;
    GOAL_LEAST: u32 = 7;
    GOAL_LOWER: u32 = 8;
    GOAL_UPPER: u32 = 9;
    GOAL_COLUMNS: u32 = 10;
    /// Of a plan: its multiplier, samples in all, and the pixels that gain some; parts of batches; samples of an audit's draws;
    /// the pixels of each class, and how many of them are listed; the bins.
    GOAL_MULTIPLIER: u32 = 16;
    GOAL_PLANNED_SAMPLES: u32 = 17;
    GOAL_GAINING: u32 = 18;
    GOAL_PART_COUNT: u32 = 19;
    GOAL_DRAW_COST: u32 = 20;
    GOAL_CLASSES_AT: u32 = 32;
    GOAL_BINS_AT: u32 = 128;
    /// Of an audit: the least variances of a sample by the octaves of counts, and pixels with the variance of a sample; sums of
    /// expected draws by octaves and cells; the number of draws, and `GOAL_DRAW_WORDS` words of each.
    GOAL_FLOORS: u32 = 1664;
    GOAL_RAISES: u32 = 1696;
    GOAL_MASSES: u32 = 14016;
    GOAL_DRAWN: u32 = 32448;
    GOAL_DRAWS: u32 = 32464;
    GOAL_DRAW_WORDS: u32 = 24;
    MAX_GOAL_DRAWS: u32 = 6144;
    /// Partial sums of all columns, one after the other.
    GOAL_PARTIALS: u32 = 179920;
    /// Position of the stream of samples in a batch's part; streams are as independent as different seeds.
    BATCH_STREAM_SHIFT: u32 = 8;

    /// Words of a cell of the picture: `CELL_HEAD`, then single shapes by their number, then triangles of meshes by the
    /// texel of their corners, `MAX_LISTED` in all. In a scene with meshes `MAX_LISTED_WITH_MESHES`; behind these the first
    /// word of the cell's room for more, or `NO_LIST`, that of its shades, and `CELL_MASK_WORDS` words of bits for each of `CELL_PARTS` ×
    /// `CELL_PARTS` parts of the cell: one for each triangle of a mesh in the list, set if rays of the part may meet it.
    CELL_WORDS: u32 = 128;
    /// Number of single shapes, content, number of triangles of meshes, and the depth up to which no other triangle
    /// of a mesh is met.
    CELL_HEAD: u32 = 4;
    MAX_LISTED: u32 = 124;
    MAX_LISTED_WITH_MESHES: u32 = 74;
    CELL_PARTS: u32 = 4;
    CELL_MASK_WORDS: u32 = 3;
    /// Room for more triangles of a cell with meshes: `MAX_MORE_LISTED` of them, then `MORE_MASK_WORDS` further words of bits
    /// for each part of the cell. Behind the cells stand `CELL_COUNTERS`: the numbers of rooms, of words of shades and of divided
    /// cells that are taken; then the divided cells and their quarters, one for `CELLS_A_DIVISION` cells; the rooms, one for
    /// `CELLS_A_ROOM` cells; and words of shades.
    CELL_COUNTERS: u32 = 3;
    CELL_COUNTER_ROOMS: u32 = 0;
    CELL_COUNTER_SHADES: u32 = 1;
    CELL_COUNTER_DIVISIONS: u32 = 2;
    CELLS_A_DIVISION: u32 = 32;
    MORE_WORDS: u32 = 261;
    CELLS_A_ROOM: u32 = 16;
    MAX_MORE_LISTED: u32 = 181;
    MORE_MASK_WORDS: u32 = 5;
    /// The shades of a cell, where a directional light shines: `SHADES_HEAD` words, which are the region that lit surfaces
    /// fill in the light's frame (least and greatest), the number of triangles above it, how many words of bits each of them
    /// has, and the largest coordinate of what is seen; then for each its texel and a bit for each triangle of the cell's
    /// list, set if it may shade that. There is room for `SHADE_WORDS` words on average. Where more than `MAX_SHADE_PAIRS` of
    /// two triangles would have to be tested, each may shade all.
    SHADES_LEAST: u32 = 0;
    SHADES_GREATEST: u32 = 3;
    SHADES_COUNT: u32 = 6;
    SHADES_BITS: u32 = 7;
    SHADES_REACH: u32 = 8;
    SHADES_HEAD: u32 = 9;
    SHADE_WORDS: u32 = 48;
    MAX_SHADE_PAIRS: u32 = 4096;
    /// Values of `MESH_SEARCH`: camera rays search by lists and trees; by lists alone, in pixels of few triangles, of more,
    /// and of many, each of which leaves pixels unfinished; and what is left then, by lists and trees. Where a branch that no
    /// thread takes costs as much as one that all take, passes are faster than one. The last two are passes of workgroups that
    /// sample their pixels together: by lists alone, and what is left then, by trees alone.
    SEARCH_ALL: u32 = 0;
    SEARCH_FEW: u32 = 1;
    SEARCH_MORE: u32 = 2;
    SEARCH_MANY: u32 = 3;
    SEARCH_REST: u32 = 4;
    SEARCH_TEAM: u32 = 5;
    SEARCH_TEAM_REST: u32 = 6;
    /// Pixels, and threads, of a workgroup that samples them together.
    TEAM_WIDTH: u32 = 8;
    TEAM_HEIGHT: u32 = 4;
    /// Squares of pixels into which they are divided, which are sampled one after the other.
    TEAM_SQUARES: u32 = 8;
    /// In the fourth component of a pixel's sum, which is zero without a pixel filter's negative lobes: its samples are left
    /// to a later pass.
    UNFINISHED: f64 = -1.0;
    /// Nodes of a mesh's tree that are opened for one cell: with what else a cell's thread repeats, fewer than Mesa's CPU driver
    /// lets all loops of an invocation turn (65 535). For the shades of the cell there are half as many.
    MAX_CELL_NODES: u32 = 2048;
    /// Cells of a block, which follow each other where subgroups are short.
    CELL_BLOCK_WIDTH: u32 = 4;
    CELL_BLOCK_HEIGHT: u32 = 2;
    /// Content of a cell: the background alone; one shape whose colour changes little; anything else; so much that each of its
    /// quarters has `CELL_WORDS` of its own, the first of which is in the place of the room for more.
    CELL_EMPTY: u32 = 0;
    CELL_UNIFORM: u32 = 1;
    CELL_BUSY: u32 = 2;
    CELL_DIVIDED: u32 = 3;

    /// Children of a node of the trees of meshes.
    TREE_WIDTH: u32 = 4;
    /// Children that may wait while a ray goes through a tree.
    TREE_STACK: u32 = 64;
    /// Position of the number of triangles in the word for a child that waits.
    TREE_COUNT_SHIFT: u32 = 28;
    /// In place of that number, of a child that is a mesh by its index, not triangles by the texel of the first one's corners
    /// or a node by the texel of its first child.
    TREE_MESH: u32 = 15;
    /// Index of the placement of a mesh whose triangles are those of the scene's space.
    NO_PLACEMENT: u32 = u32::MAX;

    /// Flags of a triangle of a mesh: it has shading normals; the bitangent of its texture coordinates is mirrored.
    MESH_SMOOTH: u32 = 1;
    MESH_MIRRORED_UV: u32 = 2;

    /// Entries along each side of the table of what facets reflect.
    FACET_TABLE_SIDE: u32 = 32;
    /// Bits of `second_uv_maps` above those of `MaterialMap`.
    SECOND_UV_COLOR: u32 = 256;
    SECOND_UV_BUMP: u32 = 512;

    /// Largest number of iterations over an ellipse's texels.
    MAX_ELLIPSE_STEPS: u32 = 8192;
    /// Boxes along a footprint over which a procedural texture is averaged.
    MAX_BOXES: u32 = 16;
    /// Surfaces that a ray passes by their alpha.
    MAX_LAYERS: u32 = 64;
    /// Largest number of cones per pixel.
    MAX_CONES: u32 = 64;
    /// Largest number of fragments per cone.
    MAX_CONE_FRAGMENTS: u32 = 8;
}
