//! The reflection models: their names, what each one does with light, and the keys of `[[material]]` that not all of
//! them have. All that a scene, its packing and its messages know of a model stands in these tables.

use super::model::Material;
use super::reader::{COLOR, EXPONENT, Field, IOR, UNIT};
use super::table::Table;
use crate::core::error::Result;
pub use crate::schema::enums::Model;

impl Model {
    /// Shows its colour as it is: an environment, a texture that is looked at.
    pub const PLAIN: Model = Model::Unlit;

    /// Whether it shines by itself.
    pub const fn emits(self) -> bool {
        matches!(self, Model::Unlit)
    }

    /// Whether lights shine on it.
    pub const fn is_lit(self) -> bool {
        matches!(self, Model::Lambert | Model::Phong)
    }

    /// Whether rays go on from it.
    pub const fn is_specular(self) -> bool {
        matches!(self, Model::Mirror | Model::Dielectric)
    }

    /// Whether rays go on through it, too.
    pub const fn transmits(self) -> bool {
        matches!(self, Model::Dielectric)
    }
}

type Reader = fn(&mut Material, Field<'_>) -> Result<()>;

/// Key, the models that have it, how it is read.
const KEYS: [(&str, &[Model], Reader); 4] = [
    ("specular", &[Model::Phong], |m, field| Ok(m.specular = field.vec3(&COLOR)?)),
    ("exponent", &[Model::Phong], |m, field| Ok(m.exponent = field.number(&EXPONENT)?)),
    ("ior", &[Model::Dielectric], |m, field| Ok(m.ior = field.number(&IOR)?)),
    ("roughness", &[Model::Mirror, Model::Dielectric], |m, field| Ok(m.roughness = field.number(&UNIT)?)),
];

/// Reads the keys of the material's model.
pub(super) fn read_model_keys(table: &Table<'_>, material: &mut Material) -> Result<()> {
    for (key, models, read) in KEYS {
        let Some(field) = table.get(key) else { continue };
        if !models.contains(&material.model) {
            let quoted =
                |between| models.iter().map(|m| format!("\"{m}\"")).collect::<Vec<_>>().join(between);
            let (noun, verb) = if models.len() > 1 { ("models", "have") } else { ("model", "has") };
            let what =
                format!("only {noun} {} {verb} {key}; this one is \"{}\"", quoted(" and "), material.model);
            return Err(field.error(&what, format!("needs model {}", quoted(" or "))));
        }
        read(material, field)?;
    }
    Ok(())
}
