//! What a scene, its packing and its messages know of reflection models, whose table is `src/schema/models.rs`; and the
//! keys of `[[material]]` that only some of them have.

use glam::DVec3;

use super::limits::{COLOR, EXPONENT, IOR, Limits, UNIT};
use super::material::{Material, TextureUse};
use super::refusal::{Check, Key};
pub use crate::schema::models::Model;

impl Model {
    /// The model that shows its colour unshaded: for environments, and textures by themselves.
    pub const PLAIN: Model = Model::Unlit;

    /// The model of diffuse light and a highlight: for files that know no other.
    pub const HIGHLIGHTED: Model = Model::Phong;

    /// The model of metals and of bodies under a dielectric surface, as files of physically based materials have it.
    pub const PHYSICAL: Model = Model::MetallicRoughness;

    /// The model of glass.
    pub const GLASS: Model = Model::Dielectric;

    /// Returns true if it emits light.
    pub fn emits(self) -> bool {
        self.is("emits")
    }

    /// Returns true if it reflects the light of lights.
    pub fn is_lit(self) -> bool {
        self.is("lit")
    }

    /// Returns true if it reflects or refracts rays.
    pub fn is_specular(self) -> bool {
        self.is("specular")
    }

    /// Returns true if beside the light of lights it reflects rays.
    pub fn is_glossy(self) -> bool {
        self.is("glossy")
    }

    /// Returns true if it reflects rays and transmits none.
    pub fn is_mirror(self) -> bool {
        self.is_specular() && !self.transmits()
    }

    /// Returns true if it transmits rays.
    pub fn transmits(self) -> bool {
        self.is("transmits")
    }
}

/// A key of `[[material]]` that only some models have.
pub(super) struct ModelKey {
    pub name: &'static str,
    pub value: Value,
    limits: Limits,
}

/// The field of a material that holds it.
pub(super) enum Value {
    Number(fn(&mut Material) -> &mut f64),
    Color(fn(&mut Material) -> &mut DVec3),
    Map(fn(&mut Material) -> &mut Option<TextureUse>),
}

pub(super) const KEYS: [ModelKey; 12] = [
    ModelKey { name: "specular", value: Value::Color(|m| &mut m.specular), limits: COLOR },
    ModelKey { name: "exponent", value: Value::Number(|m| &mut m.exponent), limits: EXPONENT },
    ModelKey { name: "ior", value: Value::Number(|m| &mut m.ior), limits: IOR },
    ModelKey { name: "roughness", value: Value::Number(|m| &mut m.roughness), limits: UNIT },
    ModelKey { name: "metallic", value: Value::Number(|m| &mut m.metallic), limits: UNIT },
    ModelKey {
        name: "metallic_roughness_map",
        value: Value::Map(|m| &mut m.metallic_roughness_map),
        limits: UNIT,
    },
    ModelKey { name: "specular_weight", value: Value::Number(|m| &mut m.specular_weight), limits: UNIT },
    ModelKey { name: "specular_weight_map", value: Value::Map(|m| &mut m.specular_weight_map), limits: UNIT },
    ModelKey { name: "specular_tint", value: Value::Color(|m| &mut m.specular_tint), limits: COLOR },
    ModelKey { name: "specular_tint_map", value: Value::Map(|m| &mut m.specular_tint_map), limits: UNIT },
    ModelKey { name: "transmission", value: Value::Number(|m| &mut m.transmission), limits: UNIT },
    ModelKey {
        name: "transmission_texture",
        value: Value::Map(|m| &mut m.transmission_texture),
        limits: UNIT,
    },
];

/// Checks the fields that the material's model uses.
pub(super) fn check_model_keys(key: Key, material: &Material) -> Check {
    let (model, mut material) = (material.model, material.clone());
    KEYS.iter().filter(|k| model.has_key(k.name)).try_for_each(|k| match k.value {
        Value::Number(of) => key.of(k.name).number(*of(&mut material), &k.limits),
        Value::Color(of) => key.of(k.name).vector(*of(&mut material), &k.limits),
        Value::Map(_) => Ok(()),
    })
}
