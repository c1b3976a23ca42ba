//! Pictures and textures of one pixel or texel along a side and of very many, on the device and in
//! the oracle: all pixels of strips, and the corners of the largest picture. The error is the
//! largest difference of a channel relative to the change for half an ulp of the coordinate: |d -
//! o| / (2⁻²⁴ (1 + n)), n texels along the longest side.

use super::case::{Bench, Case, Point};
use super::scenes::{hashed_unit, in_oracle, on_device, packed, texture};
use crate::core::error::Result;
use crate::core::film::Film;
use crate::core::range::Rect;
use crate::scene::MAX_SIZE;
use crate::texture::data::{Dimension, TextureData};

const GROUP: &str = "sizes";
const UNIT: &str = "half ulps";
const BOUND: f64 = 24.0;
const REASON: &str = "texels lie in [0, 1], so that each of three coordinates moves a value by no more than it moves in \
                      texels; each is off by the roundings of a ray, a hit and a mapping: at most 8 half ulps of 1";
const HALF_ULP: f64 = 1.0 / 16_777_216.0;
/// The texels along each side of the textures of pictures.
const TEXELS: u32 = 16;
const SIDES: [u32; 10] = [1, 2, 3, 16, 127, 1024, 4096, 4097, 16383, 16384];

pub fn cases() -> Vec<Case> {
    let case = |name, parameter, run| Case {
        group: GROUP,
        name,
        parameter,
        unit: UNIT,
        bound: BOUND,
        reason: REASON,
        run,
    };
    vec![
        case("wide-pictures", "pixels along the row", wide_pictures),
        case("high-pictures", "pixels along the column", high_pictures),
        case("corners", "first pixel of a crop of 16384 × 16384", corners),
        case("wide-textures", "texels along the row", wide_textures),
        case("high-textures", "texels along the column", high_textures),
        case("volumes", "texels along the longest side", volumes),
        case("cubes", "texels along the side", cubes),
    ]
}

fn noise(dimension: Dimension, size: [u32; 3]) -> TextureData {
    texture(dimension, size, |i| hashed_unit(i, 11) as f32)
}

/// Returns a picture of a plane that shows the texture's square from `low` to 1 + `low` in u and v.
fn flat([width, height]: [u32; 2], low: f64) -> String {
    let aspect = f64::from(width) / f64::from(height);
    format!(
        "{}[[texture]]\nname = \"t\"\nfile = \"t.exr\"\n\
         [[plane]]\norigin = [{:?}, {:?}, 0.0]\ntangent = [{aspect:?}, 0.0, 0.0]\nbitangent = [0.0, -1.0, 0.0]\n\
         material = \"m\"\n",
        head([width, height], 1.0, ""),
        aspect * (-0.5 - low),
        0.5 + low
    )
}

fn head([width, height]: [u32; 2], view: f64, mapping: &str) -> String {
    format!(
        "[camera]\neye = [0.0, 0.0, 3.0]\nlook_at = [0.0, 0.0, 0.0]\northographic_height = {view:?}\n\
         [image]\nwidth = {width}\nheight = {height}\n[sampling]\npattern = \"random\"\nspp = 4\n\
         [[sampler]]\nname = \"s\"\nfilter = \"linear\"\n\
         [[material]]\nname = \"m\"\nmodel = \"unlit\"\ntexture = \"t\"\nsampler = \"s\"\n{mapping}\n"
    )
}

/// Compares the device's picture with the oracle's.
fn compared(
    bench: &Bench<'_>,
    text: &str,
    texture: TextureData,
    crop: Option<Rect>,
) -> Result<Vec<(f64, String)>> {
    let longest = texture.width.max(texture.height).max(texture.depth);
    let scene = packed(text, vec![texture], crop)?;
    let (device, oracle) = (on_device(bench, &scene)?, in_oracle(bench, &scene)?);
    let unit = HALF_ULP * f64::from(1 + longest);
    Ok(differences(&device, &oracle).map(|(d, place)| (d / unit, place)).collect())
}

