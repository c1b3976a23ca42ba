//! Surface point → texture coordinate. Twin of `glsl/shared/mapping.glsl`.

use std::f64::consts::PI;

use glam::{DVec2, DVec3};

use super::math::{affine, atan2_accurate, vec4};
use crate::layout::Map;
use crate::pack::MapKind;

/// matrix · uv + offset: scale, rotation and offset of the mapping.
pub fn placed(map: &Map, uv: DVec2) -> DVec2 {
    let (m, offset) = (vec4(map.matrix), vec4(map.offset));
    DVec2::new(m.x * uv.x + m.y * uv.y + offset.x, m.z * uv.x + m.w * uv.y + offset.y)
}

/// `p` is relative to the eye; `own_uv` is the plane's own coordinate or the triangle's interpolated one.
pub fn texture_coordinate(map: &Map, p: DVec3, own_uv: DVec2) -> DVec2 {
    let kind = MapKind::ALL[map.link[0] as usize];
    match kind {
        MapKind::VertexUv => return own_uv,
        MapKind::Plane => return placed(map, own_uv),
        MapKind::Affine | MapKind::Cylindrical | MapKind::Spherical => {}
    }
    let (x, y) = (affine(map.x, p), affine(map.y, p));
    if kind == MapKind::Affine {
        return DVec2::new(x, y);
    }
    let z = affine(map.z, p);
    let turn = atan2_accurate(z, x) / (2.0 * PI);
    let turn = if turn < 0.0 { turn + 1.0 } else { turn };
    let uv = match kind {
        MapKind::Spherical => DVec2::new(atan2_accurate(x.hypot(z), y) / PI, turn),
        _ => DVec2::new(turn, y),
    };
    placed(map, uv)
}
