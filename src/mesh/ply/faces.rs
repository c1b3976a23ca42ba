//! Faces and strips of a PLY file as triangles. Input: their records, which may come before those of the vertices. Output:
//! triangles with the texture coordinates of their vertices, or with those of their own corners.

use ply_rs_bw::ply::ElementDef;

use super::fixed::Fixed;
use super::records::{Body, Face, TEXTURE};
use crate::mesh::{Fault, Mesh, MeshTriangle, Triangles, check, polygon};
use glam::DVec2;

/// What faces and strips become.
#[derive(Default)]
pub(super) struct Surfaces {
    /// Number of textures that the file names.
    textures: usize,
    /// Most triangles.
    most: usize,
    /// Whether vertices have texture coordinates.
    pub has_uvs: bool,
    /// Those that came before the vertices.
    waiting: Vec<(usize, Face, bool)>,
}

impl Surfaces {
    pub fn new(textures: usize, most: usize) -> Surfaces {
        Surfaces { textures, most, ..Surfaces::default() }
    }

    /// Reads all records of an element.
    pub fn read(&mut self, body: &mut Body, element: &ElementDef, mesh: &mut Mesh) -> Result<(), Fault> {
        let is_strip = element.name == "tristrips";
        if !is_strip && self.read_triangles(body, element, mesh)? {
            return Ok(());
        }
        for number in 0..element.count {
            let face: Face = body.record(element, number)?;
            if mesh.positions.is_empty() {
                self.waiting.push((number, face, is_strip));
            } else {
                self.add(number, &face, is_strip, mesh)?;
            }
        }
        Ok(())
    }

    /// Reads the records of faces at once and returns true if each is a triangle with what its vertices have.
    fn read_triangles(&self, body: &mut Body, element: &ElementDef, mesh: &mut Mesh) -> Result<bool, Fault> {
        let count = mesh.positions.len();
        let have_textures = self.textures > 0 && element.properties.contains_key(TEXTURE);
        if count == 0 || have_textures || element.count > self.most - mesh.triangles.len() {
            return Ok(false);
        }
        let Some(fixed) = Fixed::take(body, element) else { return Ok(false) };
        let read = fixed.triangles(count);
        let read = read.map_err(|(i, wrong)| Fault::new(format!("face {i}"), missing(wrong, count)))?;
        let (has_normals, texture) = (!mesh.normals.is_empty(), self.first_texture());
        mesh.triangles.append(Triangles::of_vertices(read, self.has_uvs, has_normals, texture));
        Ok(true)
    }

    /// Adds those that came before the vertices.
    pub fn add_waiting(&mut self, mesh: &mut Mesh) -> Result<(), Fault> {
        let waiting = std::mem::take(&mut self.waiting);
        waiting.iter().try_for_each(|(number, face, is_strip)| self.add(*number, face, *is_strip, mesh))
    }

    fn add(&self, number: usize, face: &Face, is_strip: bool, mesh: &mut Mesh) -> Result<(), Fault> {
        let (name, count) = (if is_strip { "tristrips" } else { "face" }, mesh.positions.len());
        let fault = |what: String| Fault::new(format!("{name} {number}"), what);
        // A strip is as long as the file has it.
        if face.corners.len() > polygon::MOST_CORNERS && !is_strip {
            return Err(fault(format!("it has more than {} corners", polygon::MOST_CORNERS)));
        }
        let exists = |n: f64| n >= 0.0 && n.fract() == 0.0 && n < count as f64;
        let ends = |n: f64| is_strip && n == -1.0;
        if let Some(wrong) = face.corners.iter().find(|&&n| !exists(n) && !ends(n)) {
            return Err(fault(missing(*wrong, count)));
        }
        if is_strip {
            for strip in face.corners.split(|&n| n < 0.0) {
                for (place, corners) in strip.windows(3).enumerate() {
                    let [a, b, c] = [corners[0], corners[1], corners[2]].map(|n| n as u32);
                    // Every other triangle of a strip would run the other way.
                    let positions = if place % 2 == 0 { [a, b, c] } else { [b, a, c] };
                    let has_area = a != b && b != c && c != a;
                    if has_area {
                        mesh.triangles.push(self.of_vertices(mesh, positions));
                    }
                    check::count(mesh.triangles.len(), self.most)?;
                }
            }
            return Ok(());
        }
        let corners: Vec<u32> = face.corners.iter().map(|&n| n as u32).collect();
        if !face.uvs.is_empty() && face.uvs.len() != 2 * corners.len() {
            let (found, needed) = (face.uvs.len(), 2 * corners.len());
            return Err(fault(format!(
                "its list \"texcoord\" has {found} numbers; {needed} are needed, or none"
            )));
        }
        let first_uv = mesh.uvs.len() as u32;
        mesh.uvs.extend(face.uvs.chunks_exact(2).map(|uv| DVec2::new(uv[0], uv[1])));
        let texture = self.texture(face).map_err(fault)?;
        for triangle in polygon::triangles(&mesh.positions, &corners) {
            let positions = triangle.map(|corner| corners.get(corner).copied().unwrap_or_default());
            let mut added = MeshTriangle { material: texture, ..self.of_vertices(mesh, positions) };
            if !face.uvs.is_empty() {
                added.uvs = Some(triangle.map(|corner| first_uv + corner as u32));
            }
            mesh.triangles.push(added);
        }
        check::count(mesh.triangles.len(), self.most)
    }

    /// Returns the texture of a face: that of its number, or the first; a negative number stands for none.
    fn texture(&self, face: &Face) -> Result<Option<u32>, String> {
        let number = face.texture.unwrap_or(0.0);
        match self.textures {
            0 => Ok(None),
            _ if number < 0.0 => Ok(None),
            count if number < count as f64 && number.fract() == 0.0 => Ok(Some(number as u32)),
            count => Err(format!("it has texture {number}; the file names {count}")),
        }
    }

    /// Returns a triangle with what its vertices have.
    fn of_vertices(&self, mesh: &Mesh, positions: [u32; 3]) -> MeshTriangle {
        let uvs = self.has_uvs.then_some(positions);
        let normals = (!mesh.normals.is_empty()).then_some(positions);
        MeshTriangle { positions, uvs, normals, material: self.first_texture() }
    }

    /// Returns the texture of what names none.
    fn first_texture(&self) -> Option<u32> {
        (self.textures > 0).then_some(0)
    }
}

/// Says that a corner has no vertex.
fn missing(wrong: f64, count: usize) -> String {
    format!("it refers to vertex {wrong}; the file has {count}")
}
