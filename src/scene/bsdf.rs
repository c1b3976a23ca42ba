//! The reflection models: their names, their behaviour, and the keys of `[[material]]` that only some of them have.
//! Everything that a scene, its packing and its messages know about a model is in these tables.

use glam::DVec3;

use super::limits::{COLOR, EXPONENT, IOR, Limits, UNIT};
use super::model::Material;
use super::refusal::{Check, Key};
pub use crate::schema::enums::Model;

impl Model {
    /// The model that shows its colour unshaded: for environments, and textures by themselves.
    pub const PLAIN: Model = Model::Unlit;

    /// Returns true if it emits light.
    pub const fn emits(self) -> bool {
        matches!(self, Model::Unlit)
    }

    /// Returns true if it reflects the light of lights.
    pub const fn is_lit(self) -> bool {
        matches!(self, Model::Lambert | Model::Phong | Model::OrenNayar)
    }

    /// Returns true if it reflects or refracts rays.
    pub const fn is_specular(self) -> bool {
        matches!(self, Model::Mirror | Model::Dielectric)
    }

    /// Returns true if it transmits rays.
    pub const fn transmits(self) -> bool {
        matches!(self, Model::Dielectric)
    }
}

/// A key of `[[material]]` that only some models have.
pub(super) struct ModelKey {
    pub name: &'static str,
    pub models: &'static [Model],
    pub value: Value,
    limits: Limits,
}

/// The field of a material that holds it.
pub(super) enum Value {
    Number(fn(&mut Material) -> &mut f64),
    Color(fn(&mut Material) -> &mut DVec3),
}

pub(super) const KEYS: [ModelKey; 4] = [
    ModelKey {
        name: "specular",
        models: &[Model::Phong],
        value: Value::Color(|m| &mut m.specular),
        limits: COLOR,
    },
    ModelKey {
        name: "exponent",
        models: &[Model::Phong],
        value: Value::Number(|m| &mut m.exponent),
        limits: EXPONENT,
    },
    ModelKey { name: "ior", models: &[Model::Dielectric], value: Value::Number(|m| &mut m.ior), limits: IOR },
    ModelKey {
        name: "roughness",
        models: &[Model::Mirror, Model::Dielectric, Model::OrenNayar],
        value: Value::Number(|m| &mut m.roughness),
        limits: UNIT,
    },
];

/// Checks the fields that the material's model uses.
pub(super) fn check_model_keys(key: Key, material: &Material) -> Check {
    let (model, mut material) = (material.model, material.clone());
    KEYS.iter().filter(|k| k.models.contains(&model)).try_for_each(|k| match k.value {
        Value::Number(of) => key.of(k.name).number(*of(&mut material), &k.limits),
        Value::Color(of) => key.of(k.name).vector(*of(&mut material), &k.limits),
    })
}
