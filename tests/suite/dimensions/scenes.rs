//! `[[texture]]` as written in scenes: the defaults of each kind of content, and contradictory
//! keys.

use std::path::{Path, PathBuf};

use moire::internal::scene::model::{TextureContent, TextureSource};
use moire::internal::scene::parse;
use moire::internal::texture::data::{Dimension, MipKernel, TexelFormat};
use moire::internal::texture::source::{CubeLayout, Endian, VolumeSource};

use super::assert_says;

fn texture(keys: &str) -> moire::internal::core::error::Result<TextureSource> {
    let head =
        "[camera]\neye = [0, 0, 1]\nlook_at = [0, 0, 0]\nvertical_fov = 60\n[image]\nwidth = 8\nheight = 8\n";
    let text = format!("{head}[[texture]]\nname = 't'\n{keys}\n");
    parse(Path::new("scenes/a.toml"), &text).map(|mut scene| scene.textures.remove(0))
}

fn at(name: &str) -> PathBuf {
    Path::new("scenes").join(name)
}

#[test]
fn contents_imply_their_dimension() {
    let faces = ["a", "b", "c", "d", "e", "f"].map(at);
    let volume = VolumeSource {
        file: at("v.raw"),
        size: [4, 5, 6],
        format: TexelFormat::GreyFloat,
        offset: 352,
        endian: Endian::Big,
    };
    let bare =
        VolumeSource { format: TexelFormat::Grey8, offset: 0, endian: Endian::Little, ..volume.clone() };
    let cross = CubeLayout::VerticalCross;
    for (keys, dimension, content) in [
        ("file = 'a.png'", Dimension::Two, TextureContent::File(at("a.png"))),
        ("file = 'a.png'\ndimension = '1d'", Dimension::One, TextureContent::File(at("a.png"))),
        ("file = 'a.NRRD'", Dimension::Three, TextureContent::File(at("a.NRRD"))),
        ("file = 'a.nhdr'\ndimension = '3d'", Dimension::Three, TextureContent::File(at("a.nhdr"))),
        ("file = 'a.png'\ndimension = 'cube'", Dimension::Cube, TextureContent::CubeFile(at("a.png"), None)),
        (
            "file = 'a.png'\nlayout = 'vertical-cross'",
            Dimension::Cube,
            TextureContent::CubeFile(at("a.png"), Some(cross)),
        ),
        ("faces = ['a', 'b', 'c', 'd', 'e', 'f']", Dimension::Cube, TextureContent::Faces(faces)),
        ("slices = ['a', 'b']", Dimension::Three, TextureContent::Slices(vec![at("a"), at("b")])),
        (
            "ramp = [[0, 0.5, 1], [1, 2, 3, 0.25]]",
            Dimension::One,
            TextureContent::Ramp(vec![[0.0, 0.5, 1.0, 1.0], [1.0, 2.0, 3.0, 0.25]]),
        ),
        (
            "volume = { file = 'v.raw', size = [4, 5, 6], format = 'grey-float', offset = 352, endian = 'big' }",
            Dimension::Three,
            TextureContent::Volume(volume),
        ),
        (
            "volume = { file = 'v.raw', size = [4, 5, 6], format = 'grey8' }\ndimension = '3d'",
            Dimension::Three,
            TextureContent::Volume(bare),
        ),
    ] {
        let t = texture(keys).unwrap();
        assert_eq!((t.dimension, t.content), (dimension, content), "{keys}");
        assert_eq!((t.mip_kernel, t.flip_v), (MipKernel::Box, false), "{keys}");
    }
    assert_eq!(texture("file = 'a'\nmip_filter = 'kaiser'").unwrap().mip_kernel, MipKernel::Kaiser);
    let files = texture("faces = ['a', 'b', 'c', 'd', 'e', 'f']").unwrap().content;
    assert_eq!(files.files().len(), 6);
}

