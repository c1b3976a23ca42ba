//! Images of glTF in the formats of extensions: WebP, DDS and KTX2, beside the file and within it, in place of a picture
//! that every program reads, which is taken where theirs cannot be.

use std::fs;

use base64::Engine as _;
use moire::internal::scene::load as load_scene;
use moire::internal::scene::model::Scene;
use moire::internal::texture::data::{ColorSpace, Dimension};
use moire::internal::texture::decode::AllowedFloats;
use moire::internal::texture::load::{load, load_with_notes};
use moire::internal::texture::source::{ReadOptions, TextureContent};
use tempfile::{TempDir, tempdir};

use super::write::{DXGI_RGBA8, Dds, Ktx2, VK_RGBA8};
use crate::support::{data, texture_source, told};

/// The scene of one triangle with a base colour of these images, whose first texel is known.
fn scene(images: &str, texture: &str, files: &[(&str, Vec<u8>)]) -> Scene {
    let folder = stored(images, texture, files);
    let scene = load_scene(&folder.path().join("m.gltf")).unwrap();
    let texture = load(&scene.textures[0]).unwrap();
    assert_eq!(texture.color_space, ColorSpace::Srgb, "the slot says what values mean");
    assert_eq!(&texture.texels[..4], &[7, 8, 9, 255], "{images}");
    scene
}

/// A folder with these files and m.gltf, one triangle with a base colour of these images.
fn stored(images: &str, texture: &str, files: &[(&str, Vec<u8>)]) -> TempDir {
    let folder = tempdir().unwrap();
    for (name, bytes) in files {
        fs::write(folder.path().join(name), bytes).unwrap();
    }
    let corners: Vec<u8> =
        [0f32, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0].iter().flat_map(|x| x.to_le_bytes()).collect();
    let buffer = base64::engine::general_purpose::STANDARD.encode(&corners);
    let text = format!(
        "{{\"asset\":{{\"version\":\"2.0\"}},\"scene\":0,\"scenes\":[{{\"nodes\":[0]}}],\"nodes\":[{{\"mesh\":0}}],\
         \"extensionsUsed\":[\"EXT_texture_webp\",\"KHR_texture_basisu\",\"MSFT_texture_dds\"],\
         \"extensionsRequired\":[\"EXT_texture_webp\",\"KHR_texture_basisu\",\"MSFT_texture_dds\"],\
         \"images\":{images},\"textures\":[{texture}],\
         \"materials\":[{{\"pbrMetallicRoughness\":{{\"baseColorTexture\":{{\"index\":0}}}}}}],\
         \"meshes\":[{{\"primitives\":[{{\"attributes\":{{\"POSITION\":0}},\"material\":0}}]}}],\
         \"accessors\":[{{\"bufferView\":0,\"componentType\":5126,\"count\":3,\"type\":\"VEC3\",\
         \"min\":[0,0,0],\"max\":[1,1,0]}}],\"bufferViews\":[{{\"buffer\":0,\"byteLength\":36}}],\
         \"buffers\":[{{\"byteLength\":36,\"uri\":\"data:application/octet-stream;base64,{buffer}\"}}]}}"
    );
    fs::write(folder.path().join("m.gltf"), text).unwrap();
    folder
}

fn ktx2() -> Vec<u8> {
    Ktx2::flat(VK_RGBA8, [1, 1], &[vec![7, 8, 9, 255]]).bytes()
}

fn dds() -> Vec<u8> {
    Dds::flat(DXGI_RGBA8, [1, 1], &[7, 8, 9, 255]).bytes()
}

