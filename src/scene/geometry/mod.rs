//! The kinds of shapes that a scene has, one file each: defaults, checks, box and motion. What is not here goes over
//! `Scene::shapes` and knows no kind.

mod plane;
mod sphere;
mod triangle;

use glam::DVec3;

use super::limits::{COORDINATE, MAX_SHAPES};
use super::model::{Material, Scene};
use super::refusal::{Check, Key};

pub use plane::Plane;
pub use sphere::Sphere;
pub use triangle::Triangle;

/// Words by which a person knows them.
const KINDS: &str = "planes, spheres and triangles";

/// An axis-aligned box.
#[derive(Clone, Copy, Debug)]
pub struct Bounds {
    /// Its least coordinates.
    pub min: DVec3,
    /// Its greatest coordinates.
    pub max: DVec3,
}

/// What all shapes have.
pub trait Shape {
    /// Index into `Scene::materials`.
    fn material(&self) -> usize;
    /// The same, to change it.
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

    /// The same, to change them.
    pub fn shapes_mut(&mut self) -> impl Iterator<Item = &mut dyn Shape> {
        let planes = self.planes.iter_mut().map(|s| s as &mut dyn Shape);
        let spheres = self.spheres.iter_mut().map(|s| s as &mut dyn Shape);
        planes.chain(spheres).chain(self.triangles.iter_mut().map(|s| s as &mut dyn Shape))
    }
}

/// A kind of shape: what a builder knows of it.
pub trait Kind: Shape + Sized {
    /// What such a shape is called, in scene files and messages.
    const SECTION: &str;

    /// Those that a scene has.
    fn list(scene: &Scene) -> &Vec<Self>;

    /// The same, to add to.
    fn list_mut(scene: &mut Scene) -> &mut Vec<Self>;
}

/// What the builder checks of a kind.
pub(super) trait Checked: Kind {
    /// Refuses a shape that is degenerate, or that its material does not suit.
    fn check(&self, key: Key, material: &Material) -> Check;
}

/// Adds a shape. Returns its key where it is the first of too many.
pub(super) fn add<K: Kind>(scene: &mut Scene, shape: K) -> Option<Key> {
    let list = K::list_mut(scene);
    list.push(shape);
    let item = list.len() - 1;
    (count(scene) == MAX_SHAPES + 1).then(|| Key::item(K::SECTION, item))
}

fn count(scene: &Scene) -> usize {
    scene.planes.len() + scene.spheres.len() + scene.triangles.len()
}

/// Refuses more shapes than a scene may have; `over` is the first of them.
pub(super) fn check_count(scene: &Scene, over: Option<Key>) -> Check {
    let Some(key) = over else { return Ok(()) };
    let count = count(scene);
    key.refuse(format!("{count} {KINDS}; a scene may have {MAX_SHAPES} at most"), "one too many")
}

/// Checks every shape.
pub(super) fn check(scene: &Scene) -> Check {
    check_kind::<Plane>(scene)?;
    check_kind::<Sphere>(scene)?;
    check_kind::<Triangle>(scene)
}

fn check_kind<K: Checked>(scene: &Scene) -> Check {
    K::list(scene).iter().enumerate().try_for_each(|(item, shape)| {
        let key = Key::item(K::SECTION, item);
        key.of("material").index(shape.material(), scene.materials.len(), "material")?;
        key.of("motion").vector(shape.motion(), &COORDINATE)?;
        shape.check(key, &scene.materials[shape.material()])
    })
}

/// Leaves out shapes that no ray meets. Returns which triangle was the first.
pub(super) fn drop_empty(scene: &mut Scene) -> Option<usize> {
    let all = scene.triangles.len();
    let first = scene.triangles.iter().position(Triangle::is_empty);
    scene.triangles.retain(|triangle| !triangle.is_empty());
    scene.dropped_triangles = all - scene.triangles.len();
    first
}
