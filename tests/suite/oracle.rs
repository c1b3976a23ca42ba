//! Every scene on the device against the same packed bytes in float64, at the same sample positions.
//! Away from discontinuities the two differ by the rounding of f32; at an edge of a shape, a shadow or
//! a texel of `nearest`, a sample within that rounding may fall on the other side, which moves its
//! pixel by a visible step: such pixels are counted.

use moire::internal::core::film::Film;

use crate::stage::{every_scene, packed, render, render_on_oracle, scene, small};

/// A pixel with a larger difference has a sample on the other side of a discontinuity.
const STEP: f64 = 1e-3;
/// With 8 sub-texel bits each of the two weights of `linear` is within 1/256 of the exact one, which
/// moves a mean of texels from [0, 1] by at most 2/256; a driver may truncate where another rounds.
const SUB_TEXEL_STEP: f64 = 2.0 / 256.0 + 1e-3;

/// (scene, step, largest RMSE of the pixels below the step, largest share of the pixels above it).
/// Infinite planes seen up to the horizon lose the texel there: f32 holds a coordinate of 2¹⁶ tiles
/// to 1/128, and `mirrors` shows the horizon once more in each bounce. In `shared`, `nearest` makes
/// every edge of a texel a discontinuity: steps between nearly equal texels, about 4e-4 in as many
/// pixels as step visibly, stay in the RMSE, which they make sqrt(0.013) · 4e-4.
/// If a shape passes through the centre of an angular mapping's frame (`centroid`, `position`), angles change
/// without bound.
const BOUNDS: &[(&str, f64, f64, f64)] = &[
    ("beams", STEP, 1e-6, 0.0),
    ("centroid", STEP, 5e-5, 0.001),
    ("cones", STEP, 1e-4, 0.01),
    ("discs", STEP, 1e-5, 0.002),
    ("environment", STEP, 1e-5, 0.001),
    ("environment_cube", STEP, 1e-5, 0.001),
    ("filters", STEP, 1e-5, 0.001),
    ("formats", STEP, 1e-6, 0.0),
    ("glass", STEP, 1e-4, 0.005),
    ("glossy", STEP, 1e-4, 0.01),
    ("hardware", SUB_TEXEL_STEP, 2e-3, 0.01),
    ("horizon", STEP, 1e-4, 0.015),
    ("inside", STEP, 1e-5, 0.0005),
    ("lanczos", STEP, 1e-5, 0.001),
    ("lecture", STEP, 1e-5, 0.0005),
    ("lens", STEP, 1e-5, 0.005),
    ("lights", STEP, 2e-6, 0.0005),
    ("mappings", STEP, 6e-5, 0.0005),
    ("materials", STEP, 1e-5, 0.001),
    ("meshes", STEP, 1e-4, 0.01),
    ("models", STEP, 1e-4, 0.01),
    ("mirrors", STEP, 2.5e-4, 0.03),
    ("motion", STEP, 1e-4, 0.01),
    ("normal", STEP, 1e-5, 0.001),
    ("penumbra", STEP, 1e-5, 0.005),
    ("physical", STEP, 1e-3, 0.02),
    ("position", STEP, 5e-5, 0.002),
    ("procedural", STEP, 1e-5, 0.001),
    ("quad", STEP, 0.0, 0.0),
    ("ramp", STEP, 1e-5, 0.001),
    ("reflection", STEP, 1e-5, 0.001),
    ("rough", STEP, 1e-5, 0.002),
    ("samplers", STEP, 1e-6, 0.0),
    ("shared", STEP, 5e-5, 0.03),
    ("volume", STEP, 1e-5, 0.001),
    ("zone_plate", STEP, 5e-5, 0.001),
    ("s1a", STEP, 5e-5, 0.001),
    ("s1b", STEP, 1e-4, 0.005),
    ("s2", STEP, 2e-5, 0.001),
];

struct Agreement {
    /// RMSE of the pixels below the step.
    rmse: f64,
    /// Share of the pixels above it.
    stepped: f64,
}

fn agreement(a: &Film, b: &Film, step: f64) -> Agreement {
    let apart =
        |p: &[f32; 3], q: &[f32; 3]| (0..3).map(|c| f64::from((p[c] - q[c]).abs())).fold(0.0, f64::max);
    let differences: Vec<f64> = a.pixels.iter().zip(&b.pixels).map(|(p, q)| apart(p, q)).collect();
    let smooth: Vec<f64> = differences.iter().copied().filter(|d| *d <= step).collect();
    let mean = smooth.iter().map(|d| d * d).sum::<f64>() / smooth.len() as f64;
    let stepped = (differences.len() - smooth.len()) as f64 / differences.len() as f64;
    Agreement { rmse: mean.sqrt(), stepped }
}

every_scene! { device_agrees_with_float64_on: super::device_agrees_with_float64 }

fn device_agrees_with_float64(name: &str) {
    let (_, step, rmse, stepped) = *BOUNDS.iter().find(|b| b.0 == name).expect("no bounds for this scene");
    // `quad` samples the centres of texels; at another size it would sample their edges.
    let scene = if name == "quad" { scene(name) } else { small(name, 96, 4) };
    let packed = packed(scene, None);
    let (device, oracle) = (render(&packed), render_on_oracle(&packed));
    assert!(device.pixels.iter().flatten().all(|v| v.is_finite()), "{name}: not finite");
    let found = agreement(&device, &oracle, step);
    assert!(found.rmse <= rmse, "{name}: RMSE {:.2e}, bound {rmse:e}", found.rmse);
    assert!(found.stepped <= stepped, "{name}: share {:.5} of the pixels, bound {stepped}", found.stepped);
}

/// A shift of a hundredth of a texel is far above the bounds of a smooth scene.
#[test]
fn a_small_shift_of_the_texture_would_be_seen() {
    let scene = small("mappings", 96, 4);
    let mut shifted = scene.clone();
    shifted.materials.iter_mut().for_each(|m| m.mapping.offset.x += 0.01 / 256.0);
    let found = agreement(&render(&packed(shifted, None)), &render_on_oracle(&packed(scene, None)), STEP);
    let (_, _, rmse, stepped) = *BOUNDS.iter().find(|b| b.0 == "mappings").unwrap();
    assert!(found.rmse > 2.0 * rmse || found.stepped > 2.0 * stepped, "{:e}", found.rmse);
}
