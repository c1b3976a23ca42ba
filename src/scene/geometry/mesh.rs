//! Many triangles of one material as one shape, through which rays find their way by a tree. Scene files name it by the
//! file that it is read from (`[[mesh]]`), not by keys.

use std::fmt;
use std::sync::Arc;

use glam::{DAffine3, DVec2, DVec3};
use rayon::prelude::*;

use super::meshes::{CornerAttributes, Placed};
use super::{Bounds, Described, Facets, Fields, Shapes, Triangle};
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
    /// Other meshes have the same triangles elsewhere.
    pub(super) is_shared: bool,
    /// Index of its material.
    pub material: usize,
    /// Its displacement between the times 0 and 1.
    pub motion: DVec3,
}

/// Which attributes the corners of a mesh have.
#[derive(Clone, Copy, Debug)]
pub(crate) struct AttributeKinds {
    pub colors: bool,
    /// Sets of texture coordinates beyond the first.
    pub further_uvs: usize,
    pub tangents: bool,
}

impl Mesh {
    /// Returns these triangles of a file, of which there is one at least; `corners`: the positions that they use.
    pub(in crate::scene) fn new(
        file: Arc<mesh::Mesh>,
        triangles: Arc<[u32]>,
        corners: &[u32],
        placement: DAffine3,
        is_shared: bool,
    ) -> Mesh {
        let bounds = bounds_of(&file, corners, &placement);
        Mesh { file, triangles, placement, bounds, is_shared, material: DEFAULT, motion: DVec3::ZERO }
    }

    /// Returns true if devices store its triangles in a space of their own.
    pub(crate) fn is_shared(&self) -> bool {
        self.is_shared
    }

    /// Returns true if both are of one file, some of whose triangles devices store once, with a matrix for each.
    pub(crate) fn is_beside(&self, other: &Mesh) -> bool {
        self.is_shared && other.is_shared && Arc::ptr_eq(&self.file, &other.file)
    }

    /// Returns true if these are the same triangles with the same fronts.
    pub(crate) fn shares_with(&self, other: &Mesh) -> bool {
        Arc::ptr_eq(&self.triangles, &other.triangles) && self.mirrors() == other.mirrors()
    }

    fn mirrors(&self) -> bool {
        self.placement.matrix3.determinant() < 0.0
    }

    /// Returns the space in which devices store its triangles.
    pub(crate) fn stored(&self) -> Stored<'_> {
        if !self.is_shared {
            return Stored { placed: Placed::new(&self.file, &self.placement), mesh: self, placement: None };
        }
        // About a corner, as files may have it anywhere.
        let [first, ..] = self.file.triangles.positions()[self.triangles[0] as usize];
        let middle = self.file.positions[first as usize];
        let middle = DAffine3::from_translation(middle);
        let placed = Placed::in_own_space(&self.file, self.mirrors());
        Stored { placed, mesh: self, placement: Some((self.placement * middle, middle.translation)) }
    }

    /// Returns the number of its triangles.
    pub fn triangle_count(&self) -> usize {
        self.triangles.len()
    }

    /// Returns which attributes its corners have beside normals and texture coordinates.
    pub(crate) fn attribute_kinds(&self) -> AttributeKinds {
        AttributeKinds {
            colors: !self.file.colors.is_empty(),
            further_uvs: usize::from(!self.file.second_uvs.is_empty()) + self.file.more_uvs.len(),
            tangents: !self.file.tangents.is_empty(),
        }
    }

    /// Calls `each` with every `step`-th of its triangles in the world, in the order of the file.
    pub fn for_each(&self, step: usize, mut each: impl FnMut(Triangle)) {
        let placed = Placed::new(&self.file, &self.placement);
        for &index in self.triangles.iter().step_by(step.max(1)) {
            each(Triangle { material: self.material, motion: self.motion, ..placed.triangle(index) });
        }
    }
}

/// The triangles of a mesh as devices store them: in the world, or in a space of their own.
pub(crate) struct Stored<'a> {
    placed: Placed<'a>,
    mesh: &'a Mesh,
    placement: Option<(DAffine3, DVec3)>,
}

impl Stored<'_> {
    /// Returns the transformation to the world, and the origin in the space of the file, unless it is the world.
    pub fn placement(&self) -> Option<(DAffine3, DVec3)> {
        self.placement
    }

    /// Returns the triangle at this place of the mesh, and what else its corners have; a triangle in a space of its own is
    /// where the file has it.
    pub fn triangle(&self, place: usize) -> Triangle {
        let triangle = self.placed.triangle(self.mesh.triangles[place]);
        Triangle { material: self.mesh.material, motion: self.mesh.motion, ..triangle }
    }

    /// Returns the corners of that triangle in any order.
    pub fn corners(&self, place: usize) -> [DVec3; 3] {
        self.placed.corners(self.mesh.file.triangles.positions()[self.mesh.triangles[place] as usize])
    }

    /// Returns true if the triangles lie in a space of their own, which a mirror turns into the world: their corners have
    /// the order of the world.
    pub fn is_turned(&self) -> bool {
        self.placement.is_some() && self.mesh.mirrors()
    }

    /// Returns what the corners of that triangle have beside normals and texture coordinates.
    pub fn attributes(&self, place: usize) -> CornerAttributes {
        self.placed.attributes(self.mesh.triangles[place])
    }

    /// Returns the coordinates of that triangle's corners in a further set, 0 the second.
    pub fn further_uvs(&self, place: usize, set: usize) -> [DVec2; 3] {
        self.placed.further_uvs(self.mesh.triangles[place], set)
    }
}

fn bounds_of(file: &mesh::Mesh, corners: &[u32], placement: &DAffine3) -> Bounds {
    let none = || Bounds { min: DVec3::INFINITY, max: DVec3::NEG_INFINITY };
    let with = |bounds: Bounds, other: Bounds| Bounds {
        min: bounds.min.min(other.min),
        max: bounds.max.max(other.max),
    };
    let of_run = |run: &[u32]| {
        let places = run.iter().map(|i| placement.transform_point3(file.positions[*i as usize]));
        places.fold(none(), |bounds, place| with(bounds, Bounds { min: place, max: place }))
    };
    corners.par_chunks(4096).map(of_run).reduce(none, with)
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

    /// Calls `each` with the material of every triangle and what returns the texture coordinates of its corners: the first
    /// ones, or those of a further set, 0 the second; they are the same at all corners where there are none.
    pub fn for_each_coordinates(&self, mut each: impl FnMut(usize, &dyn Fn(Option<usize>) -> [DVec2; 3])) {
        for own in &self.triangles {
            each(own.material, &|set| if set.is_none() { own.uvs } else { [DVec2::ZERO; 3] });
        }
        for mesh in &self.meshes {
            let placed = Placed::new(&mesh.file, &mesh.placement);
            for &index in mesh.triangles.iter() {
                each(mesh.material, &|set| match set {
                    None => placed.triangle(index).uvs,
                    Some(set) => placed.further_uvs(index, set),
                });
            }
        }
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
    const FACETS: Facets = Facets::Many;

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
