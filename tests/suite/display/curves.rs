//! The curves of tone maps: their properties, and values by their publications.

use glam::DVec3;
use moire::internal::output::ToneMap;

/// All maps but `none`.
fn maps() -> impl Iterator<Item = ToneMap> {
    ToneMap::ALL.iter().copied().filter(|map| *map != ToneMap::None)
}

/// Greys from far below black to far above white, ever brighter.
fn greys() -> impl Iterator<Item = f64> {
    (-2000..=2000).map(|i| f64::from(i) / 100.0).map(f64::exp2)
}

#[test]
fn black_stays_black_and_negative_light_is_black() {
    for map in maps() {
        assert_eq!(map.apply(DVec3::ZERO), DVec3::ZERO, "{map}");
        assert_eq!(map.apply(DVec3::new(-1.0, -1e30, -0.0)), DVec3::ZERO, "{map}");
    }
    assert_eq!(ToneMap::None.apply(DVec3::new(-1.0, 0.0, 7.0)), DVec3::new(-1.0, 0.0, 7.0));
}

#[test]
fn brighter_greys_become_no_darker_and_stay_grey() {
    for map in maps() {
        let mut last = 0.0;
        for grey in greys() {
            let DVec3 { x, y, z } = map.apply(DVec3::splat(grey));
            assert!((0.0..=1.0).contains(&y) && y >= last, "{map} at {grey}: {y} after {last}");
            // The matrices of AgX and ACES are printed with few digits.
            assert!((x - y).abs() < 2e-3 && (z - y).abs() < 2e-3, "{map} at {grey}: {x} {y} {z}");
            last = y;
        }
        assert!(last > 0.99, "{map} ends at {last}");
    }
}

#[test]
fn more_of_a_component_is_not_less_of_it() {
    for map in maps() {
        for other in [0.0, 0.18, 3.0] {
            for component in 0..3 {
                let mut last = 0.0;
                for light in greys() {
                    let mut color = DVec3::splat(other);
                    color[component] = light;
                    let shown = map.apply(color);
                    assert!(shown.min_element() >= 0.0 && shown.max_element() <= 1.0, "{map}: {color}");
                    // Where AgX has nearly reached 1, the others still rise and take a little of it.
                    let fall = if map == ToneMap::Agx { 2e-4 } else { 1e-12 };
                    assert!(shown[component] >= last - fall, "{map} at {color}: {shown} after {last}");
                    last = shown[component];
                }
            }
        }
    }
}

#[test]
fn known_values_are_those_of_the_publications() {
    for (map, light, shown, tolerance) in [
        // Equation 4 with a white of 4: (1 + 1/16) / 2, and white itself.
        (ToneMap::Reinhard, 1.0, 0.531_25, 1e-12),
        (ToneMap::Reinhard, 4.0, 1.0, 1e-12),
        // Twice 5.6 is white.
        (ToneMap::Filmic, 5.6, 1.0, 1e-12),
        (ToneMap::Filmic, 0.18, 0.128_3, 1e-4),
        // ACES 1.0 shows 18 % grey at a tenth of its white; the fit is within 6e-3.
        (ToneMap::Aces, 0.18, 0.1, 6e-3),
        (ToneMap::Aces, 0.18, 0.105_591, 1e-5),
        (ToneMap::AcesNarkowicz, 1.0, 2.54 / 3.16, 1e-12),
        // Middle grey is the pivot of AgX, half of the screen's range before its power of 2.2; the fit is within 4e-3.
        (ToneMap::Agx, 0.18, 0.5f64.powf(2.2), 4e-3),
        (ToneMap::Agx, 2.0f64.powf(-12.5), 0.0, 1e-12),
    ] {
        let found = map.apply(DVec3::splat(light)).y;
        assert!((found - shown).abs() <= tolerance, "{map} at {light}: {found} is not {shown}");
    }
}

/// The reason for ACES and AgX: bright saturated light becomes paler, not a flat patch.
#[test]
fn very_bright_blue_turns_pale_with_the_matrices_and_stays_blue_without() {
    let blue = DVec3::new(0.0, 0.0, 50.0);
    assert!(ToneMap::Agx.apply(blue).x > 0.3 && ToneMap::Aces.apply(blue).y > 0.1);
    assert_eq!(ToneMap::Filmic.apply(blue), DVec3::new(0.0, 0.0, 1.0));
}
