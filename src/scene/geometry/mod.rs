//! The kinds of shapes that a scene has, one file each: keys, defaults, checks, box and motion. What is not here goes over
//! `Scene::shapes` and knows no kind.

mod plane;
mod sphere;
mod triangle;

use glam::DVec3;

use super::model::{Material, Scene};
use super::names::Names;
use super::reader::COORDINATE;
use super::table::Table;
use crate::core::error::Result;

pub use plane::Plane;
pub use sphere::Sphere;
pub use triangle::Triangle;

/// All shapes together: devices test each of them for every ray.
const MAX_SHAPES: usize = 65535;
/// Words by which a person knows them, and the sections in which they stand.
const KINDS: &str = "planes, spheres and triangles";
const SECTIONS: [&str; 3] = ["plane", "sphere", "triangle"];

/// An axis-aligned box.
#[derive(Clone, Copy, Debug)]
pub struct Bounds {
    pub min: DVec3,
    pub max: DVec3,
}

/// What all shapes have.
pub trait Shape {
    /// Index into `Scene::materials`.
    fn material(&self) -> usize;
    fn material_mut(&mut self) -> &mut usize;

    /// How far it moves between the times 0 and 1.
    fn motion(&self) -> DVec3;

    /// Puts it for good where it is at that time.
    fn freeze(&mut self, time: f64);

    /// Its middle; an infinite plane has none.
    fn centroid(&self) -> Option<DVec3>;

    /// Its box; an infinite plane has none.
    fn bounds(&self) -> Option<Bounds>;
}

impl Scene {
    /// All shapes, in the order in which devices number them.
    pub fn shapes(&self) -> impl Iterator<Item = &dyn Shape> {
        let planes = self.planes.iter().map(|s| s as &dyn Shape);
        let spheres = self.spheres.iter().map(|s| s as &dyn Shape);
        planes.chain(spheres).chain(self.triangles.iter().map(|s| s as &dyn Shape))
    }

    pub fn shapes_mut(&mut self) -> impl Iterator<Item = &mut dyn Shape> {
        let planes = self.planes.iter_mut().map(|s| s as &mut dyn Shape);
        let spheres = self.spheres.iter_mut().map(|s| s as &mut dyn Shape);
        planes.chain(spheres).chain(self.triangles.iter_mut().map(|s| s as &mut dyn Shape))
    }
}

/// The shapes of a scene file.
pub(super) struct Shapes {
    pub planes: Vec<Plane>,
    pub spheres: Vec<Sphere>,
    pub triangles: Vec<Triangle>,
    pub dropped_triangles: usize,
    pub first_dropped: usize,
    /// Some shape has the material behind the last that the file names.
    pub use_fallback: bool,
}

/// Which material a shape has; `fallback` is where the default one stands or will stand.
pub(super) struct MaterialIndex<'n, 'a> {
    pub names: &'n Names<'a>,
    pub fallback: usize,
}

impl MaterialIndex<'_, '_> {
    fn of(&self, table: &Table<'_>) -> Result<usize> {
        table.get("material").map_or(Ok(self.fallback), |field| self.names.resolve(field))
    }
}

fn motion(table: &Table<'_>) -> Result<DVec3> {
    table.get("motion").map_or(Ok(DVec3::ZERO), |field| field.vec3(&COORDINATE))
}

/// Refuses a file with too many shapes.
pub(super) fn check_count(root: &Table<'_>) -> Result<()> {
    root.check_counts(KINDS, MAX_SHAPES, &SECTIONS)
}

pub(super) fn read(
    root: &Table<'_>,
    index: &MaterialIndex<'_, '_>,
    materials: &[Material],
) -> Result<Shapes> {
    let tables = root.repeated("plane", plane::KEYS)?;
    let planes = tables.iter().map(|t| plane::read(t, index, materials)).collect::<Result<Vec<_>>>()?;
    let tables = root.repeated("sphere", sphere::KEYS)?;
    let spheres = tables.iter().map(|t| sphere::read(t, index)).collect::<Result<Vec<_>>>()?;
    let tables = root.repeated("triangle", triangle::KEYS)?;
    let read = tables.iter().map(|t| triangle::read(t, index)).collect::<Result<Vec<_>>>()?;
    let first_dropped = read.iter().position(Option::is_none).map_or(0, |i| tables[i].line());
    let triangles: Vec<Triangle> = read.into_iter().flatten().collect();
    let dropped_triangles = tables.len() - triangles.len();
    let fallback = index.fallback;
    let use_fallback = planes.iter().any(|s| s.material == fallback)
        || spheres.iter().any(|s| s.material == fallback)
        || triangles.iter().any(|s| s.material == fallback);
    Ok(Shapes { planes, spheres, triangles, dropped_triangles, first_dropped, use_fallback })
}
