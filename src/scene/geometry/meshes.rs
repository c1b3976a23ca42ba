//! Meshes of files as triangles of a scene. Input: a mesh, its placement, and the index of each material. Output: its
//! triangles in the builder, or shapes that hold many. Positions are multiplied by the matrix, normals by its inverse
//! transpose; a mirroring matrix exchanges two corners, so that fronts stay fronts. v of a mesh file grows upwards, v of a
//! texture downwards.

use std::collections::BTreeMap;
use std::sync::Arc;

use glam::{DAffine3, DMat3, DQuat, DVec2, DVec3, DVec4, EulerRot, Vec4};
use rayon::prelude::*;

use crate::core::number::shown_vector;
use crate::mesh::Mesh;
use crate::scene::builder::SceneBuilder;
use crate::scene::limits::{COORDINATE, collinear};
use crate::scene::model::{self as shapes, DEFAULT, Triangle};

/// Most triangles that are added one by one.
const FEW: usize = 64;

/// Triangles that a thread takes at once.
const AT_ONCE: usize = 1 << 12;

/// A transformation from a mesh's own space to the world.
pub(in crate::scene) type Placement = DAffine3;

/// Returns the transformation that scales, then rotates about x, y and z in this order (degrees), then translates.
pub(in crate::scene) fn placement(translate: DVec3, rotate: DVec3, scale: DVec3) -> Placement {
    let [x, y, z] = rotate.to_array().map(f64::to_radians);
    // Of intrinsic rotations the last one acts first.
    DAffine3::from_scale_rotation_translation(scale, DQuat::from_euler(EulerRot::ZYX, z, y, x), translate)
}

/// Meshes that stand in several places share their triangles on devices if that saves so many.
const MANY: usize = 1 << 16;
/// They do it if no placement stretches one direction more than another by much: the product of the norms of the matrix
/// and of its inverse, 3 for one that keeps angles.
const MOST_STRETCH: f64 = 6.0;

/// A place where a mesh stands.
pub(in crate::scene) struct Instance {
    pub placement: Placement,
    pub motion: DVec3,
    /// An index in the scene for each material of the mesh.
    pub material_of: Vec<usize>,
    /// The material of triangles that name none.
    pub other: usize,
}

impl Instance {
    /// Returns the indices in the scene of all materials that triangles may have.
    fn materials(&self) -> impl Iterator<Item = usize> {
        self.material_of.iter().copied().chain([self.other])
    }

    /// Returns the index in the scene of a material of the mesh.
    fn material(&self, own: Option<u32>) -> usize {
        let found = own.and_then(|i| self.material_of.get(i as usize)).copied();
        found.filter(|&index| index != DEFAULT).unwrap_or(self.other)
    }
}

/// Adds the triangles of a mesh: few one by one, so that beams and cones know their outlines, more as one shape for each
/// material and instance, as are few whose material looks at the shape. `one_sided`: some material is seen from the front only, and no triangle is added one by one, as
/// trees know sides. Returns how many have no area and were left out, or which instance has a corner beyond the range of
/// coordinates, and what that becomes.
pub(in crate::scene) fn add(
    builder: &mut SceneBuilder,
    mesh: Mesh,
    instances: &[Instance],
    one_sided: bool,
) -> Result<usize, (usize, String)> {
    let is_few = mesh.triangle_count() <= FEW && !mesh.has_attributes() && !one_sided;
    let worn = |instance: &Instance| instance.materials().any(|material| builder.is_kept_whole(material));
    let is_single = is_few && !instances.iter().any(worn);
    let placements: Vec<&Placement> = instances.iter().map(|instance| &instance.placement).collect();
    let is_shared = shares(mesh.triangle_count(), &placements);
    let file = Arc::new(mesh);
    let (mut kept, mut dropped) = (Vec::new(), 0);
    let farthest = farthest(&file.positions);
    for (number, instance) in instances.iter().enumerate() {
        let placed = Placed::new(&file, &instance.placement);
        check_positions(&placed, farthest).map_err(|what| (number, what))?;
        let motion = instance.motion;
        if is_single {
            let with_area = with_area(&placed);
            dropped += file.triangles.len() - with_area.len();
            for index in with_area {
                let material = instance.material(file.triangles.material(index as usize));
                builder.shape(Triangle { material, motion, ..placed.triangle(index) });
            }
            continue;
        }
        // Which have an area does not depend on a placement that keeps shapes nearly.
        if number == 0 || !is_shared {
            kept = of_materials(&file, with_area(&placed), |own| match own {
                _ if !is_shared => instance.material(own),
                own => own.map_or(0, |index| index as usize + 1),
            });
        }
        dropped += file.triangles.len() - kept.iter().map(|group| group.triangles.len()).sum::<usize>();
        for Group { key, triangles, corners } in &kept {
            let own = || key.checked_sub(1).map(|index| index as u32);
            let material = if is_shared { instance.material(own()) } else { *key };
            let (file, triangles) = (Arc::clone(&file), Arc::clone(triangles));
            let mesh = shapes::Mesh::new(file, triangles, corners, instance.placement, is_shared);
            builder.shape(shapes::Mesh { material, motion, ..mesh });
        }
    }
    Ok(dropped)
}

