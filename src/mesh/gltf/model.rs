//! What a glTF file holds: the types in which the reader returns it, and which nodes belong to a scene or stand below
//! a node. Positions are as in the file: y upwards, in metres.

use glam::{DAffine3, DVec2, DVec3, DVec4};
use rayon::prelude::*;

use super::images::{Image, Sampler, Texture};
use super::material::Material;
use super::stage::{Camera, Light};

/// A file.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Model {
    /// Scenes; if the file has none, one with all nodes.
    pub scenes: Vec<Scene>,
    /// The scene to draw: the one that the file names, or the first.
    pub default_scene: usize,
    /// Nodes of the file in its order, whether a scene has them or not.
    pub nodes: Vec<Node>,
    /// Geometry, each at least one triangle.
    pub primitives: Vec<Primitive>,
    /// Where primitives stand.
    pub instances: Vec<Instance>,
    /// Triangles without an area, which no primitive has.
    pub degenerate: usize,
    /// Materials in the order of the file.
    pub materials: Vec<Material>,
    /// Textures in the order of the file.
    pub textures: Vec<Texture>,
    /// Samplers in the order of the file.
    pub samplers: Vec<Sampler>,
    /// Images in the order of the file.
    pub images: Vec<Image>,
    /// Cameras of all nodes.
    pub cameras: Vec<Camera>,
    /// Lights of all nodes.
    pub lights: Vec<Light>,
    /// What was passed over, in sentences.
    pub notes: Vec<String>,
}

/// Nodes to be drawn together.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Scene {
    /// Empty if it has none.
    pub name: String,
    /// Indices of nodes without a parent; those below them belong to the scene as well.
    pub roots: Vec<usize>,
}

/// A frame within the graph of the file, which is a forest.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Node {
    /// Empty if it has none; several may have the same.
    pub name: String,
    /// Indices of the nodes directly below.
    pub children: Vec<usize>,
    /// World from node, that is, the product of the matrices from the root. It may mirror, and it may flatten.
    pub matrix: DAffine3,
}

/// Triangles over shared vertices. Lists of attributes are empty if the file has none, otherwise as long as that of
/// positions.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Primitive {
    /// Name of the first mesh that has it, empty if that has none.
    pub name: String,
    /// JSON pointer to it in that mesh.
    pub place: String,
    /// Vertices.
    pub positions: Vec<DVec3>,
    /// Shading normals, of any length.
    pub normals: Vec<DVec3>,
    /// Tangents, with the sign of the bitangent; empty without normals.
    pub tangents: Vec<DVec4>,
    /// Sets of texture coordinates, v downwards: two at least, of which one may be empty.
    pub uvs: Vec<Vec<DVec2>>,
    /// Linear colours with alpha.
    pub colors: Vec<DVec4>,
    /// Counter-clockwise as seen from the front, in the order of the file. Each has an area.
    pub triangles: Vec<[u32; 3]>,
}

/// A primitive that stands somewhere.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Instance {
    /// Index of the primitive.
    pub primitive: usize,
    /// Index of the material; none stands for the default one.
    pub material: Option<usize>,
    /// Index of the node.
    pub node: usize,
    /// World from primitive. A negative determinant turns triangles around; that of a flat one is 0.
    pub matrix: DAffine3,
}

impl Primitive {
    /// Returns the corners of its triangles.
    pub fn faces(&self) -> impl Iterator<Item = [u32; 3]> {
        self.triangles.iter().copied()
    }

    /// Returns the corners of its triangles for several threads.
    pub fn faces_at_once(&self) -> impl IndexedParallelIterator<Item = [u32; 3]> {
        self.triangles.par_iter().copied()
    }
}

impl Model {
    /// Returns for each node whether it belongs to a scene.
    pub fn in_scene(&self, scene: usize) -> Vec<bool> {
        self.below(self.scenes.get(scene).map_or(&[], |scene| &scene.roots))
    }

    /// Returns for each node whether it is one of the given ones or stands below one.
    pub fn below(&self, roots: &[usize]) -> Vec<bool> {
        let mut marked = vec![false; self.nodes.len()];
        let mut open = roots.to_vec();
        while let Some(index) = open.pop() {
            if let (Some(node), Some(mark @ false)) = (self.nodes.get(index), marked.get_mut(index)) {
                *mark = true;
                open.extend(&node.children);
            }
        }
        marked
    }

    /// Returns the indices of the nodes of a name.
    pub fn named(&self, name: &str) -> Vec<usize> {
        let named = self.nodes.iter().enumerate().filter(|(_, node)| node.name == name);
        named.map(|(index, _)| index).collect()
    }
}
