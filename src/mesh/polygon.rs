//! Cuts polygons into triangles. Input: the positions of a mesh and the corners of one face, indices into them.
//! Output: triangles, each three indices into those corners, turned the same way as the face. Faces that span no
//! area give none.

use earcut::Earcut;
use glam::{DVec2, DVec3};

/// The most corners of a face: cutting takes time that may grow with their square.
pub(super) const MOST_CORNERS: usize = 10_000;

/// Twice the area, relative to the square of its size, under which a face counts as having none.
const LEAST_AREA: f64 = 1e-14;

/// Cuts a face into triangles over `corners`; a triangle stays as it is.
pub(super) fn triangles(positions: &[DVec3], corners: &[u32]) -> Vec<[usize; 3]> {
    if corners.len() == 3 {
        return vec![[0, 1, 2]];
    }
    let kept = distinct(corners);
    if kept.len() > MOST_CORNERS {
        return Vec::new();
    }
    let Some(points) = kept.iter().map(|(_, vertex)| positions.get(*vertex as usize).copied()).collect()
    else {
        return Vec::new();
    };
    let Some(flat) = flattened(points) else {
        return Vec::new();
    };
    let cut = match flat.as_slice() {
        [_, _, _] => vec![[0, 1, 2]],
        [a, b, c, d] => quad([*a, *b, *c, *d]),
        _ => ears(&flat),
    };
    let original = |i: usize| kept.get(i).map(|(corner, _)| *corner);
    cut.into_iter().filter_map(|[a, b, c]| Some([original(a)?, original(b)?, original(c)?])).collect()
}

/// Returns the corners, each with its place in the list, without those that repeat the one before them.
fn distinct(corners: &[u32]) -> Vec<(usize, u32)> {
    let mut kept: Vec<(usize, u32)> = Vec::with_capacity(corners.len());
    for (i, &vertex) in corners.iter().enumerate() {
        if kept.last().is_none_or(|(_, last)| *last != vertex) {
            kept.push((i, vertex));
        }
    }
    while kept.len() > 1 && kept.first().map(|(_, v)| v) == kept.last().map(|(_, v)| v) {
        kept.pop();
    }
    kept
}

/// Projects a polygon along its normal, so that it runs counter-clockwise and its size is about one. Returns
/// nothing for one without an area.
fn flattened(mut points: Vec<DVec3>) -> Option<Vec<DVec2>> {
    let origin = *points.first()?;
    // Near the origin and of size one, products neither cancel nor overflow.
    let size = points.iter().map(|p| (*p - origin).abs().max_element()).fold(0.0, f64::max);
    if size == 0.0 || !points.iter().all(|p| (*p - origin).is_finite()) {
        return None;
    }
    points.iter_mut().for_each(|p| *p = (*p - origin) / size);
    let normal = newell(&points);
    if !normal.is_finite() || normal.length() < LEAST_AREA {
        return None;
    }
    let normal = normal.normalize();
    let right = normal.any_orthonormal_vector();
    let up = normal.cross(right);
    Some(points.iter().map(|p| DVec2::new(p.dot(right), p.dot(up))).collect())
}

/// Returns the normal by Newell's method, which suits polygons that are concave or not quite flat. Its length is
/// twice the area.
fn newell(points: &[DVec3]) -> DVec3 {
    let next = points.iter().cycle().skip(1);
    points.iter().zip(next).map(|(a, b)| a.cross(*b)).sum()
}

/// Returns twice the area of a triangle, negative if it runs clockwise.
fn area(a: DVec2, b: DVec2, c: DVec2) -> f64 {
    (b - a).perp_dot(c - a)
}

/// Cuts a quad along the shorter of its diagonals that lie inside. Where none does, because a strongly warped one
/// crosses itself in projection, the two triangles along the shorter one still meet its neighbours.
fn quad([a, b, c, d]: [DVec2; 4]) -> Vec<[usize; 3]> {
    let inside_ac = area(a, b, c).min(area(a, c, d)) > LEAST_AREA;
    let inside_bd = area(b, c, d).min(area(b, d, a)) > LEAST_AREA;
    let along_ac = match (inside_ac, inside_bd) {
        (only_ac, only_bd) if only_ac != only_bd => only_ac,
        _ => a.distance_squared(c) <= b.distance_squared(d),
    };
    if along_ac { vec![[0, 1, 2], [0, 2, 3]] } else { vec![[1, 2, 3], [1, 3, 0]] }
}

