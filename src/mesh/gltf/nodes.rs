//! The graph of nodes. Input: the file's lists of nodes and scenes. Output: nodes with their matrices to the world, and
//! what each holds. A graph with circles, with a node below two others, or too deep is refused.

use std::collections::HashSet;

use glam::DAffine3;

use super::document::Document;
use super::json::Json;
use super::model::{Node, Scene};
use super::notes::Notes;
use super::transform::{self, Copies};
use crate::mesh::Fault;

/// The most nodes from a root to a leaf.
const MOST_DEEP: usize = 256;

/// How many things of each kind nodes may refer to.
pub(super) struct Counts {
    pub(super) meshes: usize,
    pub(super) cameras: usize,
    pub(super) lights: usize,
    pub(super) accessors: usize,
}

/// What a node holds, by index.
#[derive(Clone, Copy)]
pub(super) struct Held {
    pub(super) mesh: Option<usize>,
    pub(super) copies: Option<Copies>,
    pub(super) camera: Option<usize>,
    pub(super) light: Option<usize>,
}

/// The nodes of a file.
pub(super) struct Forest {
    pub(super) nodes: Vec<Node>,
    /// As many as nodes.
    pub(super) held: Vec<Held>,
    parents: Vec<Option<usize>>,
}

impl Forest {
    /// Reads all nodes.
    pub(super) fn read(document: &Document, counts: &Counts, notes: &mut Notes) -> Result<Forest, Fault> {
        let list = document.list("nodes")?;
        let mut forest = Forest { nodes: Vec::new(), held: Vec::new(), parents: vec![None; list.len()] };
        for (index, element) in list.elements().enumerate() {
            let element = element?;
            let json = element.json();
            let children = forest.children(json, index)?;
            forest.nodes.push(Node { name: json.name()?, children, matrix: transform::local(json)? });
            forest.held.push(held(json, counts, notes)?);
        }
        forest.place()?;
        Ok(forest)
    }

    /// Reads the children of a node.
    fn children(&mut self, json: Json, parent: usize) -> Result<Vec<usize>, Fault> {
        let child = |json: Json| {
            let child = json.as_index(self.parents.len(), "nodes")?;
            match self.parents.get_mut(child) {
                Some(Some(other)) => {
                    Err(json.fault(format!("node {child} is a child of node {other} already")))
                }
                Some(place) => {
                    *place = Some(parent);
                    Ok(child)
                }
                None => Err(json.fault("it does not exist")),
            }
        };
        json.list("children")?.into_iter().map(child).collect()
    }

    /// Multiplies the matrices of nodes by those above them, from the roots on.
    fn place(&mut self) -> Result<(), Fault> {
        let roots = self.roots();
        let mut open: Vec<(usize, usize, DAffine3)> =
            roots.into_iter().rev().map(|root| (root, 1, DAffine3::IDENTITY)).collect();
        let mut reached = vec![false; self.nodes.len()];
        while let Some((index, depth, parent)) = open.pop() {
            let (Some(node), Some(mark)) = (self.nodes.get_mut(index), reached.get_mut(index)) else {
                continue;
            };
            *mark = true;
            let fault = |what: String| Err(Fault::new(format!("/nodes/{index}"), what));
            if depth > MOST_DEEP {
                return fault(format!("it is more than {MOST_DEEP} nodes deep"));
            }
            node.matrix = parent * node.matrix;
            if !node.matrix.is_finite() {
                return fault("its matrix, times those above it, has numbers that are not finite".to_owned());
            }
            open.extend(node.children.iter().map(|child| (*child, depth + 1, node.matrix)));
        }
        match reached.iter().position(|reached| !reached) {
            Some(index) => Err(self.circle(index)),
            None => Ok(()),
        }
    }

    /// Returns the fault of a circle, found upwards from a node that no root reaches.
    fn circle(&self, start: usize) -> Fault {
        let above = |index: &usize| self.parents.get(*index).copied().flatten();
        // After as many steps as there are nodes, the way is within the circle.
        let on_it = std::iter::successors(Some(start), above).nth(self.nodes.len()).unwrap_or(start);
        Fault::new(format!("/nodes/{on_it}/children"), "the node is below itself")
    }

    /// Returns the nodes without a parent.
    fn roots(&self) -> Vec<usize> {
        let roots = self.parents.iter().enumerate().filter(|(_, parent)| parent.is_none());
        roots.map(|(index, _)| index).collect()
    }

    /// Reads all scenes; without any, returns one of all nodes.
    pub(super) fn scenes(&self, document: &Document, notes: &mut Notes) -> Result<Vec<Scene>, Fault> {
        let root = |json: Json| {
            let index = json.as_index(self.nodes.len(), "nodes")?;
            match self.parents.get(index) {
                Some(Some(parent)) => {
                    Err(json.fault(format!("node {index} is a child of node {parent}; scenes list roots")))
                }
                _ => Ok(index),
            }
        };
        let mut scenes = Vec::new();
        for element in document.list("scenes")?.elements() {
            let element = element?;
            let json = element.json();
            let roots = json.list("nodes")?.into_iter().map(root).collect::<Result<Vec<_>, _>>()?;
            let mut listed = HashSet::new();
            let again = roots.iter().filter(|index| !listed.insert(**index)).count();
            if again > 0 {
                notes.add_many("a scene lists a node again; it is drawn once", again, || json.pointer());
            }
            scenes.push(Scene { name: json.name()?, roots });
        }
        if scenes.is_empty() {
            scenes.push(Scene { name: String::new(), roots: self.roots() });
        }
        Ok(scenes)
    }
}

/// Reads what a node holds.
fn held(json: Json, counts: &Counts, notes: &mut Notes) -> Result<Held, Fault> {
    let mesh = json.index("mesh", counts.meshes, "meshes")?;
    if mesh.is_some() && json.get("skin").is_some() {
        notes.add("skins are ignored; the mesh stands where its node is", || json.pointer());
    }
    let light = match json.extension("KHR_lights_punctual")? {
        Some(extension) => extension.index("light", counts.lights, "lights")?,
        None => None,
    };
    Ok(Held {
        mesh,
        copies: Copies::read(json, counts.accessors)?,
        camera: json.index("camera", counts.cameras, "cameras")?,
        light,
    })
}
