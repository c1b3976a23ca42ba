//! The files of `data/gallery`: `all()` returns every one that `cargo run --release --example make_gallery` writes. A
//! test, which includes this module too, compares the files with them.

pub mod document;
mod geometry;
mod looks;
pub mod pictures;
pub mod shapes;
mod stage;
mod surfaces;
mod textures;

use document::Document;

/// A file of the gallery.
pub struct File {
    pub name: &'static str,
    pub bytes: Vec<u8>,
}

/// What puts a feature into a file.
type Build = fn(&mut Document);

/// Returns every file.
pub fn all() -> Vec<File> {
    let text: [(&str, Build); 22] = [
        ("transforms.gltf", geometry::transforms),
        ("accessors.gltf", geometry::accessors),
        ("cameras.gltf", stage::cameras),
        ("lights.gltf", stage::lights),
        ("samplers.gltf", textures::samplers),
        ("texture_transform.gltf", textures::transforms),
        ("uv_sets.gltf", textures::uv_sets),
        ("texture_formats.gltf", textures::formats),
        ("sixteen_bits.gltf", textures::sixteen_bits),
        ("vertex_colors.gltf", surfaces::vertex_colors),
        ("alpha.gltf", surfaces::alpha),
        ("sides.gltf", surfaces::sides),
        ("normal_map.gltf", surfaces::normal_map),
        ("occlusion.gltf", surfaces::occlusion),
        ("metallic_roughness.gltf", looks::metallic_roughness),
        ("metallic_roughness_map.gltf", looks::metallic_roughness_map),
        ("specular.gltf", looks::specular),
        ("specular_map.gltf", looks::specular_map),
        ("glass.gltf", looks::glass),
        ("transmission.gltf", looks::transmission),
        ("emissive.gltf", looks::emissive),
        ("unlit.gltf", looks::unlit),
    ];
    let binary: [(&str, Build); 2] =
        [("quantized.glb", geometry::quantized), ("instancing.glb", geometry::instancing)];
    let made = |build: Build| {
        let mut document = Document::default();
        build(&mut document);
        document
    };
    let text = text.into_iter().map(|(name, build)| File { name, bytes: made(build).text() });
    text.chain(binary.into_iter().map(|(name, build)| File { name, bytes: made(build).glb() })).collect()
}
