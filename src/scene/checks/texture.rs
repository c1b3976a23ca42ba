//! Checks of textures: whether content and dimension match, and the parameters of patterns. No file is opened here.

use super::super::limits::{
    ASPECT, COLOR, COORDINATE, DIMENSIONS, DISTORTION, GAIN, LACUNARITY, MAX_TEXELS, TEXELS, UNIT,
};
use super::super::refusal::{Check, Key};
use crate::texture::data::{ColorSpace, Dimension};
use crate::texture::formats::is_container_name;
use crate::texture::open_file::is_volume;
use crate::texture::procedural::{MAX_OCTAVES, Procedural, ProceduralKind};
use crate::texture::source::{TextureContent, TextureSource};

pub fn texture(key: Key, source: &TextureSource) -> Check {
    match &source.content {
        TextureContent::Procedural(pattern) => return procedural(key, pattern),
        TextureContent::Ramp(colors) => {
            key.of("ramp").count(colors.len(), "colors", MAX_TEXELS)?;
            for (i, color) in colors.iter().enumerate() {
                key.of("ramp").at(i).numbers_f32(color, &COORDINATE)?;
            }
        }
        TextureContent::Slices(files) => key.of("slices").count(files.len(), "files", MAX_TEXELS)?,
        TextureContent::Volume(volume) => {
            for (i, &side) in volume.size.iter().enumerate() {
                key.of("volume.size").at(i).integer(side, &TEXELS)?;
            }
        }
        TextureContent::Texels(texels) => {
            let bytes = texels.width as usize * texels.height as usize * texels.format.bytes_per_texel();
            key.of("width").integer(texels.width, &TEXELS)?;
            key.of("height").integer(texels.height, &TEXELS)?;
            if texels.bytes.len() != bytes {
                let what = format!(
                    "{}×{} texels of {} are {bytes} bytes; {} were given",
                    texels.width,
                    texels.height,
                    texels.format,
                    texels.bytes.len()
                );
                return key.of("texels").refuse(what, "not as many bytes");
            }
        }
        TextureContent::File(_)
        | TextureContent::Cutout { .. }
        | TextureContent::Tiles(_)
        | TextureContent::Embedded(..)
        | TextureContent::FirstOf(_)
        | TextureContent::CubeFile(..)
        | TextureContent::Faces(_) => {}
    }
    dimension(key.of("dimension"), source)?;
    if source.color_space == ColorSpace::Srgb && matches!(source.content, TextureContent::Ramp(_)) {
        let what = "the numbers of a ramp are linear light, not sRGB; leave color_space out";
        return key.of("color_space").refuse(what, "ramps are linear");
    }
    let reason = match source.dimension {
        Dimension::One => "a texture of dimension \"1d\" has no v to flip",
        Dimension::Cube => "the rows of a cube's faces are fixed by its table; flip the pictures themselves",
        Dimension::Two | Dimension::Three => return Ok(()),
    };
    if source.flip_v {
        return key.of("flip_v").refuse(format!("{reason}; leave flip_v out"), "nothing to flip");
    }
    Ok(())
}

/// Returns the dimension of the content, except for a single picture, which may be anything but a volume.
fn dimension(key: Key, source: &TextureSource) -> Check {
    let (name, implied, reason) = match &source.content {
        TextureContent::Faces(_) => ("faces", Dimension::Cube, "faces are those of a cube"),
        TextureContent::Slices(_) => ("slices", Dimension::Three, "slices are those of a volume"),
        TextureContent::Volume(_) => ("volume", Dimension::Three, "volume has three axes"),
        TextureContent::Ramp(_) => ("ramp", Dimension::One, "ramp has one axis"),
        TextureContent::CubeFile(_, Some(_)) => {
            ("file", Dimension::Cube, "layout says how a file holds a cube")
        }
        TextureContent::File(file) | TextureContent::CubeFile(file, None) if is_volume(file) => {
            ("file", Dimension::Three, "an NRRD file is a volume")
        }
        TextureContent::CubeFile(_, None) => ("file", Dimension::Cube, "its picture holds the six faces"),
        TextureContent::File(file) if source.dimension == Dimension::Three && is_container_name(file) => {
            return Ok(());
        }
        TextureContent::File(_) if source.dimension == Dimension::Three => {
            let what = "a picture is no volume; give slices = [files], volume = { … } or a file of NRRD (.nrrd, .nhdr), \
                        DDS (.dds) or KTX2 (.ktx2)";
            return key.refuse(what, "not from one picture");
        }
        TextureContent::Texels(_) => ("texels", Dimension::Two, "texels are one picture"),
        TextureContent::Cutout { .. } => ("file", Dimension::Two, "such pictures are flat"),
        TextureContent::Tiles(_) => ("file", Dimension::Two, "tiles are those of one flat picture"),
        TextureContent::Embedded(..) | TextureContent::FirstOf(_) => {
            ("file", Dimension::Two, "an embedded picture is flat")
        }
        TextureContent::File(_) | TextureContent::Procedural(_) => return Ok(()),
    };
    if source.dimension == implied {
        return Ok(());
    }
    let what =
        format!("\"{}\" contradicts {name}: {reason}, so the dimension is \"{implied}\"", source.dimension);
    key.refuse(what, format!("is \"{implied}\""))
}

fn procedural(key: Key, pattern: &Procedural) -> Check {
    for (i, color) in pattern.colors.iter().enumerate() {
        key.of("colors").at(i).numbers_f32(color, &COLOR)?;
    }
    key.of("octaves").integer(pattern.octaves, &(1..=MAX_OCTAVES))?;
    key.of("dimensions").integer(pattern.dimensions, &DIMENSIONS)?;
    for (name, number, limits) in [
        ("lacunarity", pattern.lacunarity, LACUNARITY),
        ("gain", pattern.gain, GAIN),
        ("width", pattern.width, UNIT),
        ("distortion", pattern.distortion, DISTORTION),
        ("aspect", pattern.aspect, ASPECT),
        ("offset", pattern.offset, UNIT),
        ("jitter", pattern.jitter, UNIT),
    ] {
        key.of(name).number_f32(number, &limits)?;
    }
    joints_fit(key, pattern)
}

/// Joints as wide as a brick would leave no brick.
fn joints_fit(key: Key, pattern: &Procedural) -> Check {
    let (width, aspect) = (pattern.width, pattern.aspect);
    if pattern.kind != ProceduralKind::Brick || width < aspect.min(1.0) {
        return Ok(());
    }
    let what =
        format!("joints of width {width} leave nothing of bricks of {aspect} × 1; use a width below both");
    // If the joints have their default, the bricks are too small.
    let cause = if width == Procedural::new(pattern.kind).width { "aspect" } else { "width" };
    key.of(cause).refuse(what, "no room for bricks")
}
