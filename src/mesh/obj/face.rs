//! Faces of OBJ. Input: the words of a statement, and what the mesh holds so far. Output: indices of the corners.

use crate::mesh::text::{quoted, words};
use crate::mesh::{Mesh, polygon};

/// Indices of the corners of a face.
#[derive(Default)]
pub(super) struct Face {
    pub positions: Vec<u32>,
    /// As many as positions, or none.
    pub uvs: Vec<u32>,
    /// As many as positions, or none.
    pub normals: Vec<u32>,
}

impl Face {
    /// Replaces the corners by those of a line, which refer to what the mesh holds so far.
    pub fn read(&mut self, rest: &[u8], mesh: &Mesh) -> Result<(), String> {
        self.positions.clear();
        self.uvs.clear();
        self.normals.clear();
        for corner in words(rest) {
            if self.positions.len() == polygon::MOST_CORNERS {
                return Err(format!("face has more than {} corners", polygon::MOST_CORNERS));
            }
            let mut parts = corner.split(|byte| *byte == b'/');
            let position = parts.next().unwrap_or_default();
            self.positions.push(index(position, mesh.positions.len(), "vertex")?);
            if let Some(uv) = parts.next().filter(|part| !part.is_empty()) {
                self.uvs.push(index(uv, mesh.uvs.len(), "texture coordinate")?);
            }
            if let Some(normal) = parts.next().filter(|part| !part.is_empty()) {
                self.normals.push(index(normal, mesh.normals.len(), "normal")?);
            }
            if parts.next().is_some() {
                return Err(format!("{} has more than three indices", quoted(corner)));
            }
        }
        for list in [&mut self.uvs, &mut self.normals] {
            if list.len() != self.positions.len() {
                list.clear();
            }
        }
        Ok(())
    }
}

/// Returns three elements of a list, or nothing if it lacks one.
pub(super) fn pick(list: &[u32], [a, b, c]: [usize; 3]) -> Option<[u32; 3]> {
    Some([*list.get(a)?, *list.get(b)?, *list.get(c)?])
}

/// Turns an index of the file, from 1 or backwards from -1, into one from 0. `count` elements are defined above.
fn index(word: &[u8], count: usize, what: &str) -> Result<u32, String> {
    let parsed = std::str::from_utf8(word).ok().and_then(|word| word.parse::<i64>().ok());
    let given = parsed.ok_or_else(|| format!("{} is no whole number", quoted(word)))?;
    if given == 0 {
        return Err(format!("face refers to {what} 0; the first is 1"));
    }
    let all = i64::try_from(count).unwrap_or(i64::MAX);
    let from_zero = if given > 0 { given - 1 } else { given.saturating_add(all) };
    u32::try_from(from_zero)
        .ok()
        .filter(|_| from_zero < all)
        .ok_or_else(|| format!("face refers to {what} {given}; {count} are defined above"))
}
