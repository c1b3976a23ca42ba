//! Model `lambert`: albedo/π, whatever the two directions are. Twin of `glsl/shared/bsdf/lambert.glsl`.

/// The lobe that the albedo colours, over 1/π; there is no other.
pub fn lambert_lobes() -> [f64; 2] {
    [1.0, 0.0]
}
