//! Primitives, the geometry of meshes. Input: the file's description of one and the accessors that it names. Output:
//! lists of vertices and triangles over them. Only vertices that its triangles use are read if the others are many,
//! so that the work is bounded by the number of triangles.

use std::rc::Rc;

use glam::{DVec2, DVec3, DVec4};
use rayon::prelude::*;

use super::accessor::{Accessor, Accessors, Component};
use super::attribute::{MOST_SETS, Use, Vertices, each};
use super::json::Json;
use super::model::Primitive;
use super::notes::Notes;
use super::topology::{Mode, has_area};
use crate::mesh::Fault;

/// What is told of triangles without an area.
pub(super) const WITHOUT_AREA: &str = "triangles without an area are left out";

/// Triangles that a thread looks at at once.
const AT_ONCE: usize = 1 << 12;

/// What makes a primitive: accessors and how they are used. Equal shapes share one primitive.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub(super) struct Shape {
    mode: Mode,
    indices: Option<usize>,
    positions: usize,
    normals: Option<usize>,
    tangents: Option<usize>,
    /// Two at least.
    uvs: Vec<Option<usize>>,
    colors: Option<usize>,
}

impl Shape {
    /// Reads the description of a primitive, or returns nothing if there is nothing to draw.
    pub(super) fn read(json: Json, accessors: usize, notes: &mut Notes) -> Result<Option<Shape>, Fault> {
        let mode = match json.whole("mode")? {
            None | Some(4) => Mode::Triangles,
            Some(5) => Mode::Strip,
            Some(6) => Mode::Fan,
            Some(0..=3) => {
                notes.add("points and lines are not drawn", || json.pointer());
                return Ok(None);
            }
            Some(other) => return Err(json.fault_at("mode", format!("it is {other}; 0 to 6 are allowed"))),
        };
        let attributes = json.needed("attributes", json.object("attributes")?)?;
        let attribute = |key: &str| attributes.index(key, accessors, "accessors");
        let Some(positions) = attribute("POSITION")? else {
            notes.add("primitives without positions are not drawn", || json.pointer());
            return Ok(None);
        };
        note_ignored(json, attributes, notes);
        let normals = attribute("NORMAL")?;
        let uvs = (0..MOST_SETS).map(|set| attribute(&format!("TEXCOORD_{set}")));
        let mut uvs: Vec<Option<usize>> = uvs.collect::<Result<_, _>>()?;
        uvs.truncate(uvs.iter().rposition(Option::is_some).map_or(2, |last| (last + 1).max(2)));
        Ok(Some(Shape {
            mode,
            indices: json.index("indices", accessors, "accessors")?,
            positions,
            normals,
            // Without normals, flat ones are used, to which the tangents do not belong.
            tangents: attribute("TANGENT")?.filter(|_| normals.is_some()),
            uvs,
            colors: attribute("COLOR_0")?,
        }))
    }

    /// Returns the number of triangles, including those without an area.
    pub(super) fn triangle_count(&self, accessors: &mut Accessors) -> Result<usize, Fault> {
        let corners = accessors.open(self.indices.unwrap_or(self.positions))?.count;
        Ok(self.mode.triangle_count(corners))
    }

    /// Reads the vertices and triangles, or returns nothing if no triangle has an area.
    pub(super) fn primitive(
        &self,
        accessors: &mut Accessors,
        [name, place]: [&str; 2],
        notes: &mut Notes,
    ) -> Result<Option<Primitive>, Fault> {
        let count = accessors.open(self.positions)?.count;
        let positions = Use::POSITION.open(accessors, self.positions, count)?;
        if count == 0 {
            return Err(
                positions.fault("/count", "it is 0; a primitive with indices needs positions, 1 at least")
            );
        }
        let normals = opened(Use::NORMAL, accessors, self.normals, count)?;
        let tangents = opened(Use::TANGENT, accessors, self.tangents, count)?;
        let uvs = self.uvs.iter().map(|uvs| opened(Use::UV, accessors, *uvs, count));
        let uvs: Vec<Option<Rc<Accessor>>> = uvs.collect::<Result<_, _>>()?;
        let colors = opened(Use::COLOR, accessors, self.colors, count)?;
        let indices = self.indices.map(|index| accessors.open(index)).transpose()?;

        let all = self.triangle_count(accessors)?;
        let listed = indices.as_ref().unwrap_or(&positions);
        if self.mode == Mode::Triangles && listed.count % 3 != 0 {
            notes.add("corners behind the last whole triangle are left out", || listed.place().to_owned());
        }
        let flat = positions.is_zero() || indices.as_ref().is_some_and(|indices| indices.is_zero());
        let mut triangles = match &indices {
            // Not even the corners of triangles without an area are worth their memory.
            _ if flat => Vec::new(),
            Some(indices) => self.triangles(all, &corners(indices, count)?),
            None => self.triangles(all, &sequential(&positions)?),
        };
        let vertices = compact(&mut triangles, count);
        let points: Vec<DVec3> = vertices.read(&positions, DVec3::from_array)?;
        let keeps = |corners: &[u32; 3]| {
            has_area(corners.map(|corner| points.get(corner as usize).copied().unwrap_or_default()))
        };
        // Mostly all have one.
        if !triangles.par_iter().with_min_len(AT_ONCE).all(keeps) {
            triangles.retain(keeps);
        }
        if triangles.len() < all {
            let place = || positions.place().to_owned();
            notes.add_many(WITHOUT_AREA, all - triangles.len(), place);
        }
        if triangles.is_empty() {
            return Ok(None);
        }
        let uv = |accessor: &Option<Rc<Accessor>>| read(&vertices, accessor, DVec2::from_array);
        Ok(Some(Primitive {
            name: name.to_owned(),
            place: place.to_owned(),
            positions: points,
            normals: read(&vertices, &normals, DVec3::from_array)?,
            tangents: read(&vertices, &tangents, DVec4::from_array)?,
            uvs: uvs.iter().map(uv).collect::<Result<_, _>>()?,
            colors: match colors.as_ref().map(|colors| colors.width) {
                Some(3) => read(&vertices, &colors, |[r, g, b]| DVec4::new(r, g, b, 1.0))?,
                _ => read(&vertices, &colors, DVec4::from_array)?,
            },
            triangles,
        }))
    }

