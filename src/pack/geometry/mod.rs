//! The kinds of shapes, one file each → their device records, relative to the eye, each with its map; and what the rest
//! of packing and rendering asks of all of them: how many there are, and how far f32 misplaces them.

mod mesh_forest;

use glam::DVec3;

use super::precision::Camera;
use super::{PackedScene, TextureKind};
use crate::core::error::Result;
use crate::scene::model::{Mapping, Scene, Shape};
use crate::schema::layout;
use crate::schema::shapes::with_shapes;
use crate::texture::sampler_spec::SamplerSpec;

/// More shapes than this are worth lists of tiles: so few are unrolled code.
const FEW: usize = 16;

macro_rules! kinds {
    ($($kind:ident $module:ident $list:ident [$($property:ident)*];)+) => {
        $(mod $module;)+

        pub fn pack_shapes(packed: &mut PackedScene, scene: &Scene) -> Result<()> {
            mesh_forest::begin(packed, &scene.shapes.meshes);
            $(for shape in &scene.shapes.$list {
                let record = $module::pack(packed, scene, shape, scene.camera.eye)?;
                packed.records.$list.push(record);
            })+
            if scene.shapes_move() {
                packed.records.motions = scene.motions().map(|m| layout::Motion { shift: m }).collect();
            }
            mesh_forest::finish(packed, scene);
            Ok(())
        }

        /// The number of shapes of the kinds with a property.
        fn shapes_with(scene: &Scene, property: &str) -> usize {
            total(&[$((has(&[$(stringify!($property)),*], property), scene.shapes.$list.len())),+])
        }

        /// Returns true if some shape is a mesh, through which rays find their way by a tree.
        pub fn has_meshes(scene: &Scene) -> bool {
            shapes_with(scene, "concave") > 0
        }

        /// Returns true if lists of the shapes in each tile make camera rays faster.
        pub fn gains_by_tiles(scene: &Scene) -> bool {
            shapes_with(scene, "listed") > FEW || has_meshes(scene)
        }

        pub(super) fn rounded_shapes(scene: &Scene) -> impl Iterator<Item = &dyn Rounded> {
            std::iter::empty()$(.chain(scene.shapes.$list.iter().map(|shape| shape as &dyn Rounded)))+
        }

        impl PackedScene {
            pub fn shape_count(&self) -> usize {
                self.shapes_that(|_| true)
            }

            /// Shapes that lists of tiles hold.
            pub fn listed_shapes(&self) -> usize {
                self.shapes_that(|properties| has(properties, "listed"))
            }

            /// Returns true if lists of tiles hold the shape of a number.
            pub fn is_listed(&self, shape: usize) -> bool {
                let lists = [$((has(&[$(stringify!($property)),*], "listed"), self.records.$list.len())),+];
                let mut end = 0;
                let own = lists.iter().find(|(_, length)| {
                    end += length;
                    shape < end
                });
                own.is_some_and(|(listed, _)| *listed)
            }

            /// Returns true if some shape may cast a shadow on itself or on another: a single flat one does not.
            pub fn shapes_occlude(&self) -> bool {
                self.shapes_that(|properties| !has(properties, "planar")) > 0 || self.shape_count() > 1
            }

            /// Returns true if some triangle, of a mesh or not, has shading normals.
            pub fn has_smooth_normals(&self) -> bool {
                let records = &self.records;
                records.triangles.iter().any(|t| t.is_smooth) || records.meshes.iter().any(|m| m.is_smooth)
            }

            /// Returns true if some mesh is met from the front only.
            pub fn culls_backs(&self) -> bool {
                self.records.meshes.iter().any(|mesh| self.is_one_sided(mesh.material))
            }

            /// Returns true if some shape of another kind is seen from the front only.
            pub fn has_one_sided_shapes(&self) -> bool {
                let one_sided = |material: u32| self.is_one_sided(material);
                false$(|| !has(&[$(stringify!($property)),*], "concave")
                    && self.records.$list.iter().any(|shape| one_sided(shape.material)))+
            }

            /// Returns true if a ray that leaves some shape outwards may meet it again.
            pub fn has_concave_shapes(&self) -> bool {
                self.shapes_that(|properties| has(properties, "concave")) > 0
            }

            /// Returns true if all shapes are.
            pub fn has_concave_shapes_alone(&self) -> bool {
                self.has_concave_shapes() && self.shapes_that(|properties| !has(properties, "concave")) == 0
            }

            /// The number of shapes of the kinds whose properties are chosen.
            fn shapes_that(&self, chosen: impl Fn(&[&str]) -> bool) -> usize {
                let lists = [$((chosen(&[$(stringify!($property)),*]), self.records.$list.len())),+];
                total(&lists)
            }
        }
    };
}
with_shapes!(kinds);

