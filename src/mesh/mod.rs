//! Meshes as files hold them. Input: the bytes of a file. Output: positions, texture coordinates, normals, and triangles
//! over them that name a material of the file. Nothing here knows a scene or a device.

mod check;
pub mod gltf;
pub mod mtl;
mod obj;
mod ply;
mod polygon;
pub mod relative;
mod stl;
mod tangents;
mod text;
mod triangles;
mod winding;

use std::fmt;

use glam::{DVec2, DVec3, Vec4};

pub use triangles::Triangles;

/// Triangles over shared positions, texture coordinates and normals.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Mesh {
    /// Corners.
    pub positions: Vec<DVec3>,
    /// Texture coordinates, v upwards.
    pub uvs: Vec<DVec2>,
    /// Shading normals, of any length.
    pub normals: Vec<DVec3>,
    /// Linear colours with alpha, one for each position; empty without any.
    pub colors: Vec<Vec4>,
    /// Second texture coordinates, v upwards, one for each position; empty without any.
    pub second_uvs: Vec<DVec2>,
    /// Further sets, each as the second one.
    pub more_uvs: Vec<Vec<DVec2>>,
    /// Tangents along u with the sign of the bitangent, for the corners of each triangle; empty without any.
    pub tangents: Vec<[Vec4; 3]>,
    /// Counter-clockwise as seen from the front, in the order of the file.
    pub triangles: Triangles,
    /// Names of the materials that triangles refer to.
    pub materials: Vec<String>,
    /// Files that define these materials, as written.
    pub libraries: Vec<String>,
    /// Definitions of these materials that the file itself has.
    pub definitions: Vec<mtl::MtlMaterial>,
    /// What was passed over, in sentences.
    pub notes: Vec<String>,
}

impl Mesh {
    /// Adds triangles.
    pub fn extend(&mut self, triangles: impl Iterator<Item = MeshTriangle>) {
        self.triangles.extend(triangles);
    }

    /// Adds triangles without a material whose corners have one index for all that they have.
    pub fn extend_of_vertices(&mut self, corners: Vec<[u32; 3]>, has_uvs: bool, has_normals: bool) {
        self.triangles.append(Triangles::of_vertices(corners, has_uvs, has_normals, None));
    }

    /// Returns the number of its triangles.
    pub fn triangle_count(&self) -> usize {
        self.triangles.len()
    }

    /// Returns true if its corners have more than normals and texture coordinates.
    pub fn has_attributes(&self) -> bool {
        !(self.colors.is_empty() && self.second_uvs.is_empty() && self.tangents.is_empty())
    }

    /// Gives all triangles the material of this index, or none.
    pub fn set_material(&mut self, material: Option<u32>) {
        self.triangles.set_material(material);
    }

    /// Returns the number of triangles without texture coordinates that have a material which is `textured`, and the name of
    /// the first of these.
    pub fn lacking_uvs(&self, textured: impl Fn(usize) -> bool) -> Option<(usize, &str)> {
        let bare = self.triangles.iter().filter(|triangle| triangle.uvs.is_none());
        let mut bare = bare.filter_map(|triangle| triangle.material).map(|own| own as usize);
        let first = bare.find(|&own| textured(own))?;
        Some((1 + bare.filter(|&own| textured(own)).count(), self.materials.get(first)?))
    }

    /// Returns the least and the greatest coordinates of all corners.
    pub fn bounds(&self) -> [DVec3; 2] {
        let corners = self.triangles.positions().as_flattened();
        let positions = corners.iter().filter_map(|index| self.positions.get(*index as usize));
        let none = [DVec3::INFINITY, DVec3::NEG_INFINITY];
        positions.fold(none, |[min, max], position| [min.min(*position), max.max(*position)])
    }
}

/// Indices of the three corners of a triangle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MeshTriangle {
    /// Into the positions.
    pub positions: [u32; 3],
    /// Into the texture coordinates, if it has any.
    pub uvs: Option<[u32; 3]>,
    /// Into the normals, if it has any.
    pub normals: Option<[u32; 3]>,
    /// Into the names of materials, if it names one.
    pub material: Option<u32>,
}

impl MeshTriangle {
    /// Returns it seen from its back.
    pub fn reversed(&self) -> MeshTriangle {
        let swap = |[a, b, c]: [u32; 3]| [a, c, b];
        MeshTriangle {
            positions: swap(self.positions),
            uvs: self.uvs.map(swap),
            normals: self.normals.map(swap),
            ..*self
        }
    }
}

/// Why a file is no mesh.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Fault {
    /// Where: `line 12`, `byte 84`, `header`; empty for the whole file.
    pub place: String,
    /// What was found and what is allowed.
    pub what: String,
}

impl Fault {
    pub(crate) fn new(place: impl Into<String>, what: impl Into<String>) -> Fault {
        Fault { place: place.into(), what: what.into() }
    }
}

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if !self.place.is_empty() {
            write!(f, "{}: ", self.place)?;
        }
        f.write_str(&self.what)
    }
}

/// Materials that a file or a library may have: as many as a scene may have shapes.
const MAX_MATERIALS: usize = 65_535;

/// A format of mesh files.
#[derive(Clone, Copy, Debug)]
pub struct MeshFormat {
    /// As people call it.
    pub name: &'static str,
    /// The ending of its files, in lower case.
    pub ending: &'static str,
    /// Reads a file of at most `most` triangles.
    pub read: fn(bytes: &[u8], most: usize) -> Result<Mesh, Fault>,
}

/// All formats.
pub const FORMATS: [MeshFormat; 3] = [ply::FORMAT, obj::FORMAT, stl::FORMAT];
