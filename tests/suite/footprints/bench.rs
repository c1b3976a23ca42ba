//! Textures of every kind, scenes of (texture, sampler) pairs with footprints, and textures whose
//! levels contain only their own number.

use std::path::Path;

use glam::{DMat2, DVec2, DVec3};
use moire::internal::lab::probe::{self, LookupQuery};
use moire::internal::lab::verify::queries;
use moire::internal::oracle::filter::sample_texture;
use moire::internal::oracle::mapping::Coordinate;
use moire::internal::pack::{self, PackedScene};
use moire::internal::scene::model::{Footprint, TextureSource};
use moire::internal::scene::parse;
use moire::internal::scene::prune::prune;
use moire::internal::schema::layout::Texture;
use moire::internal::texture::data::{ColorSpace, Dimension, TexelFormat, TextureData};
use moire::internal::texture::sampler_spec::SamplerSpec;

use crate::lookup::bench::{Rng, texture};
use crate::stage::device;

/// Random texels; the third size counts slices, or the faces of a cube.
pub fn solid(dimension: Dimension, [width, height, depth]: [u32; 3], format: TexelFormat) -> TextureData {
    let flat = texture(width, height * depth, format, ColorSpace::Linear, u64::from(width + depth));
    TextureData { dimension, height, depth, name: dimension.to_string(), ..flat }
}

pub fn pairs_of(
    footprint: Footprint,
    textures: Vec<TextureData>,
    samplers: &[SamplerSpec],
    pairs: &[(usize, usize)],
) -> PackedScene {
    queries::pairs_over(footprint, textures, samplers, pairs).unwrap()
}

/// Each texel of a grey float texture becomes the number of its level.
pub fn paint_levels(scene: &mut PackedScene, texture: usize) {
    let Texture { first_word, format, levels, .. } = scene.records.textures[texture];
    assert_eq!(format, TexelFormat::GreyFloat);
    for level in 0..levels {
        let bytes = scene.level_texels(texture, level).len();
        let start = scene.level_word(first_word, level) as usize * 4;
        let texels = (level as f32).to_ne_bytes().repeat(bytes / 4);
        scene.texels[start..start + bytes].copy_from_slice(&texels);
    }
}

/// Returns a query's coordinate and footprint for the oracle.
pub fn coordinate(query: &LookupQuery) -> Coordinate {
    let wide = |v: [f32; 4]| DVec3::new(v[0].into(), v[1].into(), v[2].into());
    Coordinate { at: wide(query.uv), change: [wide(query.dx), wide(query.dy)] }
}

pub fn narrow(v: DVec3) -> [f32; 4] {
    v.as_vec3().extend(0.0).to_array()
}

/// The oracle's answer to query number `index` of a list.
pub fn expected(scene: &PackedScene, query: &LookupQuery, index: usize, c: &Coordinate) -> [f64; 4] {
    let (image, how) =
        (&scene.records.textures[query.texture as usize], &scene.records.samplers[query.sampler as usize]);
    let random = moire::internal::oracle::rng::pcg2d([index as u32, query.seed]);
    sample_texture(scene, image, how, c, random).to_array()
}

pub fn answers(scene: &PackedScene, queries: &[LookupQuery]) -> Vec<[f32; 4]> {
    probe::lookups(&device(), scene, false, false, queries).unwrap()
}

/// Returns the changes over a footprint with these axes, rotated by `angle` on the texture; `roll` is the direction of
/// x over the footprint, which changes nothing but the two vectors.
pub fn axes(major: f64, minor: f64, angle: f64, roll: f64) -> [DVec2; 2] {
    let m =
        DMat2::from_angle(angle) * DMat2::from_diagonal(DVec2::new(major, minor)) * DMat2::from_angle(roll);
    [m.x_axis, m.y_axis]
}

/// A random angle in radians.
pub fn angle(rng: &mut Rng) -> f64 {
    rng.between(0.0, std::f64::consts::TAU)
}

const VIEW: &str = "camera = { eye = [0.5, 0.7, 6.0], look_at = [0, 0, 0], vertical_fov = 24 }
image = { width = 40, height = 40 }
";

/// A material 'm' whose texture 't' fits the mapping, with its axis towards the viewer: the pole and the
/// seam that begins there are in sight.
pub fn place_of(kind: &str, entity: &str) -> String {
    let texture = match kind {
        "solid" => "slices = ['a']",
        "cube" => "file = 'a'\ndimension = 'cube'",
        _ => "file = 'a'",
    };
    // A cube's faces, all with the one picture.
    let kind = if kind == "box" { "cube" } else { kind };
    let frame = match entity {
        "" => String::new(),
        "normal" | "reflection" => format!(", entity = '{entity}', axis = [0.3, 0.5, 1.0]"),
        _ => format!(", entity = '{entity}', axis = [0.3, 0.5, 1.0], origin = [0.1, 0.05, 0.2]"),
    };
    format!(
        "[[texture]]\nname = 't'\n{texture}\n[[sampler]]\nname = 's'\nmip = 'linear'\n[[material]]\nname = 'm'\n\
         model = 'unlit'\ntexture = 't'\nsampler = 's'\nmapping = {{ kind = '{kind}'{frame} }}\n"
    )
}

/// The scene of a text without camera, its textures painted with the numbers of their levels.
pub fn level_scene(text: &str, footprint: &str) -> PackedScene {
    let text = format!("{VIEW}{text}[sampling]\npattern = 'center'\nfootprint = '{footprint}'\n");
    let mut scene = parse(Path::new("levels.toml"), &text).unwrap_or_else(|e| panic!("{e}\n{text}"));
    prune(&mut scene);
    let texture = |source: &TextureSource| {
        let size = match source.dimension {
            Dimension::Three => [64, 64, 64],
            Dimension::Cube => [256, 256, 6],
            Dimension::One | Dimension::Two => [1024, 512, 1],
        };
        solid(source.dimension, size, TexelFormat::GreyFloat)
    };
    let textures: Vec<TextureData> = scene.textures.iter().map(texture).collect();
    let mut packed = pack::pack(&scene, textures, None).unwrap();
    (0..packed.records.textures.len()).for_each(|t| paint_levels(&mut packed, t));
    packed
}