/// Cuts any polygon by clipping its ears.
fn ears(flat: &[DVec2]) -> Vec<[usize; 3]> {
    let mut indices: Vec<usize> = Vec::new();
    Earcut::new().earcut(flat.iter().map(|p| p.to_array()), &[], &mut indices);
    let mut cut: Vec<[usize; 3]> =
        indices.chunks_exact(3).filter_map(|three| <[usize; 3]>::try_from(three).ok()).collect();
    // The crate turns all triangles one way, whichever way the polygon runs.
    let turned: f64 = cut.iter().filter_map(|three| signed(flat, three)).sum();
    if turned < 0.0 {
        cut.iter_mut().for_each(|three| three.swap(1, 2));
    }
    cut
}

/// Returns twice the signed area of a triangle over the points.
fn signed(flat: &[DVec2], [a, b, c]: &[usize; 3]) -> Option<f64> {
    Some(area(*flat.get(*a)?, *flat.get(*b)?, *flat.get(*c)?))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Checks that the triangles of a flat polygon have its Newell normal, each and in sum.
    fn assert_covers(points: &[DVec3], count: usize) {
        let corners: Vec<u32> = (0..points.len() as u32).collect();
        let cut = triangles(points, &corners);
        assert_eq!(cut.len(), count, "{cut:?}");
        let normals: Vec<DVec3> =
            cut.iter().map(|t| newell(&t.map(|i| points[corners[i] as usize]))).collect();
        let whole = newell(points);
        assert!(normals.iter().all(|n| n.dot(whole) > 0.0), "{cut:?}");
        assert!((normals.iter().sum::<DVec3>() - whole).length() < 1e-9 * whole.length());
    }

    fn flat(points: &[[f64; 2]]) -> Vec<DVec3> {
        // A tilted plane away from the origin.
        points.iter().map(|[x, y]| DVec3::new(100.0 + x, 50.0 + y, 2.0 * x - y)).collect()
    }

    #[test]
    fn keeps_area_and_orientation() {
        let square = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
        let dart = [[0.0, 0.0], [4.0, 0.0], [1.0, 1.0], [0.0, 4.0]];
        let with_straight_corner = [[0.0, 0.0], [1.0, 0.0], [2.0, 0.0], [0.0, 2.0]];
        let ell = [[0.0, 0.0], [3.0, 0.0], [3.0, 1.0], [1.0, 1.0], [1.0, 3.0], [0.0, 3.0]];
        for (polygon, count) in [(&square[..], 2), (&dart, 2), (&with_straight_corner, 2), (&ell, 4)] {
            for shift in 0..polygon.len() {
                let mut points = flat(polygon);
                points.rotate_left(shift);
                assert_covers(&points, count);
                points.reverse();
                assert_covers(&points, count);
            }
        }
    }

    #[test]
    fn cuts_many_corners() {
        let star = |i: i32| {
            let radius = if i % 2 == 0 { 1.0 } else { 0.3 };
            let angle = f64::from(i) * std::f64::consts::TAU / 500.0;
            [radius * angle.cos(), radius * angle.sin()]
        };
        assert_covers(&flat(&(0..500).map(star).collect::<Vec<_>>()), 498);
    }

    #[test]
    fn cuts_the_shorter_diagonal() {
        let kite = flat(&[[0.0, 0.0], [5.0, -1.0], [10.0, 0.0], [5.0, 1.0]]);
        assert_eq!(triangles(&kite, &[0, 1, 2, 3]), [[1, 2, 3], [1, 3, 0]]);
    }

    /// Its projection crosses itself, and no diagonal lies inside.
    #[test]
    fn warped_quads_have_two_triangles() {
        let points = [
            DVec3::new(1.2346, 0.4938, -0.1094),
            DVec3::new(1.3580, 0.4938, 0.2246),
            DVec3::new(1.3580, 0.6173, -0.2614),
            DVec3::new(1.2346, 0.6173, 0.1349),
        ];
        assert_eq!(triangles(&points, &[0, 1, 2, 3]).len(), 2);
    }

    #[test]
    fn degenerate_ones_give_nothing() {
        let line = flat(&[[0.0, 0.0], [1.0, 1.0], [2.0, 2.0], [3.0, 3.0]]);
        for corners in [&[][..], &[0], &[0, 1], &[0, 1, 2, 3], &[1, 1, 1, 1], &[0, 1, 2, 99]] {
            assert!(triangles(&line, corners).is_empty(), "{corners:?}");
        }
        let wild = [DVec3::splat(f64::NAN), DVec3::splat(1e308), DVec3::splat(-1e308), DVec3::X];
        assert!(triangles(&wild, &[0, 1, 2, 3]).is_empty());
        assert!(triangles(&wild, &[1, 2, 3, 2]).is_empty());
        let corner = flat(&[[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]]);
        assert_eq!(triangles(&corner, &[0, 1, 1, 2, 0]), [[0, 1, 3]]);
    }
}
