//! Model `unlit`: the colour itself, without any light. Twin of `glsl/shared/bsdf/unlit.glsl`.

use glam::DVec3;

/// Radiance that a surface of this colour sends on by itself.
pub fn unlit_emitted(color: DVec3) -> DVec3 {
    color
}