#[test]
fn dds_and_ktx2_are_read_beside_the_file_and_within_it() {
    let within = |bytes: Vec<u8>| {
        let text = base64::engine::general_purpose::STANDARD.encode(bytes);
        format!("[{{\"uri\":\"data:application/octet-stream;base64,{text}\"}}]")
    };
    let source = |extension: &str| format!("{{\"extensions\":{{\"{extension}\":{{\"source\":0}}}}}}");
    for (extension, name, bytes) in
        [("MSFT_texture_dds", "a.dds", dds()), ("KHR_texture_basisu", "a.ktx2", ktx2())]
    {
        let beside = format!("[{{\"uri\":\"{name}\"}}]");
        scene(&beside, &source(extension), &[(name, bytes.clone())]);
        let embedded = scene(&within(bytes), &source(extension), &[]);
        assert!(embedded.notes.iter().all(|note| !note.contains("left out")), "{:?}", embedded.notes);
    }
}

#[test]
fn the_format_of_an_extension_comes_first_and_the_picture_where_it_cannot_be_read() {
    let picture = || {
        let mut bytes = Vec::new();
        image::RgbaImage::from_pixel(1, 1, image::Rgba([7, 8, 9, 255]))
            .write_to(&mut std::io::Cursor::new(&mut bytes), image::ImageFormat::Png)
            .unwrap();
        bytes
    };
    let images = "[{\"uri\":\"a.png\"},{\"uri\":\"a.dds\"},{\"uri\":\"a.basis\"}]";
    let both = "{\"source\":0,\"extensions\":{\"MSFT_texture_dds\":{\"source\":1}}}";
    // Only the DDS file exists.
    scene(images, both, &[("a.dds", dds())]);
    let unreadable = "{\"source\":0,\"extensions\":{\"KHR_texture_basisu\":{\"source\":2}}}";
    scene(images, unreadable, &[("a.png", picture())]);
}

/// One texel in a format that is not read, and the first half of a file of one that is.
fn undecodable() -> [Vec<u8>; 2] {
    const VK_ASTC_4X4: u32 = 157;
    let whole = ktx2();
    [Ktx2::flat(VK_ASTC_4X4, [1, 1], &[vec![0; 16]]).bytes(), whole[..whole.len() - 2].to_vec()]
}

#[test]
fn a_picture_that_cannot_be_decoded_gives_way_to_the_one_beside_it() {
    let mut png = Vec::new();
    image::RgbaImage::from_pixel(1, 1, image::Rgba([7, 8, 9, 255]))
        .write_to(&mut std::io::Cursor::new(&mut png), image::ImageFormat::Png)
        .unwrap();
    let images = "[{\"uri\":\"a.png\"},{\"uri\":\"a.ktx2\"}]";
    let both = "{\"source\":0,\"extensions\":{\"KHR_texture_basisu\":{\"source\":1}}}";
    let alone = "{\"extensions\":{\"KHR_texture_basisu\":{\"source\":1}}}";
    for bytes in undecodable() {
        let folder = stored(images, both, &[("a.png", png.clone()), ("a.ktx2", bytes.clone())]);
        let scene = load_scene(&folder.path().join("m.gltf")).unwrap();
        let (texture, notes) = load_with_notes(&scene.textures[0], AllowedFloats::Finite).unwrap();
        assert_eq!(&texture.texels[..4], &[7, 8, 9, 255]);
        assert_eq!(notes.len(), 1, "{notes:?}");
        for word in ["/images/0/uri is read in place of /images/1/uri: ", "a.ktx2: "] {
            assert!(notes[0].contains(word), "{notes:?}");
        }
        let folder = stored(images, alone, &[("a.ktx2", bytes)]);
        let scene = load_scene(&folder.path().join("m.gltf")).unwrap();
        let said = told(load(&scene.textures[0]));
        assert!(said.contains("/images/1/uri: ") && said.contains("a.ktx2"), "{said}");
    }
}

#[test]
fn webp_is_read_from_within_a_file() {
    let webp = fs::read(data().join("pictures/lossless.webp")).unwrap();
    let content = TextureContent::Embedded("m.gltf (image 0)".into(), webp.into());
    let source = texture_source(content, Dimension::Two, ReadOptions::default());
    assert_eq!(load(&source).unwrap().width, 5);
}
