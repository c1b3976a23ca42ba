//! Tone maps: curves by which radiance without an upper bound becomes the light of a screen, from 0 to 1. In and out:
//! linear colours of sRGB. Each curve is a published one with its own constants, maps 0 to 0 and is monotone on greys;
//! negative components count as 0.

use glam::{DMat3, DVec3};

use crate::core::named::named_enum;

named_enum! {
    /// How radiance becomes the light of a screen.
    pub enum ToneMap {
        /// Values above 1 are clipped.
        None = "none",
        /// E. Reinhard et al. 2002, equation 4, of the luminance; 4, two stops above 1, becomes white.
        Reinhard = "reinhard",
        /// J. Hable's curve of Uncharted 2 (2010), a component at a time, with white 11.2 and exposure bias 2.
        Filmic = "filmic",
        /// S. Hill's fit of the ACES 1.0 RRT and sRGB ODT (Baking Lab, 2015).
        Aces = "aces",
        /// K. Narkowicz's fit of the same curve (2015), without its matrices: brighter, and hues shift.
        AcesNarkowicz = "aces-narkowicz",
        /// T. Sobotka's AgX, base look, as B. Wrensch fitted it (2023).
        Agx = "agx",
    }
}

impl ToneMap {
    /// Returns the light of the screen for a finite colour: all maps but `none` return components from 0 to 1.
    pub fn apply(self, color: DVec3) -> DVec3 {
        let curve = match self {
            ToneMap::None => return color,
            ToneMap::Reinhard => reinhard,
            ToneMap::Filmic => filmic,
            ToneMap::Aces => aces,
            ToneMap::AcesNarkowicz => aces_narkowicz,
            ToneMap::Agx => agx,
        };
        curve(color.max(DVec3::ZERO)).clamp(DVec3::ZERO, DVec3::ONE)
    }
}

/// Scales a colour so that its luminance L becomes L (1 + L/W²) / (1 + L), with W = 4.
fn reinhard(color: DVec3) -> DVec3 {
    const WHITE: f64 = 4.0;
    /// The luminances of red, green and blue (Rec. ITU-R BT.709).
    const LUMINANCE: DVec3 = DVec3::new(0.2126, 0.7152, 0.0722);
    let luminance = color.dot(LUMINANCE);
    color * ((1.0 + luminance / (WHITE * WHITE)) / (1.0 + luminance))
}

/// Maps each component by a quotient of polynomials with a toe, a straight part and a shoulder.
fn filmic(color: DVec3) -> DVec3 {
    const WHITE: f64 = 11.2;
    const EXPOSURE_BIAS: f64 = 2.0;
    // Shoulder strength, linear strength, linear angle, toe strength, toe numerator, toe denominator.
    let [a, b, c, d, e, f] = [0.15, 0.50, 0.10, 0.20, 0.02, 0.30];
    let curve = |x: f64| (x * (a * x + c * b) + d * e) / (x * (a * x + b) + d * f) - e / f;
    color.map(|x| curve(EXPOSURE_BIAS * x) / curve(WHITE))
}

/// Maps each component by a fit of the curve of ACES, between a matrix to its primaries and one back.
fn aces(color: DVec3) -> DVec3 {
    // sRGB to XYZ, D65 to D60, to AP1, then the desaturation of the RRT.
    const INPUT: DMat3 = DMat3::from_cols_array(&[
        0.59719, 0.07600, 0.02840, //
        0.35458, 0.90834, 0.13383, //
        0.04823, 0.01566, 0.83777,
    ]);
    // The desaturation of the ODT, then from AP1 to XYZ, D60 to D65, to sRGB.
    const OUTPUT: DMat3 = DMat3::from_cols_array(&[
        1.60475, -0.10208, -0.00327, //
        -0.53108, 1.10813, -0.07276, //
        -0.07367, -0.00605, 1.07602,
    ]);
    let curve =
        |v: f64| (v * (v + 0.024_578_6) - 0.000_090_537) / (v * (0.983_729 * v + 0.432_951_0) + 0.238_081);
    OUTPUT * (INPUT * color).map(curve)
}

/// Maps each component by a fit of the curve of ACES.
fn aces_narkowicz(color: DVec3) -> DVec3 {
    color.map(|x| x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14))
}

/// Maps each component's logarithm by a polynomial, between a matrix that moves primaries inwards and its inverse. The
/// mean squared error of the polynomial against the curve of AgX is 3.7e-6, as its author states.
fn agx(color: DVec3) -> DVec3 {
    const INSET: DMat3 = DMat3::from_cols_array(&[
        0.842_479_062_253_094,
        0.042_328_242_261_012_3,
        0.042_375_654_905_705_1,
        0.078_433_599_999_999_2,
        0.878_468_636_469_772,
        0.078_433_6,
        0.079_223_745_147_764_3,
        0.079_166_127_460_543_4,
        0.879_142_973_793_104,
    ]);
    const OUTSET: DMat3 = DMat3::from_cols_array(&[
        1.196_879_005_120_17,
        -0.052_896_851_757_456_2,
        -0.052_971_635_514_443_8,
        -0.098_020_881_140_136_8,
        1.151_903_129_904_17,
        -0.098_043_450_117_124_1,
        -0.099_029_744_079_720_5,
        -0.098_961_176_844_843_3,
        1.151_073_672_641_16,
    ]);
    /// Logarithms between which the curve lies: 10 stops below middle grey, and 6.5 above.
    const MIN_EV: f64 = -12.473_93;
    const MAX_EV: f64 = 4.026_069;
    let curve = |v: f64| {
        let x = (v.log2().clamp(MIN_EV, MAX_EV) - MIN_EV) / (MAX_EV - MIN_EV);
        [0.1191, 0.4298, -6.868, 31.96, -40.14, 15.5].iter().rev().fold(0.0, |sum, c| (sum + c) * x)
            - 0.002_32
    };
    // The curve ends in the light of a screen whose transfer function is a power of 2.2.
    (OUTSET * (INSET * color).map(curve)).map(|v| v.max(0.0).powf(2.2))
}
