//! Matrices of nodes and copies. Input: a node's matrix or its translation, rotation and scale, or accessors with many
//! of the latter. Output: affine maps from the node to its parent, or from each copy to the node.

use glam::{DAffine3, DMat4, DQuat, DVec3, DVec4};

use super::accessor::Accessors;
use super::attribute::Use;
use super::json::Json;
use crate::mesh::Fault;

/// The squared length under which a rotation is none. Rounded to 8 bits, one still has nearly 1.
const LEAST_ROTATION: f64 = 1e-12;

/// Reads the matrix from a node to its parent.
pub(super) fn local(json: Json) -> Result<DAffine3, Fault> {
    let translation = json.numbers("translation")?;
    let rotation = json.numbers("rotation")?;
    let scale = json.numbers("scale")?;
    let Some(columns) = json.numbers::<16>("matrix")? else {
        let rotation = rotation.map(DVec4::from_array).unwrap_or(DVec4::W);
        let rotation = quaternion(rotation).ok_or_else(|| json.fault_at("rotation", "it has no length"))?;
        return Ok(DAffine3::from_scale_rotation_translation(
            scale.unwrap_or([1.0; 3]).into(),
            rotation,
            translation.unwrap_or_default().into(),
        ));
    };
    if translation.is_some() || rotation.is_some() || scale.is_some() {
        return Err(json.fault_at("matrix", "a node has either a matrix or translation, rotation and scale"));
    }
    let matrix = DMat4::from_cols_array(&columns);
    if !matrix.row(3).abs_diff_eq(DVec4::W, 1e-6) {
        return Err(
            json.fault_at("matrix", format!("its last row is {}; [0, 0, 0, 1] is needed", matrix.row(3)))
        );
    }
    Ok(DAffine3::from_mat4(matrix))
}

/// Accessors that say where the copies of a node's mesh are (EXT_mesh_gpu_instancing).
#[derive(Clone, Copy)]
pub(super) struct Copies {
    translation: Option<usize>,
    rotation: Option<usize>,
    scale: Option<usize>,
    /// One of the three.
    any: usize,
}

impl Copies {
    /// Reads which accessors a node names, or nothing if it has a single copy.
    pub(super) fn read(json: Json, accessors: usize) -> Result<Option<Copies>, Fault> {
        let Some(extension) = json.extension("EXT_mesh_gpu_instancing")? else {
            return Ok(None);
        };
        let attributes = extension.needed("attributes", extension.object("attributes")?)?;
        let attribute = |key| attributes.index(key, accessors, "accessors");
        let (translation, rotation, scale) =
            (attribute("TRANSLATION")?, attribute("ROTATION")?, attribute("SCALE")?);
        // Attributes of applications alone do not move anything; then the copies coincide.
        Ok(translation.or(rotation).or(scale).map(|any| Copies { translation, rotation, scale, any }))
    }

    /// Returns the number of copies.
    pub(super) fn count(self, accessors: &mut Accessors) -> Result<usize, Fault> {
        Ok(accessors.open(self.any)?.count)
    }

    /// Reads the matrix from each copy to the node.
    pub(super) fn matrices(self, accessors: &mut Accessors) -> Result<Vec<DAffine3>, Fault> {
        let count = self.count(accessors)?;
        let mut open = |used: Use, index: Option<usize>| {
            index.map(|index| used.open(accessors, index, count)).transpose()
        };
        let translations = open(Use::TRANSLATION, self.translation)?;
        let rotations = open(Use::ROTATION, self.rotation)?;
        let scales = open(Use::SCALE, self.scale)?;
        let matrix = |i| {
            let translation = translations.as_ref().map_or(Ok([0.0; 3]), |all| all.numbers(i))?;
            let scale = scales.as_ref().map_or(Ok([1.0; 3]), |all| all.numbers(i))?;
            let rotation = match &rotations {
                Some(all) => quaternion(DVec4::from_array(all.numbers(i)?))
                    .ok_or_else(|| all.fault("", format!("element {i}, a rotation, has no length")))?,
                None => DQuat::IDENTITY,
            };
            let (scale, translation) = (DVec3::from_array(scale), DVec3::from_array(translation));
            Ok(DAffine3::from_scale_rotation_translation(scale, rotation, translation))
        };
        (0..count).map(matrix).collect()
    }
}

/// Returns a rotation of length 1, or nothing if it has none.
fn quaternion(xyzw: DVec4) -> Option<DQuat> {
    let most = xyzw.abs().max_element();
    // Divided first, as squares may overflow.
    (most * most > LEAST_ROTATION).then(|| DQuat::from_vec4((xyzw / most).normalize()))
}
