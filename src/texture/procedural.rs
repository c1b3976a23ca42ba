//! Procedural solid textures as data: a pattern, its two colours and its parameters. One cell,
//! period or lattice cell of every pattern is one unit of texture space; a mapping scales it.

pub use crate::schema::enums::ProceduralKind;

impl ProceduralKind {
    /// Returns true for sums of octaves of noise that differ in scale; `noise` itself is a single
    /// octave.
    pub fn has_octaves(self) -> bool {
        matches!(
            self,
            ProceduralKind::Fbm | ProceduralKind::Turbulence | ProceduralKind::Marble | ProceduralKind::Wood
        )
    }
}

/// The largest number of octaves: beyond 2²³ times the base frequency, single precision has no
/// fraction bits left.
pub const MAX_OCTAVES: u32 = 16;

/// A pattern that is computed where it is read.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Procedural {
    /// Which one.
    pub kind: ProceduralKind,
    /// Linear RGB of background and foreground; patterns based on noise blend between the two.
    pub colors: [[f32; 3]; 2],
    /// The seed that selects one of 2³² lattices of random gradients or points.
    pub seed: u32,
    /// The number of octaves, 1 to `MAX_OCTAVES`.
    pub octaves: u32,
    /// The frequency of each octave relative to the previous one, at least 1.
    pub lacunarity: f32,
    /// The amplitude of each octave relative to the previous one, in (0, 1].
    pub gain: f32,
    /// The width of a stripe (as a fraction of the period), of a grid's lines or of the joints
    /// between bricks, in units; in [0, 1], for bricks below 1 and below `aspect`.
    pub width: f32,
    /// The displacement in periods of the veins of marble for turbulence of 1, or of the rings of
    /// wood for noise of 1.
    pub distortion: f32,
    /// The length of a brick over its height, joints included.
    pub aspect: f32,
    /// The shift of every other row of bricks, in bricks.
    pub offset: f32,
    /// The deviation of a cell's point from the centre: 0 none, 1 anywhere in the cell.
    pub jitter: f32,
    /// The number of families of grid lines, 2 or 3.
    pub dimensions: u32,
}

impl Procedural {
    /// Returns the pattern with the defaults of its kind in black and white.
    pub fn new(kind: ProceduralKind) -> Procedural {
        let (octaves, distortion) = match kind {
            ProceduralKind::Fbm | ProceduralKind::Turbulence => (5, 0.0),
            ProceduralKind::Marble => (5, 4.0),
            ProceduralKind::Wood => (3, 0.5),
            _ => (1, 0.0),
        };
        let width = if kind == ProceduralKind::Stripes { 0.5 } else { 0.1 };
        Procedural {
            kind,
            colors: [[0.0; 3], [1.0; 3]],
            seed: 0,
            octaves,
            lacunarity: 2.0,
            gain: 0.5,
            width,
            distortion,
            aspect: 2.0,
            offset: 0.5,
            jitter: 1.0,
            dimensions: 2,
        }
    }
}
