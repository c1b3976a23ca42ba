//! The way of a mirrored ray: that of model `mirror`, of what other models mirror, and the middle of a highlight.
//! Twin of `glsl/shared/bsdf/mirror.glsl`.

use glam::DVec3;

/// d - 2 (d·n) n, for unit n.
pub fn mirrored(direction: DVec3, normal: DVec3) -> DVec3 {
    direction - 2.0 * direction.dot(normal) * normal
}
