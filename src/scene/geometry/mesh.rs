//! Many triangles of one material as one shape, through which rays find their way by a tree. Scene files name it by the
//! file that it is read from (`[[mesh]]`), not by keys.

use std::fmt;
use std::sync::Arc;

use glam::{DAffine3, DVec3};

use super::meshes::{CornerAttributes, Placed};
use super::{Bounds, Described, Fields, Shapes, Triangle};
use crate::core::error::Result;
use crate::mesh;
use crate::scene::limits::COORDINATE;
use crate::scene::model::{DEFAULT, Material};
use crate::scene::refusal::{Check, Key};

/// Triangles of a mesh file that have one material.
#[derive(Clone)]
pub struct Mesh {
    /// All that the file holds.
    pub(super) file: Arc<mesh::Mesh>,
    /// Which of its triangles.
    pub(super) triangles: Arc<[u32]>,
    /// From the file's own space to the world.
    pub(super) placement: DAffine3,
    /// Its box in the world.
    pub(super) bounds: Bounds,
    /// Index of its material.
    pub material: usize,
    /// Its displacement between the times 0 and 1.
    pub motion: DVec3,
}

/// Which attributes the corners of a mesh have.
#[derive(Clone, Copy, Debug)]
pub(crate) struct AttributeKinds {
    pub colors: bool,
    pub second_uvs: bool,
    pub tangents: bool,
}

impl Mesh {
    /// Returns these triangles of a file, of which there is one at least.
    pub(in crate::scene) fn new(file: Arc<mesh::Mesh>, triangles: Arc<[u32]>, placement: DAffine3) -> Mesh {
        let none = Bounds { min: DVec3::INFINITY, max: DVec3::NEG_INFINITY };
        let corners = triangles.iter().flat_map(|&index| file.triangles[index as usize].positions);
        let bounds = corners.fold(none, |bounds, corner| {
            let place = placement.transform_point3(file.positions[corner as usize]);
            Bounds { min: bounds.min.min(place), max: bounds.max.max(place) }
        });
        Mesh { file, triangles, placement, bounds, material: DEFAULT, motion: DVec3::ZERO }
    }

    /// Returns the number of its triangles.
    pub fn triangle_count(&self) -> usize {
        self.triangles.len()
    }

    /// Returns which attributes its corners have beside normals and texture coordinates.
    pub(crate) fn attribute_kinds(&self) -> AttributeKinds {
        AttributeKinds {
            colors: !self.file.colors.is_empty(),
            second_uvs: !self.file.second_uvs.is_empty(),
            tangents: !self.file.tangents.is_empty(),
        }
    }

    /// Calls `each` with its triangles in the world and what else their corners have, in the order of the file.
    pub(crate) fn for_each_with_attributes(&self, mut each: impl FnMut(Triangle, CornerAttributes)) {
        let placed = Placed::new(&self.file, &self.placement);
        for &index in self.triangles.iter() {
            let triangle = placed.triangle(index);
            each(
                Triangle { material: self.material, motion: self.motion, ..triangle },
                placed.attributes(index, &self.placement),
            );
        }
    }

    /// Calls `each` with every `step`-th of its triangles in the world, in the order of the file.
    pub fn for_each(&self, step: usize, mut each: impl FnMut(Triangle)) {
        let placed = Placed::new(&self.file, &self.placement);
        for &index in self.triangles.iter().step_by(step) {
            each(Triangle { material: self.material, motion: self.motion, ..placed.triangle(index) });
        }
    }
}

impl Shapes {
    /// Returns the number of triangles, those of meshes too.
    pub fn triangle_count(&self) -> usize {
        self.triangles.len() + self.meshes.iter().map(Mesh::triangle_count).sum::<usize>()
    }

    /// Calls `each` with every triangle in the world, those of meshes too.
    pub fn for_each_triangle(&self, mut each: impl FnMut(&Triangle)) {
        self.triangles.iter().for_each(&mut each);
        self.meshes.iter().for_each(|mesh| mesh.for_each(1, |triangle| each(&triangle)));
    }
}

/// A file may have millions of triangles.
impl fmt::Debug for Mesh {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Mesh of {} triangles in {:?}", self.triangles.len(), self.bounds)
    }
}

impl Described for Mesh {
    const KEYS: &[&str] = &[];

    fn read(fields: &dyn Fields, _material: usize) -> Result<Mesh> {
        Err(fields.missing("file"))
    }

    fn translate(&mut self, way: DVec3) {
        self.placement.translation += way;
        self.bounds = Bounds { min: self.bounds.min + way, max: self.bounds.max + way };
    }

    fn middle(&self) -> Option<DVec3> {
        Some(0.5 * (self.bounds.min + self.bounds.max))
    }

    fn extent(&self) -> Option<Bounds> {
        Some(self.bounds)
    }

    fn check(&self, key: Key, _material: &Material) -> Check {
        let [min, max] = [self.bounds.min, self.bounds.max];
        key.of("file").vector(min, &COORDINATE)?;
        key.of("file").vector(max, &COORDINATE)
    }
}
