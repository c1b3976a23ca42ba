//! Address modes: the texel that a coordinate selects along an axis (Vulkan 1.3, "Wrapping Operation"). Twin
//! of `glsl/shared/address.glsl`.

use crate::texture::sampler_spec::Address;

/// Returns the coordinate in texels, moved close to the texture without changing the selected texel. Values
/// that are not finite become 0 in the periodic modes; in the others NaN becomes the lower end.
pub fn reduced_coordinate(mode: Address, u: f64, size: f64) -> f64 {
    let reduced = match mode {
        Address::Repeat => u - u.floor(),
        Address::MirroredRepeat => u - 2.0 * (0.5 * u).floor(),
        _ if u >= -2.0 => u.min(3.0),
        _ => -2.0,
    };
    if reduced.is_finite() { reduced * size } else { 0.0 }
}

/// Implements "Wrapping Operation" of Vulkan 1.3 for every i; `None` selects the border colour.
pub fn addressed_texel(mode: Address, i: i64, size: i64) -> Option<i64> {
    let mirror = |n: i64| if n >= 0 { n } else { -1 - n };
    match mode {
        Address::Repeat => Some(i.rem_euclid(size)),
        Address::MirroredRepeat => Some(size - 1 - mirror(i.rem_euclid(2 * size) - size)),
        Address::ClampToEdge => Some(i.clamp(0, size - 1)),
        Address::ClampToBorder => (0..size).contains(&i).then_some(i),
        Address::MirrorClampToEdge => Some(mirror(i).clamp(0, size - 1)),
    }
}