#[test]
fn keys_that_contradict_each_other_are_refused_with_the_reason() {
    let cases: &[(&str, &[&str])] = &[
        ("", &[":8:1:", "texture.file", "missing", "file, faces, slices, volume, ramp"]),
        ("file = 'a'\nslices = ['b']", &[":11:10:", "texture.slices", "file is given too", "exactly one"]),
        ("file = 'a'\nramp = [[0, 0, 0]]", &["texture.ramp", "file is given too"]),
        ("faces = ['a', 'b']", &["texture.faces", "6 files", "+x, -x, +y, -y, +z and -z"]),
        ("faces = ['a', 'b', 'c', 'd', 'e', 6]", &["texture.faces[5]", "found 6"]),
        ("slices = []", &["texture.slices", "1 to 65536 files"]),
        ("slices = ['a', '']", &["texture.slices[1]", "not empty"]),
        ("ramp = []", &["texture.ramp", "1 to 65536 colors"]),
        ("ramp = [[0, 0]]", &["texture.ramp[0]", "3 finite numbers"]),
        ("ramp = [[0, 0, nan, 1]]", &["texture.ramp[0]", "4 finite numbers"]),
        ("ramp = [[0, 0, 0]]\ncolor_space = 'srgb'", &["texture.color_space", "ramp are linear light"]),
        ("ramp = [[0, 0, 0]]\nflip_v = true", &["texture.flip_v", "\"1d\" has no v"]),
        ("ramp = [[0, 0, 0]]\ndimension = '2d'", &["texture.dimension", "\"2d\" contradicts ramp", "\"1d\""]),
        (
            "slices = ['a']\ndimension = 'cube'",
            &["texture.dimension", "\"cube\" contradicts slices", "\"3d\""],
        ),
        ("file = 'a.nrrd'\ndimension = '2d'", &["texture.dimension", "NRRD file is a volume"]),
        ("file = 'a.png'\ndimension = '3d'", &["texture.dimension", "a picture is no volume", "slices"]),
        ("file = 'a.png'\ndimension = '4d'", &["texture.dimension", "allowed: 1d, 2d, 3d, cube"]),
        ("file = 'a.png'\ndimension = 'cube'\nflip_v = true", &["texture.flip_v", "faces are fixed"]),
        (
            "file = 'a.png'\ndimension = '2d'\nlayout = 'vertical-cross'",
            &["texture.dimension", "layout says how a file holds a cube"],
        ),
        (
            "faces = ['a', 'b', 'c', 'd', 'e', 'f']\nlayout = 'vertical-cross'",
            &["texture.layout", "come from faces"],
        ),
        ("file = 'a.png'\nlayout = 'cross'", &["texture.layout", "\"cross\"", "horizontal-cross"]),
        ("file = 'a.png'\nmip_filter = 'lanczos'", &["texture.mip_filter", "allowed: box, kaiser"]),
        ("volume = 'v.raw'", &["texture.volume", "a table with the keys file, size, format"]),
        ("volume = { file = 'v', format = 'grey8' }", &["texture.volume.size", "missing"]),
        (
            "volume = { file = 'v', size = [1, 2], format = 'grey8' }",
            &["volume.size", "width, height and depth"],
        ),
        (
            "volume = { file = 'v', size = [1, 0, 2], format = 'grey8' }",
            &["volume.size[1]", "from 1 to 65536"],
        ),
        ("volume = { file = 'v', size = [1, 1, 2], format = 'uint8' }", &["volume.format", "allowed: grey8"]),
        (
            "volume = { file = 'v', size = [1, 1, 2], format = 'grey8', offset = -1 }",
            &["volume.offset", "from 0"],
        ),
        (
            "volume = { file = 'v', size = [1, 1, 2], format = 'grey8', endian = 'native' }",
            &["volume.endian", "allowed: little, big"],
        ),
    ];
    for (keys, words) in cases {
        let message = texture(keys).err().unwrap_or_else(|| panic!("accepted: {keys}")).to_string();
        assert_says(&message, words);
    }
}
