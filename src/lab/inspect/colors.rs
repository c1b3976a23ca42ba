//! Colour maps: a number in [0, 1], or the number of a category → sRGB, and back to the linear light of films.

use crate::core::color::srgb_to_linear;

/// Every eighth of viridis (Smith & van der Walt 2015), whose lightness grows evenly, for the colour-blind too.
const VIRIDIS: [[u8; 3]; 9] = [
    [68, 1, 84],
    [71, 44, 122],
    [59, 81, 139],
    [44, 113, 142],
    [33, 144, 141],
    [39, 173, 129],
    [92, 200, 99],
    [170, 220, 50],
    [253, 231, 37],
];

/// Blue, white, red (ColorBrewer RdBu, reversed).
const BLUE_TO_RED: [[u8; 3]; 5] = [[5, 48, 97], [67, 147, 195], [247, 247, 247], [214, 96, 77], [103, 0, 31]];

/// Pixels without a value, and the ground behind a legend.
pub const NOTHING: [u8; 3] = [38, 38, 42];

/// Returns the linear light of an sRGB colour.
pub fn light(color: [u8; 3]) -> [f32; 3] {
    color.map(|c| srgb_to_linear(f64::from(c) / 255.0) as f32)
}

/// Returns the colour at a place in [0, 1] of a list of colours at even distances.
fn between(colors: &[[u8; 3]], at: f64) -> [u8; 3] {
    let steps = colors.len() - 1;
    let at = if at >= 0.0 { at.min(1.0) * steps as f64 } else { 0.0 };
    let first = (at as usize).min(steps - 1);
    let rest = at - first as f64;
    let [a, b] = [colors[first], colors[first + 1]];
    [0, 1, 2].map(|c| ((1.0 - rest) * f64::from(a[c]) + rest * f64::from(b[c])).round() as u8)
}

/// Returns a colour of the map from dark blue over green to yellow.
pub fn viridis(at: f64) -> [u8; 3] {
    between(&VIRIDIS, at)
}

/// Returns a colour of the map from blue over white to red.
pub fn diverging(at: f64) -> [u8; 3] {
    between(&BLUE_TO_RED, at)
}

/// Returns the colour of a category: hues at steps of the golden ratio, so that neighbours differ.
pub fn category(number: u32) -> [u8; 3] {
    let hue = (f64::from(number) * 0.618_033_988_749_895).fract() * 6.0;
    let lightness = [0.95, 0.75, 0.6][number as usize % 3];
    let channel = |shift: f64| {
        let distance = ((hue + shift).rem_euclid(6.0) - 3.0).abs();
        let full = (distance - 1.0).clamp(0.0, 1.0);
        (255.0 * lightness * (0.3 + 0.7 * full)).round() as u8
    };
    [channel(0.0), channel(4.0), channel(2.0)]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn maps_begin_and_end_at_their_ends_and_take_any_number() {
        assert_eq!([viridis(0.0), viridis(1.0), viridis(0.5)], [VIRIDIS[0], VIRIDIS[8], VIRIDIS[4]]);
        assert_eq!([viridis(-1.0), viridis(9.0), viridis(f64::NAN)], [VIRIDIS[0], VIRIDIS[8], VIRIDIS[0]]);
        assert_eq!(diverging(0.5), [247, 247, 247]);
        let [blue, red] = [diverging(0.0), diverging(1.0)];
        assert!(blue[2] > blue[0] && red[0] > red[2]);
    }

    #[test]
    fn the_first_categories_differ_from_each_other() {
        let colors: std::collections::BTreeSet<[u8; 3]> = (1..=24).map(category).collect();
        assert_eq!(colors.len(), 24);
    }
}
