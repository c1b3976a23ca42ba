//! The interface to the reflection models: emitted and reflected radiance, whether a material is specular, and whether
//! beams know the integral over a region. Twin of `glsl/shared/bsdf/models.glsl`.

pub mod dielectric;
pub mod facets;
pub mod lambert;
pub mod metallic_roughness;
pub mod mirror;
pub mod oren_nayar;
pub mod phong;
pub mod scattering;
pub mod specular;
pub mod unlit;

use glam::DVec3;

use super::material_maps::Appearance;
use crate::pack::PackedScene;
use crate::scene::model::Model;
use crate::schema::enums::AlphaMode;
use crate::schema::layout::Material;
use lambert::lambert_lobes;
use metallic_roughness::{MetallicRoughness, facet_lobes, metallic_roughness};
use mirror::mirrored;
use oren_nayar::{oren_nayar_lobes, scattered_albedo};
use phong::{phong_lobes, with_highlight};
use unlit::unlit_emitted;

/// A material at a hit: the parameters of its lobes, without the direction of the light.
#[derive(Clone, Copy, Debug)]
pub struct Bsdf<'a> {
    pub material: &'a Material,
    /// The material's colour, times its texture.
    pub albedo: DVec3,
    /// Unit, for shading.
    pub normal: DVec3,
    /// Direction of the ray.
    pub direction: DVec3,
    /// Its mirror reflection.
    pub mirror: DVec3,
    /// Of model `metallic-roughness`, and of rough mirrors.
    pub facets: Option<MetallicRoughness>,
}

/// Irradiance over π from all lights, weighted by the lobes: the one that the albedo colours, and those of colours of
/// their own.
#[derive(Clone, Copy, Debug, Default)]
pub struct Lit {
    pub first: DVec3,
    pub second: DVec3,
    pub third: DVec3,
}

/// Returns whether a material sends rays on, and nothing else.
pub fn is_specular(model: Model) -> bool {
    model.is_specular()
}

/// Returns whether it is a mirror of facets.
pub fn is_rough_mirror(material: &Material) -> bool {
    material.model.is_mirror() && material.alpha > 0.0
}

/// Returns whether a material reflects light.
pub fn is_lit(model: Model) -> bool {
    model.is_lit()
}

/// Returns whether a model beside the light of lights reflects rays.
pub fn is_glossy(model: Model) -> bool {
    model.is_glossy()
}

/// Returns whether the second lobe of a model is diffuse, as the first one.
pub fn is_both_diffuse(model: Model) -> bool {
    model == Model::OrenNayar
}

/// Returns whether no light passes a material or comes from it that its model does not know of.
pub fn is_plain(material: &Material) -> bool {
    let opaque = material.alpha_mode == AlphaMode::Opaque && !material.one_sided;
    opaque && material.emission == glam::Vec3::ZERO
}

/// Returns the radiance that a material emits by itself, where its colour times what the path carries is `color`.
pub fn emitted(model: Model, color: DVec3) -> DVec3 {
    if model == Model::Unlit { unlit_emitted(color) } else { DVec3::ZERO }
}

pub fn bsdf_at<'a>(
    scene: &PackedScene,
    material: &'a Material,
    look: &Appearance,
    normal: DVec3,
    direction: DVec3,
) -> Bsdf<'a> {
    let cosine = -normal.dot(direction) / direction.length();
    let mirror = is_rough_mirror(material).then(|| MetallicRoughness {
        diffuse: DVec3::ZERO,
        head_on: look.color,
        grazing: look.color,
        alpha: material.alpha.into(),
        bounced: 1.0,
        transmitted: DVec3::ZERO,
        passing: [0.0; 2],
    });
    let facets = is_glossy(material.model).then(|| metallic_roughness(scene, look, cosine));
    let facets = facets.or(mirror);
    Bsdf { material, albedo: look.color, normal, direction, mirror: mirrored(direction, normal), facets }
}

/// Returns the lobes over 1/π, for light from `way`, which need not be a unit vector.
pub fn evaluate(bsdf: &Bsdf<'_>, way: DVec3) -> DVec3 {
    if let Some(facets) = &bsdf.facets {
        let lobes = facet_lobes(bsdf.normal, bsdf.direction, way, facets.alpha);
        return match is_glossy(bsdf.material.model) {
            true => DVec3::new(1.0, lobes.x, lobes.y),
            false => DVec3::new(0.0, lobes.x + lobes.y, 0.0),
        };
    }
    let [first, second] = match bsdf.material.model {
        Model::Phong => phong_lobes(bsdf.mirror, way, bsdf.material.exponent.into()),
        Model::OrenNayar => {
            oren_nayar_lobes(bsdf.normal, bsdf.direction, way, f64::from(bsdf.material.alpha).sqrt())
        }
        _ => lambert_lobes(),
    };
    DVec3::new(first, second, 0.0)
}

/// Returns the radiance that a lit material reflects to the eye; `color` is the albedo times what the path carries.
pub fn reflected(bsdf: &Bsdf<'_>, color: DVec3, carried: DVec3, lit: Lit) -> DVec3 {
    if is_rough_mirror(bsdf.material) {
        return color * lit.second;
    }
    if let Some(facets) = &bsdf.facets {
        let mirrored = facets.head_on * lit.second + facets.grazing * lit.third;
        return carried * (facets.diffuse * lit.first + mirrored);
    }
    let seen = color * lit.first;
    match bsdf.material.model {
        Model::Phong => with_highlight(seen, carried, bsdf.material.specular.as_dvec3(), lit.second),
        Model::OrenNayar => {
            let color = scattered_albedo(bsdf.albedo, f64::from(bsdf.material.alpha).sqrt());
            seen + carried * color * lit.second
        }
        _ => seen,
    }
}

/// Returns true if beams know the integral over a region of a flat shape, without a texture; `smooth_normals`: of a
/// shape whose shading normals differ from place to place.
pub fn is_integrable_over_region(material: &Material, smooth_normals: bool) -> bool {
    match material.model {
        _ if !is_plain(material) => false,
        Model::Unlit => true,
        Model::Lambert => !smooth_normals,
        Model::Mirror => !smooth_normals && material.alpha <= 0.0,
        _ => false,
    }
}
