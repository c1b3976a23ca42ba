//! The kinds of shapes that a scene has, one file each: keys, defaults, checks, box and motion. What is not here goes over
//! `Scene::shapes` and knows no kind.

mod fields;
pub(super) mod meshes;

use glam::DVec3;

use super::limits::{COORDINATE, MAX_SHAPES};
use super::model::{Material, Scene};
use super::refusal::{Check, Key};
use crate::core::error::Result;
use crate::schema::shapes::with_shapes;

pub use fields::Fields;

/// An axis-aligned box.
#[derive(Clone, Copy, Debug)]
pub struct Bounds {
    /// Its least coordinates.
    pub min: DVec3,
    /// Its greatest coordinates.
    pub max: DVec3,
}

/// How many triangles a shape consists of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Facets {
    /// It is no triangle.
    None,
    /// It is one.
    One,
    /// It has a tree of them.
    Many,
}

/// The common properties of all shapes.
pub trait Shape {
    /// Returns its index into `Scene::materials`.
    fn material(&self) -> usize;
    /// Returns that index for writing.
    fn material_mut(&mut self) -> &mut usize;

    /// Returns how many triangles it consists of.
    fn facets(&self) -> Facets;

    /// Returns its displacement between the times 0 and 1.
    fn motion(&self) -> DVec3;

    /// Moves it to its place at that time, where it stays.
    fn freeze(&mut self, time: f64);

    /// Returns its centre; an infinite plane has none.
    fn centroid(&self) -> Option<DVec3>;

    /// Returns its box; an infinite plane has none.
    fn bounds(&self) -> Option<Bounds>;
}

/// A kind of shape, as the rest of a scene uses it.
pub trait Kind: Shape + Sized {
    /// The name of such a shape in scene files and messages.
    const SECTION: &str;

    /// Returns the shapes of this kind.
    fn list(shapes: &Shapes) -> &Vec<Self>;

    /// Returns them for writing.
    fn list_mut(shapes: &mut Shapes) -> &mut Vec<Self>;
}

/// The part of a kind that its own file implements.
trait Described: Kind {
    /// Keys of its section beside `material` and `motion`; none if a scene file names it otherwise.
    const KEYS: &[&str];
    /// How many triangles it consists of.
    const FACETS: Facets = Facets::None;

    /// Reads a shape that lies still and has this material.
    fn read(fields: &dyn Fields, material: usize) -> Result<Self>;

    /// Moves it.
    fn translate(&mut self, way: DVec3);

    /// Returns its centre.
    fn middle(&self) -> Option<DVec3>;

    /// Returns its box.
    fn extent(&self) -> Option<Bounds>;

    /// Returns whether no ray meets it.
    fn is_empty(&self) -> bool {
        false
    }

    /// Refuses a shape that is degenerate, or that its material does not suit.
    fn check(&self, key: Key, material: &Material) -> Check;
}

/// A kind as scene formats know it.
pub struct Section {
    /// Its name.
    pub name: &'static str,
    /// Lists of keys that it knows.
    pub keys: [&'static [&'static str]; 2],
    /// Reads a shape of this material and motion and adds it.
    pub(super) add: fn(&dyn Fields, usize, DVec3, &mut Shapes) -> Result<Added>,
}

/// The result of adding a shape.
pub(super) struct Added {
    /// Its key, where it is the first of too many.
    pub over: Option<Key>,
    /// No ray meets it.
    pub is_empty: bool,
}

const COMMON_KEYS: &[&str] = &["material", "motion"];

