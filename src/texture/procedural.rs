//! Procedural solid textures as data: which pattern, its two colours and its parameters. One cell,
//! period or lattice cell of every pattern is one unit of texture space; a mapping scales it.

pub use crate::schema::enums::ProceduralKind;

impl ProceduralKind {
    /// Made of octaves of noise that differ in scale; `noise` itself is a single one.
    pub fn has_octaves(self) -> bool {
        matches!(
            self,
            ProceduralKind::Fbm | ProceduralKind::Turbulence | ProceduralKind::Marble | ProceduralKind::Wood
        )
    }
}

/// Octaves of a sum: beyond 2²³ times the base frequency single precision holds no fraction.
pub const MAX_OCTAVES: u32 = 16;

/// A pattern that is computed where it is read.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Procedural {
    /// Which one.
    pub kind: ProceduralKind,
    /// Linear RGB of background and figure; patterns made of noise blend between the two.
    pub colors: [[f32; 3]; 2],
    /// Which of 2³² lattices of random gradients or points.
    pub seed: u32,
    /// 1 to `MAX_OCTAVES`.
    pub octaves: u32,
    /// Frequency of each octave over that of the one before, at least 1.
    pub lacunarity: f32,
    /// Amplitude of each octave over that of the one before, in (0, 1].
    pub gain: f32,
    /// Of a stripe (its share of the period), of a grid's lines or of the joints between bricks, in
    /// units; in [0, 1], for bricks below 1 and below `aspect`.
    pub width: f32,
    /// By how many periods turbulence of 1 shifts the veins of marble, or noise of 1 the rings of wood.
    pub distortion: f32,
    /// Length of a brick over its height, joints included.
    pub aspect: f32,
    /// Shift of every other row of bricks, in bricks.
    pub offset: f32,
    /// How far a cell's point may leave the middle: 0 not at all, 1 anywhere in the cell.
    pub jitter: f32,
    /// 2 or 3 families of a grid's lines.
    pub dimensions: u32,
}

impl Procedural {
    /// The pattern with the defaults of its kind, black and white.
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
