//! What facets reflect, by the cosine of the view and the roughness: the table of model `metallic-roughness`. Entry
//! (column, row) is at the cosine (column/31)² and the roughness row/31: E, the light that facets of reflectance 1 send on
//! at their first bounce, and the part of it that Schlick's (1 - cos)^5 has. Both are means over facets that the view sees
//! (Heitz 2018) of G2 / G1.

use std::f64::consts::TAU;
use std::sync::LazyLock;

use glam::{DVec2, DVec3, Vec4};
use rayon::prelude::*;

use crate::schema::constants::FACET_TABLE_SIDE;
use crate::schema::layout::FacetPart;

/// Facets along both dimensions over which an entry is a mean.
const FACETS: [u32; 2] = [32, 48];
/// A view from exactly the side sees no facets.
const LEAST_COSINE: f64 = 1e-4;

/// Returns the table, two entries in each record.
pub fn facet_table() -> Vec<FacetPart> {
    static TABLE: LazyLock<Vec<FacetPart>> = LazyLock::new(|| {
        let side = FACET_TABLE_SIDE;
        let part = |i: u32| f64::from(i) / f64::from(side - 1);
        let entry = |i: u32| {
            let share = facet_share(part(i % side).powi(2), part(i / side), FACETS);
            share.as_vec2()
        };
        let pairs = (0..side * side / 2).into_par_iter().map(|pair| [entry(2 * pair), entry(2 * pair + 1)]);
        pairs.map(|[a, b]| FacetPart { values: Vec4::new(a.x, a.y, b.x, b.y) }).collect()
    });
    TABLE.clone()
}

/// Returns the light that facets of reflectance 1 send on, and the part of Schlick's term.
pub fn facet_share(cosine: f64, roughness: f64, facets: [u32; 2]) -> DVec2 {
    let alpha = roughness * roughness;
    let cosine = cosine.max(LEAST_COSINE);
    let view = DVec3::new((1.0 - cosine * cosine).sqrt(), 0.0, cosine);
    let mut sum = DVec2::ZERO;
    for i in 0..facets[0] * facets[1] {
        let place = |k: u32, count: u32| (f64::from(k) + 0.5) / f64::from(count);
        // Steep facets, which lose light, are few and close together.
        let step = place(i / facets[0], facets[1]);
        let facet = visible_normal(view, alpha, place(i % facets[0], facets[0]), step * step);
        let way = 2.0 * view.dot(facet) * facet - view;
        if way.z > 0.0 {
            let passes = 2.0 * step * g2_over_g1(view.z, way.z, alpha);
            sum += passes * DVec2::new(1.0, (1.0 - view.dot(facet)).max(0.0).powi(5));
        }
    }
    sum / f64::from(facets[0] * facets[1])
}

/// Returns the normal of a facet that a view sees (Dupuy & Benyoub 2023).
/// `rest`: 1 - the height on the cap.
fn visible_normal(view: DVec3, alpha: f64, turn: f64, rest: f64) -> DVec3 {
    let stretched = DVec3::new(alpha * view.x, alpha * view.y, view.z).normalize();
    let above = rest * (1.0 + stretched.z);
    let z = above - stretched.z;
    let across = (1.0 - z * z).max(0.0).sqrt();
    let (sine, cosine) = (TAU * turn).sin_cos();
    let half_way = DVec3::new(across * cosine, across * sine, z) + stretched;
    DVec3::new(alpha * half_way.x, alpha * half_way.y, above).normalize_or(DVec3::Z)
}

/// Returns G2 / G1 of Smith, heights correlated (Heitz 2014).
fn g2_over_g1(seen: f64, leaving: f64, alpha: f64) -> f64 {
    let smith = |cosine: f64| (cosine * cosine + alpha * alpha * (1.0 - cosine * cosine)).sqrt();
    leaving * (seen + smith(seen)) / (smith(seen) * leaving + smith(leaving) * seen)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns an entry between those of the table, as shaders read it.
    fn interpolated(table: &[FacetPart], cosine: f64, roughness: f64) -> DVec2 {
        let last = FACET_TABLE_SIDE - 1;
        let [x, y] = [cosine.sqrt(), roughness].map(|part| part * f64::from(last));
        let [column, row] = [x, y].map(|place| (place as u32).min(last - 1));
        let entry = |column: u32, row: u32| {
            let at = (row * FACET_TABLE_SIDE + column) as usize;
            let four = table[at / 2].values.to_array().map(f64::from);
            DVec2::new(four[2 * (at % 2)], four[2 * (at % 2) + 1])
        };
        let along = |row| entry(column, row).lerp(entry(column + 1, row), x - f64::from(column));
        along(row).lerp(along(row + 1), y - f64::from(row))
    }

    #[test]
    fn between_entries_the_table_is_within_half_a_percent_but_for_grazing_views() {
        let table = facet_table();
        let mut worst = (0.0, 0.0, 0.0);
        for i in 0..40 {
            for k in 0..40 {
                let cosine = (f64::from(i) + 0.37) / 40.0;
                let roughness = 0.03 + 0.97 * (f64::from(k) + 0.61) / 40.0;
                let exact = facet_share(cosine, roughness, [60, 120]);
                let error = (interpolated(&table, cosine, roughness) - exact).abs().max_element();
                // The share of smooth facets is steep there.
                let error = if cosine < 0.05 { 0.4 * error } else { error };
                if error > worst.0 {
                    worst = (error, cosine, roughness);
                }
            }
        }
        assert!(worst.0 < 5e-3, "{worst:?}");
    }

    #[test]
    fn smooth_facets_reflect_all_light_and_rough_ones_lose_some() {
        let smooth = facet_share(0.7, 0.0, FACETS);
        assert!((smooth.x - 1.0).abs() < 1e-9 && (smooth.y - 0.3f64.powi(5)).abs() < 1e-9, "{smooth}");
        // By 240 000 facets: 0.378888.
        let rough = facet_share(0.7, 1.0, FACETS);
        assert!((rough.x - 0.378_888).abs() < 5e-4, "{rough}");
    }
}
