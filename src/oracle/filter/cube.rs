//! The texels of a cube around a position on one of its faces: beyond an edge those of the adjacent face.
//! Twin of `glsl/shared/filter/cube.glsl`.

use glam::{DVec2, DVec3};

use crate::oracle::mapping::{face_uv, on_cube_face, within_face};

pub fn is_corner([x, y]: [i64; 2], size: i64) -> bool {
    !(0..size).contains(&x) && !(0..size).contains(&y)
}

/// Returns the direction from a cube's centre to a point in a face's plane, (s, t) in [-1, 1] on the face.
pub fn face_direction(face: u32, st: DVec2) -> DVec3 {
    let (s, t) = (st.x, st.y);
    match face {
        0 => DVec3::new(1.0, -t, -s),
        1 => DVec3::new(-1.0, -t, s),
        2 => DVec3::new(s, 1.0, t),
        3 => DVec3::new(s, -1.0, -t),
        4 => DVec3::new(s, -t, 1.0),
        _ => DVec3::new(-s, -t, -1.0),
    }
}

/// Projects a point in a face's plane to the face behind it.
pub fn refaced(at: DVec3, face: u32) -> (DVec3, u32) {
    let (stm, other) = on_cube_face(face_direction(face, 2.0 * at.truncate() - 1.0));
    (within_face(stm).extend(0.0), other)
}

/// Returns the texel at a position on a face, or beyond its edge: that of the adjacent face which the
/// extended plane of the face covers there.
pub fn cube_texel(face: u32, [x, y]: [i64; 2], size: i64) -> [i64; 3] {
    if (0..size).contains(&x) && (0..size).contains(&y) {
        return [x, y, i64::from(face)];
    }
    let st = DVec2::new((2 * x + 1) as f64, (2 * y + 1) as f64) / size as f64 - 1.0;
    let (stm, other) = on_cube_face(face_direction(face, st));
    let [x, y] = (face_uv(stm) * size as f64).floor().to_array().map(|n| (n as i64).clamp(0, size - 1));
    [x, y, i64::from(other)]
}
