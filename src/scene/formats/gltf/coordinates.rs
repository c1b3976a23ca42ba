//! The coordinates at which a glTF material reads its textures. Input: its textures with their sets and transforms. Output:
//! those of the first texture, transformed once for all; those of the others likewise if they agree, or else the sets as
//! the file has them, of which each texture has its own transform.

use glam::{DAffine2, DMat2, DVec2};
use rayon::prelude::*;

use super::AT_ONCE;
use crate::mesh::Mesh;
use crate::mesh::gltf::{Material, Primitive, TextureRef};
use crate::scene::model::OwnUv;

/// The coordinates at which a material reads its textures.
#[derive(Clone, Debug, Default)]
pub(super) struct CoordinateSets<'a> {
    first: Option<&'a TextureRef>,
    second: Option<&'a TextureRef>,
    /// Sets that the textures beside the first read, where their coordinates differ.
    others: Vec<usize>,
}

impl CoordinateSets<'_> {
    pub fn of(material: &Material) -> CoordinateSets<'_> {
        let read = [
            &material.base_color_texture,
            &material.normal_texture,
            &material.metallic_roughness_texture,
            &material.emissive_texture,
            &material.occlusion_texture,
            &material.specular_texture,
            &material.specular_color_texture,
            &material.transmission_texture,
        ];
        let mut read = read.into_iter().flatten();
        let Some(first) = read.next() else { return CoordinateSets::default() };
        let mut differing: Vec<&TextureRef> = Vec::new();
        for other in read.filter(|other| !is_alike(first, other)) {
            if !differing.iter().any(|known| is_alike(known, other)) {
                differing.push(other);
            }
        }
        if let [] | [_] = differing[..] {
            return CoordinateSets { first: Some(first), second: differing.pop(), others: Vec::new() };
        }
        let mut others: Vec<usize> = differing.into_iter().map(|other| other.uv_set).collect();
        others.sort_unstable();
        others.dedup();
        CoordinateSets { first: Some(first), second: None, others }
    }

    /// Returns whether a texture is read at the second coordinates.
    pub fn is_second(&self, reference: &TextureRef) -> bool {
        self.second.is_some_and(|second| is_alike(second, reference))
    }

    /// Returns the coordinates that a texture has for itself, if it has.
    pub fn own(&self, reference: &TextureRef) -> Option<OwnUv> {
        if self.first.is_some_and(|first| is_alike(first, reference)) {
            return None;
        }
        let set = self.others.iter().position(|set| *set == reference.uv_set)?;
        Some(OwnUv { set, transform: transform(Some(reference)) })
    }

    /// Appends the coordinates of a primitive's corners, v upwards as meshes have it.
    pub fn append(&self, mesh: &mut Mesh, primitive: &Primitive) {
        let raw = |set: usize| coordinates(primitive, set, DAffine2::IDENTITY);
        let of = |reference: Option<&TextureRef>| {
            coordinates(primitive, reference.map_or(0, |found| found.uv_set), transform(reference))
        };
        mesh.uvs.par_extend(of(self.first));
        if self.second.is_some() {
            mesh.second_uvs.par_extend(of(self.second));
        }
        if let Some((second, more)) = self.others.split_first() {
            mesh.second_uvs.par_extend(raw(*second));
            mesh.more_uvs.resize_with(more.len(), Vec::new);
            mesh.more_uvs.iter_mut().zip(more).for_each(|(uvs, set)| uvs.par_extend(raw(*set)));
        }
    }

    /// Returns how a normal map is read, for the tangents along its coordinates.
    pub fn along(&self, normal: &TextureRef) -> Along {
        match self.own(normal) {
            Some(own) => Along::Own(own),
            None if self.is_second(normal) => Along::Second,
            None => Along::First,
        }
    }
}

/// Coordinates along which tangents run.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Along {
    First,
    Second,
    Own(OwnUv),
}

impl Along {
    /// Gives a mesh the tangents that it lacks.
    pub fn complete(self, mesh: &mut Mesh) {
        let Along::Own(own) = self else { return mesh.complete_tangents(self == Along::Second) };
        let set = match own.set.checked_sub(1) {
            None => &mesh.second_uvs,
            Some(more) => &mesh.more_uvs[more],
        };
        let moved = set.iter().map(|uv| flipped(own.transform.transform_point2(flipped(*uv)))).collect();
        let kept = std::mem::replace(&mut mesh.second_uvs, moved);
        mesh.complete_tangents(true);
        mesh.second_uvs = kept;
    }
}

impl PartialEq for CoordinateSets<'_> {
    fn eq(&self, other: &Self) -> bool {
        let read = |set: Option<&TextureRef>| set.map_or((0, None), |set| (set.uv_set, set.transform));
        let are = |sets: &Self| (read(sets.first), sets.second.map(|set| read(Some(set))));
        are(self) == are(other) && self.others == other.others
    }
}

/// Returns whether two textures are read at the same coordinates.
fn is_alike(a: &TextureRef, b: &TextureRef) -> bool {
    a.uv_set == b.uv_set && a.transform == b.transform
}

fn flipped(uv: DVec2) -> DVec2 {
    DVec2::new(uv.x, 1.0 - uv.y)
}

/// Returns the coordinates of a primitive's corners, v upwards; (0, 0) of the file where it lacks the set.
fn coordinates(
    primitive: &Primitive,
    set: usize,
    transform: DAffine2,
) -> impl IndexedParallelIterator<Item = DVec2> + use<'_> {
    let uvs = primitive.uvs.get(set).map_or(&[][..], Vec::as_slice);
    (0..primitive.positions.len())
        .into_par_iter()
        .with_min_len(AT_ONCE)
        .map(move |index| flipped(transform.transform_point2(uvs.get(index).copied().unwrap_or_default())))
}

/// Returns what KHR_texture_transform does to coordinates: scale, then a rotation that is clockwise in (u, v), then the
/// offset.
fn transform(reference: Option<&TextureRef>) -> DAffine2 {
    reference.and_then(|reference| reference.transform).map_or(DAffine2::IDENTITY, |t| DAffine2 {
        matrix2: DMat2::from_angle(-t.rotation) * DMat2::from_diagonal(t.scale),
        translation: t.offset,
    })
}