macro_rules! kinds {
    ($($kind:ident $module:ident $list:ident [$($property:ident)*];)+) => {
        $(mod $module;)+

        /// The kinds, and what belongs to one alone.
        pub mod kinds {
            $(pub use super::$module::*;)+
        }
        pub use kinds::*;

        /// The shapes of a scene: a list of each kind.
        #[derive(Clone, Debug, Default)]
        pub struct Shapes {
            $(#[doc = concat!("All ", stringify!($list), ".")] pub $list: Vec<$kind>,)+
        }

        impl Shapes {
            /// Returns all shapes, in the order in which devices number them.
            pub fn iter(&self) -> impl Iterator<Item = &dyn Shape> {
                std::iter::empty()$(.chain(self.$list.iter().map(|shape| shape as &dyn Shape)))+
            }

            /// Returns all shapes for writing.
            pub fn iter_mut(&mut self) -> impl Iterator<Item = &mut dyn Shape> {
                std::iter::empty()$(.chain(self.$list.iter_mut().map(|shape| shape as &mut dyn Shape)))+
            }

            /// Returns the name of the kind of the shape with this number from 0, and its number among those, from 1.
            pub fn kind_of(&self, mut number: usize) -> Option<(&'static str, usize)> {
                for (name, count) in [$((<$kind as Kind>::SECTION, self.$list.len())),+] {
                    if number < count {
                        return Some((name, number + 1));
                    }
                    number -= count;
                }
                None
            }

            fn count(&self) -> usize {
                [$(self.$list.len()),+].iter().sum()
            }
        }

        $(impl Kind for $kind {
            const SECTION: &str = stringify!($module);

            fn list(shapes: &Shapes) -> &Vec<Self> {
                &shapes.$list
            }

            fn list_mut(shapes: &mut Shapes) -> &mut Vec<Self> {
                &mut shapes.$list
            }
        }

        impl Shape for $kind {
            fn material(&self) -> usize {
                self.material
            }

            fn material_mut(&mut self) -> &mut usize {
                &mut self.material
            }

            fn facets(&self) -> Facets {
                <$kind as Described>::FACETS
            }

            fn motion(&self) -> DVec3 {
                self.motion
            }

            fn freeze(&mut self, time: f64) {
                let way = time * std::mem::take(&mut self.motion);
                self.translate(way);
            }

            fn centroid(&self) -> Option<DVec3> {
                self.middle()
            }

            fn bounds(&self) -> Option<Bounds> {
                self.extent()
            }
        }

        impl $kind {
            /// Returns it with the material of this index.
            pub fn with_material(self, material: usize) -> $kind {
                $kind { material, ..self }
            }
        })+

        const ALL_SECTIONS: &[Section] = &[$(Section {
            name: <$kind as Kind>::SECTION,
            keys: [<$kind as Described>::KEYS, COMMON_KEYS],
            add: |fields, material, motion, shapes| {
                let shape = $kind { motion, ..<$kind as Described>::read(fields, material)? };
                Ok(Added { is_empty: shape.is_empty(), over: add(shapes, shape) })
            },
        }),+];

        /// Checks every shape.
        pub(super) fn check(scene: &Scene) -> Check {
            $(check_kind::<$kind>(scene)?;)+
            Ok(())
        }
    };
}
with_shapes!(kinds);

/// Returns the kinds that have a section of their keys in scene files.
pub fn sections() -> impl Iterator<Item = &'static Section> {
    ALL_SECTIONS.iter().filter(|section| !section.keys[0].is_empty())
}

/// Adds a shape. Returns its key where it is the first of too many.
pub(super) fn add<K: Kind>(shapes: &mut Shapes, shape: K) -> Option<Key> {
    let list = K::list_mut(shapes);
    list.push(shape);
    let item = list.len() - 1;
    (shapes.count() == MAX_SHAPES + 1).then(|| Key::item(K::SECTION, item))
}

/// Refuses more shapes than a scene may have; `over` is the first of them.
pub(super) fn check_count(shapes: &Shapes, over: Option<Key>) -> Check {
    let Some(key) = over else { return Ok(()) };
    let count = shapes.count();
    key.refuse(format!("{count} shapes; a scene may have {MAX_SHAPES} at most"), "one too many")
}

fn check_kind<K: Described>(scene: &Scene) -> Check {
    K::list(&scene.shapes).iter().enumerate().try_for_each(|(item, shape)| {
        let key = Key::item(K::SECTION, item);
        key.of("material").index(shape.material(), scene.materials.len(), "material")?;
        key.of("motion").vector(shape.motion(), &COORDINATE)?;
        shape.check(key, &scene.materials[shape.material()])
    })
}

/// Leaves out shapes that no ray meets. Returns which triangle was the first.
pub(super) fn drop_empty(scene: &mut Scene) -> Option<usize> {
    let triangles = &mut scene.shapes.triangles;
    let all = triangles.len();
    let first = triangles.iter().position(Triangle::is_empty);
    triangles.retain(|triangle| !triangle.is_empty());
    scene.dropped_triangles = all - triangles.len();
    first
}
