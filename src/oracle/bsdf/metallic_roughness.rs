//! Model `metallic-roughness` (glTF 2.0, Appendix B): facets that follow GGX over a diffuse body, with the light that
//! comes back between facets (Turquin 2019). Twin of `glsl/shared/bsdf/metallic_roughness.glsl`.

use std::f64::consts::PI;

use glam::{DVec2, DVec3};

use super::facets::smith;
use crate::oracle::material_maps::Appearance;
use crate::pack::PackedScene;
use crate::schema::constants::FACET_TABLE_SIDE;

/// Below, highlights of points would be narrower than f32 resolves.
pub const LEAST_ROUGHNESS: f64 = 0.03;

/// What facets reflect of light from a direction: all of it at a reflectance of 1, and the part of Schlick's term.
pub fn facet_share(scene: &PackedScene, cosine: f64, roughness: f64) -> DVec2 {
    let last = FACET_TABLE_SIDE - 1;
    let [x, y] = [cosine.sqrt(), roughness].map(|part| part * f64::from(last));
    let [column, row] = [x, y].map(|place| (place as u32).min(last - 1));
    let entry = |column: u32, row: u32| {
        let at = row * FACET_TABLE_SIDE + column;
        let four = scene.records.facet_parts[at as usize / 2].values.as_dvec4();
        if at & 1 == 0 { DVec2::new(four.x, four.y) } else { DVec2::new(four.z, four.w) }
    };
    let along = |row| entry(column, row).lerp(entry(column + 1, row), x - f64::from(column));
    along(row).lerp(along(row + 1), y - f64::from(row))
}

/// A material of this model, as seen from one side. Both reflectances hold what comes back between facets.
#[derive(Clone, Copy, Debug)]
pub struct MetallicRoughness {
    /// Albedo of the body.
    pub diffuse: DVec3,
    /// Reflectance of facets that are seen head-on.
    pub head_on: DVec3,
    /// And at grazing angles.
    pub grazing: DVec3,
    pub alpha: f64,
    /// Share of a sample's bounces that facets have.
    pub bounced: f64,
    /// Share of light that passes the body.
    pub transmitted: DVec3,
    /// Share of a sample's rays that do: without those of the diffuse lobe, and with them.
    pub passing: [f64; 2],
}

/// Rec. 709 luminance.
pub fn luminance(color: DVec3) -> f64 {
    color.dot(DVec3::new(0.2126, 0.7152, 0.0722))
}

/// Returns the lobes of a material that looks like this, seen under the angle of this cosine.
pub fn metallic_roughness(scene: &PackedScene, look: &Appearance, cosine: f64) -> MetallicRoughness {
    let Appearance { color, metallic, roughness, dielectric, edge, transmission, .. } = *look;
    let rough = roughness.clamp(LEAST_ROUGHNESS, 1.0);
    let share = facet_share(scene, cosine.clamp(0.0, 1.0), rough);
    let lost = (1.0 - share.x) / share.x;
    let body_gain = 1.0 + dielectric * lost;
    let metal_gain = 1.0 + color * lost;
    let body = (dielectric * (share.x - share.y) + edge * share.y) * body_gain;
    let entering = color * (1.0 - metallic) * (1.0 - body).max(DVec3::ZERO);
    let transmitted = entering * transmission;
    let diffuse = entering - transmitted;
    let head_on = (dielectric * body_gain).lerp(color * metal_gain, metallic);
    let grazing = (edge * body_gain).lerp(metal_gain, metallic);
    let bounced = luminance(head_on * (share.x - share.y) + grazing * share.y);
    let passed = luminance(transmitted);
    let passing = [0.0, luminance(diffuse)]
        .map(|rest| if passed > 0.0 { passed / (bounced + rest + passed) } else { 0.0 });
    let all = bounced + luminance(diffuse);
    let bounced = if all > 0.0 { bounced / all } else { 1.0 };
    MetallicRoughness { diffuse, head_on, grazing, alpha: rough * rough, bounced, transmitted, passing }
}

/// Density of facets around the half vector, over π (Walter et al. 2007), by the cross product.
pub fn facet_density(n: DVec3, half_way: DVec3, alpha: f64) -> f64 {
    let cosine = n.dot(half_way);
    let root = alpha / (n.cross(half_way).length_squared() + alpha * alpha * cosine * cosine);
    if cosine > 0.0 { root * root } else { 0.0 }
}

/// (1 - cos)^5.
pub fn schlick(cosine: f64) -> f64 {
    (1.0 - cosine).max(0.0).powi(5)
}

/// The lobes of facets over 1/π: that of the reflectance head-on, and that of the one at grazing angles.
pub fn facet_lobes(n: DVec3, direction: DVec3, way: DVec3, alpha: f64) -> DVec2 {
    let (view, light) = (-direction.normalize(), way.normalize());
    let half_way = (view + light).normalize_or_zero();
    let seen = n.dot(view).max(1e-4);
    let lit = n.dot(light).max(0.0);
    let masked = lit * smith(seen, alpha) + seen * smith(lit, alpha);
    let lobe = 0.5 * facet_density(n, half_way, alpha) / masked.max(1e-30);
    let rise = schlick(view.dot(half_way));
    DVec2::new(lobe * (1.0 - rise), lobe * rise)
}

/// Density over solid angle with which `visible_normal` mirrors a view that way.
pub fn mirrored_density(n: DVec3, direction: DVec3, way: DVec3, alpha: f64) -> f64 {
    let view = -direction.normalize();
    let half_way = (view + way.normalize()).normalize_or_zero();
    let seen = n.dot(view).max(1e-4);
    facet_density(n, half_way, alpha) * (0.5 / PI) / (seen + smith(seen, alpha))
}