    /// Returns the triangles over a list of corners, in the order of the file.
    fn triangles(&self, count: usize, corners: &[u32]) -> Vec<[u32; 3]> {
        let corner = |place: usize| corners.get(place).copied();
        let triangle = |i| {
            let [a, b, c] = self.mode.corners(i);
            Some([corner(a)?, corner(b)?, corner(c)?])
        };
        let mut triangles = Vec::with_capacity(count);
        triangles.extend((0..count).filter_map(triangle).filter(|[a, b, c]| a != b && b != c && c != a));
        triangles
    }
}

/// Opens the accessor of an attribute, if there is one.
fn opened<'a>(
    used: Use,
    accessors: &mut Accessors<'a>,
    index: Option<usize>,
    count: usize,
) -> Result<Option<Rc<Accessor<'a>>>, Fault> {
    index.map(|index| used.open(accessors, index, count)).transpose()
}

/// Reads the vertices' elements of an attribute, none if it is not there.
fn read<const N: usize, T: Send>(
    vertices: &Vertices,
    accessor: &Option<Rc<Accessor>>,
    convert: impl Fn([f64; N]) -> T + Sync + Send,
) -> Result<Vec<T>, Fault> {
    accessor.as_ref().map_or(Ok(Vec::new()), |accessor| vertices.read(accessor, convert))
}

/// Reads the corners that indices list.
fn corners(indices: &Accessor, count: usize) -> Result<Vec<u32>, Fault> {
    if indices.width != 1 {
        return Err(indices.fault("/type", format!("it is {}; indices have to be SCALAR", indices.kind())));
    }
    let unsigned = matches!(indices.component, Component::U8 | Component::U16 | Component::U32);
    if !unsigned || indices.normalized {
        let what = "indices have to be of unsigned integers (5121, 5123, 5125), not normalized";
        return Err(indices.fault("/componentType", what));
    }
    let corner = |i: usize| {
        let [index] = indices.numbers(i)?;
        if index >= count as f64 {
            let what = format!("element {i} is {index}; the primitive has {count} vertices");
            return Err(indices.fault("", what));
        }
        Ok(index as u32)
    };
    each(indices.count, corner, || 0)
}

/// Returns the corners of a primitive without indices.
fn sequential(positions: &Accessor) -> Result<Vec<u32>, Fault> {
    let what = || format!("it is {}; at most {} are allowed", positions.count, u32::MAX);
    let count = u32::try_from(positions.count).map_err(|_| positions.fault("/count", what()))?;
    Ok((0..count).collect())
}

/// Returns the vertices that a primitive is made of, and makes its triangles refer to them. They are all elements of
/// the accessors, unless triangles use few of them: files may cut one list of vertices into many primitives.
fn compact(triangles: &mut [[u32; 3]], count: usize) -> Vertices {
    if count <= triangles.len().saturating_mul(3) {
        return Vertices::First(count);
    }
    let mut used: Vec<u32> = triangles.as_flattened().to_vec();
    used.sort_unstable();
    used.dedup();
    for corner in triangles.as_flattened_mut() {
        // Found, as it was put in above; there are fewer than 2³² of them.
        *corner = used.binary_search(corner).unwrap_or_default() as u32;
    }
    Vertices::Some(used)
}

/// Remarks on parts of a primitive that are passed over.
fn note_ignored(json: Json, attributes: Json, notes: &mut Notes) {
    if json.get("targets").is_some() {
        notes.add("morph targets are ignored", || json.pointer());
    }
    for (name, value) in attributes.members() {
        let what = match name.split_once('_') {
            Some(("TEXCOORD", set)) if set.parse().is_ok_and(|set: usize| set >= MOST_SETS) => {
                "texture coordinates beyond TEXCOORD_7 are ignored"
            }
            Some(("COLOR", set)) if set != "0" => "colours beyond COLOR_0 are ignored",
            Some(("JOINTS" | "WEIGHTS", _)) => "joints and weights are ignored",
            _ => continue,
        };
        notes.add(what, || value.pointer());
    }
}
