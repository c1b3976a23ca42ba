//! The colour spaces of FLIP (Andersson et al. 2020): linear sRGB primaries with white D65 ↔ the linear
//! opponent space Y Cx Cz, CIE L*a*b* with Hunt's adjustment, and the distance HyAB mapped to [0, 1].

const TO_XYZ: [[f32; 3]; 3] = [
    [0.412_386_56, 0.357_591_49, 0.180_450_49],
    [0.212_636_82, 0.715_182_98, 0.072_180_2],
    [0.019_330_62, 0.119_197_16, 0.950_372_6],
];
const FROM_XYZ: [[f32; 3]; 3] = [
    [3.241_003_3, -1.537_399, -0.498_615_86],
    [-0.969_224_33, 1.875_930_1, 0.041_554_224],
    [0.055_639_423, -0.204_011_2, 1.057_149],
];
/// XYZ of linear RGB (1, 1, 1).
const WHITE: [f32; 3] = [0.950_428_54, 1.0, 1.088_900_4];

/// The exponent of colour differences; those up to `KNEE` of the largest map to the first `BEFORE`
/// of the range.
const EXPONENT: f32 = 0.7;
const KNEE: f32 = 0.4;
const BEFORE: f32 = 0.95;

/// Converts linear RGB to Y Cx Cz.
pub fn opponent(rgb: [f32; 3]) -> [f32; 3] {
    let [x, y, z] = relative_xyz(rgb);
    [116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)]
}

/// Converts Y Cx Cz to linear RGB.
pub fn linear_of([y, cx, cz]: [f32; 3]) -> [f32; 3] {
    let y = (y + 16.0) / 116.0;
    let xyz = [y + cx / 500.0, y, y - cz / 200.0];
    times(&FROM_XYZ, [0, 1, 2].map(|i: usize| xyz[i] * WHITE[i]))
}

/// Converts linear RGB to L*, and 0.01·L* times a* and b*.
pub fn lab_hunt(rgb: [f32; 3]) -> [f32; 3] {
    const DELTA: f32 = 6.0 / 29.0;
    let root = |t: f32| {
        if t > DELTA * DELTA * DELTA { t.cbrt() } else { t / (3.0 * DELTA * DELTA) + 4.0 / 29.0 }
    };
    let [x, y, z] = relative_xyz(rgb).map(root);
    let l = 116.0 * y - 16.0;
    [l, 0.01 * l * 500.0 * (x - y), 0.01 * l * 200.0 * (y - z)]
}

/// Returns the HyAB distance of two adjusted colours, mapped to [0, 1].
pub fn difference(a: [f32; 3], b: [f32; 3]) -> f32 {
    let largest = largest();
    let knee = KNEE * largest;
    let error = hyab(a, b).powf(EXPONENT);
    if error < knee {
        error * BEFORE / knee
    } else {
        BEFORE + (error - knee) / (largest - knee) * (1.0 - BEFORE)
    }
}

/// Returns the largest distance, that between green and blue.
fn largest() -> f32 {
    use std::sync::OnceLock;
    static LARGEST: OnceLock<f32> = OnceLock::new();
    let compute = || hyab(lab_hunt([0.0, 1.0, 0.0]), lab_hunt([0.0, 0.0, 1.0])).powf(EXPONENT);
    *LARGEST.get_or_init(compute)
}

fn hyab(a: [f32; 3], b: [f32; 3]) -> f32 {
    (a[0] - b[0]).abs() + (a[1] - b[1]).hypot(a[2] - b[2])
}

fn relative_xyz(rgb: [f32; 3]) -> [f32; 3] {
    let xyz = times(&TO_XYZ, rgb);
    [0, 1, 2].map(|i: usize| xyz[i] / WHITE[i])
}

fn times(matrix: &[[f32; 3]; 3], v: [f32; 3]) -> [f32; 3] {
    matrix.map(|row| row[0] * v[0] + row[1] * v[1] + row[2] * v[2])
}