/// Returns the triangles that have an area where they stand, in the order of the file.
fn with_area(placed: &Placed<'_>) -> Vec<u32> {
    let triangles = placed.mesh.triangles.positions();
    let has_area = |index: &u32| !collinear(placed.corners(triangles[*index as usize]));
    let all = || (0..triangles.len() as u32).into_par_iter().with_min_len(AT_ONCE);
    let have_area = |run: &[[u32; 3]]| run.iter().all(|corners| !collinear(placed.corners(*corners)));
    // Mostly all have one, and a list of known length takes no joining.
    let is_whole = triangles.par_chunks(AT_ONCE).all(have_area);
    if is_whole { all().collect() } else { all().filter(has_area).collect() }
}

/// Returns true if this many triangles in several places are held once.
pub(in crate::scene) fn shares(triangles: usize, placements: &[&Placement]) -> bool {
    let saved = triangles.saturating_mul(placements.len().saturating_sub(1));
    triangles > FEW && saved >= MANY && placements.iter().all(|placement| stretch(placement) <= MOST_STRETCH)
}

/// Triangles of a mesh with one key.
struct Group {
    key: usize,
    triangles: Arc<[u32]>,
    /// The positions that they use, each once.
    corners: Vec<u32>,
}

impl Group {
    fn new(file: &Mesh, key: usize, triangles: Vec<u32>) -> Group {
        let mut is_used = vec![false; file.positions.len()];
        let all = file.triangles.positions();
        triangles.iter().flat_map(|index| all[*index as usize]).for_each(|i| is_used[i as usize] = true);
        let corners = (0..).zip(is_used).filter_map(|(index, is_used)| is_used.then_some(index)).collect();
        Group { key, triangles: triangles.into(), corners }
    }
}

/// Returns triangles of a file, grouped by a key that their material has.
fn of_materials(file: &Mesh, triangles: Vec<u32>, key: impl Fn(Option<u32>) -> usize) -> Vec<Group> {
    let own = |index: &u32| file.triangles.material(*index as usize);
    let first = triangles.first().and_then(own);
    let have_first = || triangles.par_iter().with_min_len(AT_ONCE).all(|index| own(index) == first);
    if file.triangles.have_one_material() || have_first() {
        return if triangles.is_empty() { Vec::new() } else { vec![Group::new(file, key(first), triangles)] };
    }
    let mut grouped: BTreeMap<usize, Vec<u32>> = BTreeMap::new();
    let mut last = (None, key(None));
    for index in triangles {
        let own = file.triangles.material(index as usize);
        if own != last.0 {
            last = (own, key(own));
        }
        grouped.entry(last.1).or_default().push(index);
    }
    grouped.into_iter().map(|(key, triangles)| Group::new(file, key, triangles)).collect()
}

/// Returns the greatest absolute values of coordinates.
fn farthest(positions: &[DVec3]) -> DVec3 {
    let of_run = |run: &[DVec3]| run.iter().fold(DVec3::ZERO, |most, position| most.max(position.abs()));
    positions.par_chunks(AT_ONCE).map(of_run).reduce(|| DVec3::ZERO, DVec3::max)
}

/// Refuses corners out of the range of coordinates; `farthest`: no coordinate of the mesh exceeds these.
fn check_positions(placed: &Placed<'_>, farthest: DVec3) -> Result<(), String> {
    let Placement { matrix3: DMat3 { x_axis: x, y_axis: y, z_axis: z }, translation } = placed.placement;
    let [x, y, z] = [x, y, z].map(DVec3::abs);
    // Twice as far, for what rounding adds: mostly no corner has to be looked at.
    let reach = 2.0 * (x * farthest.x + y * farthest.y + z * farthest.z + translation.abs());
    if reach.to_array().iter().all(|&x| (COORDINATE.allow)(x)) {
        return Ok(());
    }
    let outside = |i: &usize| !placed.position(*i as u32).to_array().iter().all(|&x| (COORDINATE.allow)(x));
    match (0..placed.mesh.positions.len()).into_par_iter().find_first(outside) {
        None => Ok(()),
        Some(i) => {
            let position = placed.position(i as u32);
            Err(format!("position {i} becomes {}, which is not {}", shown_vector(position), COORDINATE.words))
        }
    }
}

/// Returns by how much a placement stretches one direction more than another; infinite if it flattens.
fn stretch(placement: &Placement) -> f64 {
    let norm = |m: DMat3| m.to_cols_array().iter().map(|x| x * x).sum::<f64>().sqrt();
    let product = norm(placement.matrix3) * norm(placement.matrix3.inverse());
    if product.is_finite() { product } else { f64::INFINITY }
}

/// A mesh in the world, or in its own space with fronts and backs as in the world.
pub(super) struct Placed<'a> {
    pub mesh: &'a Mesh,
    placement: Placement,
    normal_matrix: DMat3,
    mirrors: bool,
}