fn differences<'a>(a: &'a Film, b: &'a Film) -> impl Iterator<Item = (f64, String)> + 'a {
    let worst = |(a, b): (&[f32; 3], &[f32; 3])| {
        let apart = a.iter().zip(b).map(|(a, b)| (f64::from(*a) - f64::from(*b)).abs());
        apart.fold(0.0, |worst: f64, d| if d.is_nan() { f64::INFINITY } else { worst.max(d) })
    };
    let width = a.width as usize;
    let pixels = a.pixels.iter().zip(&b.pixels).enumerate();
    let size = format!("{}×{}", a.width, a.height);
    pixels.map(move |(i, pair)| (worst(pair), format!("pixel ({}, {}) of {size}", i % width, i / width)))
}

fn pictures(bench: &Bench<'_>, size: fn(u32) -> [u32; 2]) -> Result<Vec<Point>> {
    let point = |&side: &u32| {
        let texture = noise(Dimension::Two, [TEXELS, TEXELS, 1]);
        Ok(Point::worst(f64::from(side), compared(bench, &flat(size(side), 0.0), texture, None)?))
    };
    SIDES.iter().map(point).collect()
}

fn wide_pictures(bench: &Bench<'_>) -> Result<Vec<Point>> {
    pictures(bench, |side| [side, 1])
}

fn high_pictures(bench: &Bench<'_>) -> Result<Vec<Point>> {
    pictures(bench, |side| [1, side])
}

fn corners(bench: &Bench<'_>) -> Result<Vec<Point>> {
    const CROP: u32 = 48;
    let point = |first: u32| {
        let at = |x: u32, y: u32| {
            let texture = noise(Dimension::Two, [TEXELS, TEXELS, 1]);
            let crop = Rect { x, y, width: CROP, height: CROP };
            compared(bench, &flat([MAX_SIZE; 2], 0.0), texture, Some(crop))
        };
        let errors = [at(first, 0)?, at(first, MAX_SIZE - CROP)?].concat();
        Ok(Point::worst(f64::from(first), errors))
    };
    [0, 1, 63, 1000, 8191, MAX_SIZE - CROP].into_iter().map(point).collect()
}

fn textures(bench: &Bench<'_>, size: fn(u32) -> [u32; 3]) -> Result<Vec<Point>> {
    let point = |&side: &u32| {
        let errors = compared(bench, &flat([64, 64], 0.3), noise(Dimension::Two, size(side)), None)?;
        Ok(Point::worst(f64::from(side), errors))
    };
    SIDES.iter().map(point).collect()
}

fn wide_textures(bench: &Bench<'_>) -> Result<Vec<Point>> {
    textures(bench, |side| [side, 1, 1])
}

fn high_textures(bench: &Bench<'_>) -> Result<Vec<Point>> {
    textures(bench, |side| [1, side, 1])
}

/// Part of a sphere without its silhouette.
const SPHERE: &str = "[[sphere]]\ncenter = [0.0, 0.0, 0.0]\nradius = 2.0\nmaterial = \"m\"\n";

fn volumes(bench: &Bench<'_>) -> Result<Vec<Point>> {
    let mapping = "mapping = { kind = \"solid\", scale = [0.25, 0.25, 0.25], offset = [0.5, 0.5, 0.5] }";
    let texture = "[[texture]]\nname = \"t\"\nvolume = { file = \"t.raw\", size = [1, 1, 1], format = \"rgba-float\" }\n";
    let text = head([48, 48], 3.0, mapping) + texture + SPHERE;
    let sizes = [[1, 1, 1], [2, 1, 1], [3, 5, 7], [1, 64, 1], [256, 1, 1], [1, 1, 2048]];
    let point = |size: [u32; 3]| {
        let longest = size.into_iter().fold(1, u32::max);
        Ok(Point::worst(f64::from(longest), compared(bench, &text, noise(Dimension::Three, size), None)?))
    };
    sizes.into_iter().map(point).collect()
}

/// Sweeps a view in which three faces and their corner are in the picture.
fn cubes(bench: &Bench<'_>) -> Result<Vec<Point>> {
    let mapping = "mapping = { kind = \"cube\", entity = \"normal\", axis = [0.6, 0.5, -0.4] }";
    let texture = "[[texture]]\nname = \"t\"\nfile = \"t.exr\"\ndimension = \"cube\"\n";
    let text = head([48, 48], 3.0, mapping) + texture + SPHERE;
    let point = |&side: &u32| {
        Ok(Point::worst(
            f64::from(side),
            compared(bench, &text, noise(Dimension::Cube, [side, side, 6]), None)?,
        ))
    };
    [1, 2, 3, 16, 255, 1024].iter().map(point).collect()
}
