//! What is drawn and where. Input: the nodes and the meshes that they hold. Output: primitives, each read once however
//! often it is drawn, and instances of them. How many triangles there are is known, and limited, before any is read.

use std::collections::HashMap;

use glam::DAffine3;

use super::accessor::Accessors;
use super::document::{Document, List};
use super::model::{Instance, Primitive};
use super::nodes::Forest;
use super::notes::Notes;
use super::primitive::Shape;
use crate::mesh::Fault;

/// Primitives and where they stand.
pub(super) struct Drawn {
    pub(super) primitives: Vec<Primitive>,
    pub(super) instances: Vec<Instance>,
}

/// A primitive of a mesh.
struct Part {
    /// Index of its shape.
    shape: usize,
    material: Option<usize>,
    /// Number of triangles, at least 1.
    triangles: usize,
}

/// Meshes that nodes hold.
struct Meshes<'a> {
    list: List<'a>,
    /// Number of materials of the file.
    materials: usize,
    /// Parts with triangles of each mesh that was read.
    parts: HashMap<usize, Vec<Part>>,
    /// Different shapes, with the name of the first mesh that has them, and the JSON pointer to them there.
    shapes: Vec<(Shape, [String; 2])>,
    /// Where a shape is among them.
    known: HashMap<Shape, usize>,
}

/// Most places where primitives stand.
const MOST_PLACES: usize = 1 << 20;

/// Reads the meshes that nodes hold, of at most `most` triangles, however often these are drawn.
pub(super) fn read(
    document: &Document,
    forest: &Forest,
    accessors: &mut Accessors,
    materials: usize,
    most: usize,
    notes: &mut Notes,
) -> Result<Drawn, Fault> {
    let list = document.list("meshes")?;
    let mut meshes =
        Meshes { list, materials, parts: HashMap::new(), shapes: Vec::new(), known: HashMap::new() };
    let (mut left, mut places) = (most, MOST_PLACES);
    for (index, held) in forest.held.iter().enumerate() {
        let Some(mesh) = held.mesh else { continue };
        let is_new = !meshes.parts.contains_key(&mesh);
        let [triangles, parts] = meshes.read(mesh, accessors, notes)?;
        let over = |what: String| {
            Fault::new(format!("/nodes/{index}"), format!("up to here, it has more than {what}"))
        };
        if is_new {
            left = left
                .checked_sub(triangles)
                .ok_or_else(|| over(format!("{most} triangles, the most a scene may have")))?;
        }
        let copies = held.copies.map_or(Ok(1), |copies| copies.count(accessors))?;
        places = parts.checked_mul(copies).and_then(|count| places.checked_sub(count)).ok_or_else(|| {
            over(format!("{MOST_PLACES} places where primitives of meshes stand, the most that are drawn"))
        })?;
    }
    let unused = |mesh: &usize| !meshes.parts.contains_key(mesh);
    if let Some(first) = (0..meshes.list.len()).find(unused) {
        let count = (first..meshes.list.len()).filter(unused).count();
        notes.add_many("meshes that no node holds are not drawn", count, || format!("/meshes/{first}"));
    }
    let mut primitives = Vec::new();
    let mut places = Vec::with_capacity(meshes.shapes.len());
    for (shape, [name, place]) in &meshes.shapes {
        let primitive = shape.primitive(accessors, [name, place], notes)?;
        places.push(primitive.as_ref().map(|_| primitives.len()));
        primitives.extend(primitive);
    }
    let mut instances = Vec::new();
    for (node, held) in forest.held.iter().enumerate() {
        let parts = held.mesh.and_then(|mesh| meshes.parts.get(&mesh)).filter(|parts| !parts.is_empty());
        let (Some(parts), Some(frame)) = (parts, forest.nodes.get(node)) else { continue };
        let copies = match held.copies {
            Some(copies) => copies.matrices(accessors)?,
            None => vec![DAffine3::IDENTITY],
        };
        for copy in copies {
            let matrix = frame.matrix * copy;
            if !matrix.is_finite() {
                return Err(Fault::new(format!("/nodes/{node}"), "a copy's matrix is not finite"));
            }
            let placed = parts.iter().filter_map(|part| {
                let primitive = places.get(part.shape).copied().flatten()?;
                Some(Instance { primitive, material: part.material, node, matrix })
            });
            instances.extend(placed);
        }
    }
    Ok(Drawn { primitives, instances })
}

impl Meshes<'_> {
    /// Reads the parts of a mesh, if that was not done before, and returns its numbers of triangles and of parts.
    fn read(
        &mut self,
        mesh: usize,
        accessors: &mut Accessors,
        notes: &mut Notes,
    ) -> Result<[usize; 2], Fault> {
        if let Some(parts) = self.parts.get(&mesh) {
            return Ok([triangles(parts), parts.len()]);
        }
        let element = self.list.element(mesh)?;
        let json = element.json();
        let name = json.name()?;
        let mut parts = Vec::new();
        for (number, primitive) in json.list("primitives")?.into_iter().enumerate() {
            let material = primitive.index("material", self.materials, "materials")?;
            let Some(shape) = Shape::read(primitive, accessors.len(), notes)? else { continue };
            let triangles = shape.triangle_count(accessors)?;
            if triangles == 0 {
                notes.add("primitives of fewer than three corners are not drawn", || primitive.pointer());
                continue;
            }
            let shape = match self.known.get(&shape) {
                Some(index) => *index,
                None => {
                    self.known.insert(shape.clone(), self.shapes.len());
                    let place = format!("/meshes/{mesh}/primitives/{number}");
                    self.shapes.push((shape, [name.clone(), place]));
                    self.shapes.len() - 1
                }
            };
            parts.push(Part { shape, material, triangles });
        }
        let counts = [triangles(&parts), parts.len()];
        self.parts.insert(mesh, parts);
        Ok(counts)
    }
}

/// Returns the number of triangles of a mesh, or the greatest number if it is too large.
fn triangles(parts: &[Part]) -> usize {
    parts.iter().fold(0, |sum, part| sum.saturating_add(part.triangles))
}