impl Placed<'_> {
    pub fn new<'a>(mesh: &'a Mesh, placement: &Placement) -> Placed<'a> {
        let mirrors = placement.matrix3.determinant() < 0.0;
        Placed { mesh, placement: *placement, normal_matrix: normal_matrix(&placement.matrix3), mirrors }
    }

    pub fn in_own_space<'a>(mesh: &'a Mesh, mirrors: bool) -> Placed<'a> {
        Placed { mesh, placement: Placement::IDENTITY, normal_matrix: DMat3::IDENTITY, mirrors }
    }

    fn position(&self, index: u32) -> DVec3 {
        self.placement.transform_point3(self.mesh.positions[index as usize])
    }

    pub fn corners(&self, triangle: [u32; 3]) -> [DVec3; 3] {
        triangle.map(|i| self.position(i))
    }

    fn normal(&self, index: u32) -> DVec3 {
        (self.normal_matrix * self.mesh.normals[index as usize]).normalize_or_zero()
    }

    fn uv(&self, index: u32) -> DVec2 {
        let uv = self.mesh.uvs[index as usize];
        DVec2::new(uv.x, 1.0 - uv.y)
    }

    /// Returns a triangle that lies still and has the default material.
    pub fn triangle(&self, index: u32) -> Triangle {
        let found = self.mesh.triangles.get(index as usize);
        let found = if self.mirrors { found.reversed() } else { found };
        let flat = Triangle::new(self.corners(found.positions));
        let own = found.normals.map(|indices| indices.map(|i| self.normal(i)));
        Triangle {
            uvs: found.uvs.map_or(flat.uvs, |indices| indices.map(|i| self.uv(i))),
            // Files have normals of length zero where a program could not make any.
            normals: own.filter(|normals| !normals.contains(&DVec3::ZERO)),
            ..flat
        }
    }
}

/// What the corners of a triangle have beside normals and texture coordinates.
#[derive(Clone, Copy, Debug)]
pub(crate) struct CornerAttributes {
    pub colors: [Vec4; 3],
    /// In the world, unit or zero, with the sign of the bitangent.
    pub tangents: [DVec4; 3],
}

impl CornerAttributes {
    /// Those of a file that has none of them.
    const NONE: CornerAttributes = CornerAttributes { colors: [Vec4::ONE; 3], tangents: [DVec4::ZERO; 3] };
}

impl Placed<'_> {
    /// Returns the attributes of a triangle's corners, in the order of `triangle`.
    pub fn attributes(&self, index: u32) -> CornerAttributes {
        let mesh = self.mesh;
        if !mesh.has_attributes() {
            return CornerAttributes::NONE;
        }
        let found = mesh.triangles.positions()[index as usize];
        let order = if self.mirrors { [0, 2, 1] } else { [0, 1, 2] };
        let at = |corner: usize| found[order[corner]] as usize;
        let tangents = mesh.tangents.get(index as usize).copied().unwrap_or_default();
        let sign = if self.mirrors { -1.0 } else { 1.0 };
        CornerAttributes {
            colors: [0, 1, 2].map(|corner| mesh.colors.get(at(corner)).copied().unwrap_or(Vec4::ONE)),
            tangents: order.map(|corner| {
                let tangent = tangents[corner].as_dvec4();
                let way = self.placement.transform_vector3(tangent.truncate()).normalize_or_zero();
                way.extend(sign * tangent.w)
            }),
        }
    }

    /// Returns the coordinates of a triangle's corners in a further set, 0 the second, in the order of `triangle`.
    pub fn further_uvs(&self, index: u32, set: usize) -> [DVec2; 3] {
        let mesh = self.mesh;
        let order = if self.mirrors { [0, 2, 1] } else { [0, 1, 2] };
        let uvs = set.checked_sub(1).map_or(&mesh.second_uvs, |more| &mesh.more_uvs[more]);
        order.map(|corner| {
            let at = mesh.triangles.positions()[index as usize][corner] as usize;
            let uv = uvs.get(at).copied().unwrap_or_default();
            DVec2::new(uv.x, 1.0 - uv.y)
        })
    }
}

/// Returns the inverse transpose up to a positive factor, also of a matrix that flattens.
pub(in crate::scene) fn normal_matrix(matrix: &DMat3) -> DMat3 {
    let [x, y, z] = [matrix.x_axis, matrix.y_axis, matrix.z_axis];
    let cofactors = DMat3::from_cols(y.cross(z), z.cross(x), x.cross(y));
    if matrix.determinant() < 0.0 { -cofactors } else { cofactors }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_saves_little_or_loses_its_shape_is_copied() {
        let plain = Placement::from_scale_rotation_translation(
            DVec3::new(-0.2, 0.2, 0.3),
            DQuat::from_rotation_x(1.0),
            DVec3::X,
        );
        let many = vec![&plain; 100];
        assert!(shares(1000, &many));
        assert!(!shares(1000, &many[..10]) && !shares(12, &vec![&plain; 60_000]));
        for z in [20.0, 0.0] {
            let other = Placement::from_scale(DVec3::new(1.0, 1.0, z));
            assert!(!shares(1000, &[&many[1..], &[&other]].concat()), "{z}");
        }
    }
}