impl PackedScene {
    fn is_one_sided(&self, material: u32) -> bool {
        self.records.materials.get(material as usize).is_some_and(|material| material.one_sided)
    }
}

fn has(properties: &[&str], property: &str) -> bool {
    properties.contains(&property)
}

/// The sum of the lengths of chosen lists.
fn total(lists: &[(bool, usize)]) -> usize {
    lists.iter().filter(|(chosen, _)| *chosen).map(|(_, length)| length).sum()
}

/// a × b to two ulps of each component, however near to parallel (Kahan's difference of products; Jeannerod,
/// Louvet & Muller 2013).
pub fn cross(a: DVec3, b: DVec3) -> DVec3 {
    let difference = |a: f64, b: f64, c: f64, d: f64| {
        let cd = c * d;
        a.mul_add(b, -cd) + (-c).mul_add(d, cd)
    };
    DVec3::new(difference(a.y, b.z, a.z, b.y), difference(a.z, b.x, a.x, b.z), difference(a.x, b.y, a.y, b.x))
}

/// The index of the shape's map; shapes without a texture share map 0, which they never read.
fn add_map(
    packed: &mut PackedScene,
    scene: &Scene,
    material: usize,
    make: impl Fn(&Mapping, &SamplerSpec, bool) -> layout::UvProjection,
) -> u32 {
    let material = &scene.materials[material];
    let Some(texture) = material.textures().next().map(|used| used.texture) else { return 0 };
    let kind = packed.records.textures[texture].kind;
    let flat = matches!(kind, TextureKind::Flat | TextureKind::Procedural);
    packed.records.uv_projections.push(make(&material.mapping, &scene.sampler_of(material), flat));
    packed.records.uv_projections.len() as u32 - 1
}

/// The largest coordinate, seen from the eye.
fn reach(p: DVec3, eye: DVec3) -> f64 {
    (p - eye).abs().max_element()
}

/// Returns true if texture coordinates are moderate numbers wherever a ray meets something.
pub fn bounds_uv(scene: &Scene) -> bool {
    let bounds_uv = |shape: &dyn Rounded| {
        let material = &scene.materials[shape.material()];
        material.textures().next().is_none() || shape.bounds_uv(&material.mapping, scene.camera.eye)
    };
    let mut shapes = rounded_shapes(scene).peekable();
    shapes.peek().is_some() && scene.background.environment.is_none() && shapes.all(bounds_uv)
}

/// The errors of a shape in f32.
pub(super) trait Rounded: Shape {
    /// Returns true if it is one of many, each of which counts once, not by the rays that hit it.
    fn is_small(&self) -> bool {
        false
    }

    /// The largest number that it has, seen from the eye.
    fn extent(&self, eye: DVec3) -> f64;

    /// Returns true if texture coordinates are moderate numbers wherever a ray meets it.
    fn bounds_uv(&self, _: &Mapping, _: DVec3) -> bool {
        false
    }

    /// Returns true if the error of its outline is visible.
    fn misses_outline(&self, _: &Camera) -> bool {
        false
    }

    /// Adds the errors of texture coordinates on it, in tiles.
    fn errors(&self, camera: &Camera, mapping: &Mapping, add: &mut dyn FnMut(f64));
}
