//! Quantises linear f32 pixels to the numbers of a file format: sRGB-encoded integers for PNG, JPEG
//! and TIFF, shared-exponent bytes for Radiance HDR. Values are always rounded to the nearest
//! representable one.

use std::sync::LazyLock;

use crate::core::color::{linear_to_srgb, srgb_to_linear};

/// The bits of a positive float below those that tell the places of the table apart: each octave has 256 places, in which
/// there is one rounding boundary at most, as there are 112 an octave where they lie closest.
const PLACE_SHIFT: u32 = 15;
/// The table begins at 2^-13, below the first boundary, and ends at 1, above the last one.
const FIRST_PLACE: u32 = (127 - 13) << 8;
const PLACES: usize = 13 << 8;

/// The rounding boundaries of the 256 codes; the last one is none. For each place of the table the number of boundaries
/// at or below its smallest value.
struct Codes {
    boundaries: [f64; 256],
    counts: [u8; PLACES],
}

impl Codes {
    fn new() -> Codes {
        let boundary = |i| if i < 255 { srgb_to_linear((i as f64 + 0.5) / 255.0) } else { f64::INFINITY };
        let boundaries: [f64; 256] = std::array::from_fn(boundary);
        let count = |place| {
            let smallest = f32::from_bits((FIRST_PLACE + place as u32) << PLACE_SHIFT);
            boundaries.partition_point(|&b| f64::from(smallest) >= b) as u8
        };
        Codes { boundaries, counts: std::array::from_fn(count) }
    }
}

/// Returns `round(255 · srgb(clip(v)))`. It counts the 255 rounding boundaries at or below `v`,
/// which is exact and many times cheaper than a power per channel. NaN is at or above none of
/// them and becomes 0.
pub fn srgb8(value: f32) -> u8 {
    static CODES: LazyLock<Codes> = LazyLock::new(Codes::new);
    if value >= 1.0 {
        return 255;
    }
    // Of negative numbers and NaN, too, the bits as an integer are beyond the table.
    let place = (value.to_bits() >> PLACE_SHIFT).wrapping_sub(FIRST_PLACE) as usize;
    let codes = &*CODES;
    let Some(&count) = codes.counts.get(place) else { return 0 };
    count + u8::from(f64::from(value) >= codes.boundaries[usize::from(count)])
}

/// Returns `round(65535 · srgb(clip(v)))`; NaN becomes 0.
pub fn srgb16(value: f32) -> u16 {
    let clipped = f64::from(value).clamp(0.0, 1.0);
    (linear_to_srgb(clipped) * 65_535.0).round() as u16
}

/// Returns the nearest colour that RGBE represents (Ward 1991: three mantissas of 8 bits that share
/// the largest channel's exponent; a byte c and the exponent e stand for c · 2^(e − 136)).
/// Truncation would darken every pixel by half a step on average. Negative values and NaN become 0,
/// values above the range the largest one.
pub fn rgbe(pixel: [f32; 3]) -> [u8; 4] {
    const LARGEST: f64 = 255.0 / 256.0 * (1u128 << 127) as f64;
    const SMALLEST: f64 = 1.0 / (1u128 << 127) as f64;
    let clipped = pixel.map(|v| if v > 0.0 { f64::from(v).min(LARGEST) } else { 0.0 });
    let largest = clipped.iter().fold(0.0, |a: f64, &b| a.max(b));
    if largest < SMALLEST {
        return [0; 4];
    }
    // The exponent field of a normal f64: largest is in [2^(e-1), 2^e).
    let exponent = ((largest.to_bits() >> 52) as i32 & 0x7ff) - 1022;
    // Rounding up to 256 steps moves the pixel to the next exponent.
    let exponent = exponent + i32::from(largest * steps(exponent) >= 255.5);
    let steps = steps(exponent);
    // Both are exact: the factor is a power of two, and the sum has few bits.
    let [r, g, b] = clipped.map(|v| (v * steps + 0.5) as u8);
    [r, g, b, (exponent + 128) as u8]
}

/// Returns `2^(8 − exponent)`, the steps in a unit.
fn steps(exponent: i32) -> f64 {
    f64::from_bits(((1023 + 8 - exponent) as u64) << 52)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn srgb8_counts_boundaries_as_the_formula_rounds() {
        for i in 0..=40_000 {
            let v = i as f32 / 36_000.0 - 0.05;
            let want = (linear_to_srgb(f64::from(v).clamp(0.0, 1.0)) * 255.0).round() as u8;
            assert_eq!(srgb8(v), want, "at {v}");
        }
        for boundary in (0..255).map(|i| srgb_to_linear((f64::from(i) + 0.5) / 255.0)) {
            let near = boundary as f32;
            for v in [near.next_down(), near, near.next_up()] {
                let below = |i: u32| srgb_to_linear((f64::from(i) + 0.5) / 255.0) <= f64::from(v);
                assert_eq!(u32::from(srgb8(v)), (0..255).filter(|&i| below(i)).count() as u32, "at {v}");
            }
        }
        assert_eq!([srgb8(1e-5), srgb8(1.2e-4), srgb8(0.999_999), srgb8(-0.5)], [0, 0, 255, 0]);
        assert_eq!([srgb8(f32::NAN), srgb8(f32::INFINITY), srgb8(f32::NEG_INFINITY)], [0, 255, 0]);
        assert_eq!([srgb16(f32::NAN), srgb16(f32::INFINITY), srgb16(-1.0)], [0, 65_535, 0]);
    }

    #[test]
    fn rgbe_rounds_to_the_nearest_step_and_keeps_exact_values() {
        let kept = |pixel| {
            let [r, g, b, e] = rgbe(pixel);
            [r, g, b].map(|c| (f64::from(c) * f64::powi(2.0, i32::from(e) - 136)) as f32)
        };
        assert_eq!(kept([1.0, 0.5, 0.25]), [1.0, 0.5, 0.25]);
        // Largest channel 1.0: steps of 1/128.
        assert_eq!(kept([1.0, 0.0047, 0.0030]), [1.0, 1.0 / 128.0, 0.0]);
        // 255.6 steps of 1/256 round up to the next exponent.
        assert_eq!(kept([0.9985, 0.0, 0.0]), [1.0, 0.0, 0.0]);
        assert_eq!(kept([f32::NAN, -1.0, 1e-39]), [0.0; 3]);
        assert!(kept([f32::INFINITY, 1.0, 0.0])[0] > 1.6e38);
    }
}
