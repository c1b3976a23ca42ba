//! Numbers in messages: as short as they can be, whatever their size.

use glam::DVec3;

/// Numbers from here on, and below its inverse, are told with an exponent.
const LONG: f64 = 1e15;

/// Returns a number as people write it: `0.25`, `1e300`.
pub fn shown(number: f64) -> String {
    let size = number.abs();
    let is_long = size != 0.0 && !(1.0 / LONG..LONG).contains(&size) && number.is_finite();
    if is_long { format!("{number:e}") } else { number.to_string() }
}

/// Returns a vector as people write it: `[0, 1e300, 2]`.
pub fn shown_vector(vector: DVec3) -> String {
    let [x, y, z] = vector.to_array().map(shown);
    format!("[{x}, {y}, {z}]")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn long_numbers_have_an_exponent() {
        let told = [0.0, -0.25, 1e6, 1e300, -1e-30, f64::NAN, f64::INFINITY].map(shown);
        assert_eq!(told, ["0", "-0.25", "1000000", "1e300", "-1e-30", "NaN", "inf"]);
        assert_eq!(shown_vector(DVec3::new(0.0, 1e300, 2.5)), "[0, 1e300, 2.5]");
    }
}
