//! Normals of which a file has x and y alone. Takes these as a normal map stores them, from 0 to 1; returns the texel with
//! the z that makes the length 1, as whoever stores two channels expects of a shader.

/// Returns a signed number in the range of an unsigned one.
pub(super) fn unsigned(value: f64) -> f64 {
    0.5 + 0.5 * value
}

/// Returns red, green, the blue of a unit normal, and opaque alpha.
pub(super) fn with_z([red, green]: [f64; 2]) -> [f64; 4] {
    let [x, y] = [red, green].map(|value| 2.0 * value - 1.0);
    let z = (1.0 - x * x - y * y).max(0.0).sqrt();
    [red, green, unsigned(z), 1.0]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn z_makes_a_unit_normal_and_is_zero_where_none_can() {
        assert_eq!(with_z([0.5, 0.5]), [0.5, 0.5, 1.0, 1.0]);
        let [x, y, z, _] = with_z([0.8, 0.4]).map(|value| 2.0 * value - 1.0);
        assert!((x * x + y * y + z * z - 1.0).abs() < 1e-12);
        assert_eq!(with_z([1.0, 1.0])[2], 0.5);
        assert_eq!([-1.0, 0.0, 1.0].map(unsigned), [0.0, 0.5, 1.0]);
    }
}
