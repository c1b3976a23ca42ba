//! glTF 2.0. Input: the bytes of a .glb or .gltf file and a way to read the buffers beside it. Output: its geometry,
//! where it stands, its materials and textures, cameras and lights, all as the file has them; images are neither
//! decoded nor opened. Nothing here knows a scene or a device.

mod accessor;
mod attribute;
mod buffers;
mod document;
mod extensions;
mod file;
mod images;
mod instances;
mod json;
mod material;
mod model;
mod nodes;
mod notes;
mod primitive;
mod stage;
mod topology;
mod transform;
mod uri;

#[cfg(test)]
mod tests;

pub use images::{Content, Image, Sampler, Texture, Weighting, Wrap};
pub use material::{AlphaMode, Material, TextureRef, TextureTransform};
pub use model::{Instance, Model, Node, Primitive, Scene};
pub use stage::{Camera, Light, LightKind, Projection};

use accessor::Accessors;
use buffers::{Buffers, Resolve};
use document::Document;
use nodes::{Counts, Forest, Held};
use notes::Notes;

use super::Fault;

/// Reads a file of at most `most` triangles in all instances together, including those without an area. `resolve`
/// returns the bytes of a buffer in a file of its own, by a path that is relative to the folder of the glTF file and
/// stays in it, or says why it cannot.
pub fn read(bytes: &[u8], most: usize, resolve: Resolve) -> Result<Model, Fault> {
    let file = file::split(bytes)?;
    let document = Document::read(file.text)?;
    let ignored = extensions::check(&document)?;
    let mut notes = Notes::default();
    if document.list("animations")?.len() > 0 {
        notes.add("animations are ignored", || "/animations".to_owned());
    }
    let buffers = Buffers::read(&document, file.binary, &mut notes, resolve)?;
    let images = images::images(&document, &buffers)?;
    let samplers = images::samplers(&document)?;
    let textures = images::textures(&document, images.len(), samplers.len())?;
    let materials = material::materials(&document, textures.len(), &mut notes)?;
    let cameras = stage::cameras(&document)?;
    let lights = stage::lights(&document)?;

    let mut accessors = Accessors::new(&document, &buffers)?;
    let counts = Counts {
        meshes: document.list("meshes")?.len(),
        cameras: cameras.len(),
        lights: lights.len(),
        accessors: accessors.len(),
    };
    let forest = Forest::read(&document, &counts, &mut notes)?;
    let scenes = forest.scenes(&document, &mut notes)?;
    let root = document.members(&["scene"])?;
    let default_scene = root.json().index("scene", scenes.len(), "scenes")?.unwrap_or(0);
    let drawn = instances::read(&document, &forest, &mut accessors, materials.len(), most, &mut notes)?;
    let at_node = |kind: fn(&Held) -> Option<usize>| {
        let holders = forest.held.iter().map(kind).zip(&forest.nodes).enumerate();
        holders.filter_map(|(node, (held, frame))| Some((held?, node, frame.matrix)))
    };
    let cameras = at_node(|held| held.camera)
        .filter_map(|(index, node, matrix)| Some(Camera { node, matrix, ..cameras.get(index)?.clone() }))
        .collect();
    let lights = at_node(|held| held.light)
        .filter_map(|(index, node, matrix)| Some(Light { node, matrix, ..lights.get(index)?.clone() }))
        .collect();
    Ok(Model {
        scenes,
        default_scene,
        primitives: drawn.primitives,
        instances: drawn.instances,
        degenerate: notes.count(primitive::WITHOUT_AREA),
        materials,
        textures,
        samplers,
        images,
        cameras,
        lights,
        nodes: forest.nodes,
        notes: notes.sentences().chain(ignored).collect(),
    })
}
