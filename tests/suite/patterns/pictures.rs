//! Pictures of every pattern: omitting unused features changes no bit, and the oracle renders the
//! same picture, including with samples in several blocks.

use moire::internal::lab::metrics::compare;
use moire::internal::render::Tuning;
use moire::internal::scene::model::{Pattern, Scene};

use crate::stage::{assert_same_bits, packed, render, render_on_oracle, render_with, small};

fn with(mut scene: Scene, pattern: Pattern, spp: u32) -> Scene {
    (scene.sampling.pattern, scene.sampling.spp, scene.sampling.shared) = (pattern, spp, false);
    scene
}

/// The first four patterns are those of the scenes that are rendered both ways.
#[test]
fn lean_pipelines_give_the_bits_of_full_ones() {
    for &pattern in &Pattern::ALL[4..] {
        let packed = packed(with(small("s1a", 70, 16), pattern, 16), None);
        let (lean, report) = render_with(&packed, false, &Tuning::default());
        let (full, _) = render_with(&packed, true, &Tuning::default());
        assert!(report.left_out.iter().any(|l| l.starts_with("pattern: ")), "{pattern}");
        assert_same_bits(&lean, &full, pattern.name());
    }
}

/// 512 samples come in two blocks of 256.
#[test]
fn device_and_oracle_see_the_same_pictures() {
    for &pattern in Pattern::ALL {
        let spp = if matches!(pattern, Pattern::Grid | Pattern::Stratified) { 484 } else { 512 };
        let packed = packed(with(small("lights", 24, 1), pattern, spp), None);
        let compared = compare(&render(&packed), &render_on_oracle(&packed)).unwrap();
        // One sample in 512 on the other side of an edge moves a pixel by up to 2e-3; `center` has one in all.
        let bound = if pattern == Pattern::Center { 1e-3 } else { 5e-5 };
        assert!(compared.rmse <= bound, "{pattern}: RMSE {:e}", compared.rmse);
    }
}
