//! Weights of `lanczos-2` and `lanczos-3`, by hand and by their sum. Device and oracle are compared where all filters are
//! (`footprints/lookups.rs`).

use std::f64::consts::PI;

use moire::internal::oracle::filter::kernels::lanczos_weights;

#[test]
fn weights_worked_out_by_hand() {
    // Half way between two texels, radius 2: sinc(1/2) sinc(1/4) and sinc(3/2) sinc(3/4), over twice their sum.
    let near = (2.0 / PI) * (0.5f64.sqrt() * 4.0 / PI);
    let far = (-2.0 / (3.0 * PI)) * (0.5f64.sqrt() * 4.0 / (3.0 * PI));
    let right = [far, near, near, far].map(|w| w / (2.0 * (near + far)));
    for (weight, right) in lanczos_weights(0.5, 2).into_iter().zip(right) {
        assert!((weight - right).abs() < 1e-15, "{weight}, by hand {right}");
    }
    // Radius 3: sinc(x) sinc(x / 3) at 1/2, 3/2 and 5/2.
    let at = |x: f64| (PI * x).sin() / (PI * x) * (PI * x / 3.0).sin() / (PI * x / 3.0);
    let [a, b, c] = [0.5, 1.5, 2.5].map(at);
    let sum = 2.0 * (a + b + c);
    for (weight, right) in lanczos_weights(0.5, 3).into_iter().zip([c, b, a, a, b, c]) {
        assert!((weight - right / sum).abs() < 1e-15, "{weight}, by hand {}", right / sum);
    }
}

#[test]
fn weights_interpolate_sum_to_one_and_are_symmetric() {
    for radius in [2, 3] {
        let taps = 2 * radius as usize;
        let at_texel = lanczos_weights(0.0, radius);
        for (i, weight) in at_texel.iter().enumerate() {
            let right = if i == taps / 2 - 1 { 1.0 } else { 0.0 };
            assert!((weight - right).abs() < 1e-15, "{radius}: {at_texel:?}");
        }
        for i in 1..100 {
            let t = f64::from(i) / 100.0;
            let [there, back] = [t, 1.0 - t].map(|t| lanczos_weights(t, radius));
            assert_eq!(there.len(), taps);
            assert!((there.iter().sum::<f64>() - 1.0).abs() < 1e-14);
            for (a, b) in there.iter().zip(back.iter().rev()) {
                assert!((a - b).abs() < 1e-14, "{radius} at {t}");
            }
            // Their negative weights make fringes at edges.
            assert!(there[taps / 2 - 2] < 0.0 && there[taps / 2 + 1] < 0.0, "{radius} at {t}");
        }
    }
}
