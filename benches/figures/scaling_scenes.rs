//! The scenes of `scaling.rs`: one for each amount of each kind of work, cheap in all other respects. Output: a scene file as
//! text, after the textures and meshes that it reads are written beside it.

use std::fmt::Write;
use std::fs;
use std::path::Path;

use crate::scaling::Kind;
use crate::{Outcome, meshes};

/// Pictures of the kinds that do not change them.
const SIDE: u32 = 256;
const SAMPLES: u32 = 4;
/// Side of a texture where their number counts.
const SMALL_TEXTURE: u32 = 64;
/// Quads that share the textures where their number counts.
const QUADS: u32 = 512;

pub const KINDS: [Kind; 9] = [
    Kind {
        name: "pixels",
        work: "pixels",
        points: &[64, 256, 1024, 4096, 16384],
        amount: |side| f64::from(side).powi(2),
        scene: |side, folder| ground(folder, side, 1, SIDE),
    },
    Kind {
        name: "samples",
        work: "samples a pixel",
        points: &[1, 16, 256, 1024, 4096, 16384, 65536],
        amount: f64::from,
        scene: |samples, folder| ground(folder, 128, samples, SIDE),
    },
    Kind { name: "spheres", work: "spheres", points: &SHAPES, amount: f64::from, scene: spheres },
    Kind {
        name: "triangles",
        work: "single triangles",
        points: &SHAPES,
        amount: f64::from,
        scene: triangles,
    },
    Kind {
        name: "meshes",
        work: "triangles of a mesh",
        points: &[5, 16, 50, 158, 500, 1581],
        amount: |down| 4.0 * f64::from(down).powi(2),
        scene: mesh,
    },
    Kind {
        name: "textures",
        work: "textures",
        points: &[1, 8, 32, 128, 512],
        amount: f64::from,
        scene: textures,
    },
    Kind {
        name: "texels",
        work: "texels of a texture",
        points: &[1, 16, 256, 1024, 4096, 16384],
        amount: |side| f64::from(side).powi(2),
        scene: |side, folder| ground(folder, SIDE, SAMPLES, side),
    },
    Kind {
        name: "lights",
        work: "lights without shadows",
        points: &LIGHTS,
        amount: f64::from,
        scene: |count, _| Ok(lit(count, "")),
    },
    Kind {
        name: "shadows",
        work: "lights with shadows",
        points: &LIGHTS,
        amount: f64::from,
        scene: |count, _| Ok(lit(count, "[[sphere]]\ncenter = [0, 0.4, 0]\nradius = 0.4\n")),
    },
];

/// Of more in one tile of the picture than it can list, rays test all.
const SHAPES: [u32; 8] = [1, 4, 16, 64, 256, 1024, 4096, 16384];
const LIGHTS: [u32; 6] = [1, 4, 16, 64, 256, 1024];

/// The beginning of a scene whose camera looks along -z at the square from -1 to 1.
fn front(side: u32, samples: u32) -> String {
    format!(
        "[camera]\neye = [0, 0, 3]\nlook_at = [0, 0, 0]\nvertical_fov = 40\n[image]\nwidth = {side}\nheight = {side}\n\
         [sampling]\nspp = {samples}\n[background]\ncolor = [0.5, 0.7, 1.0]\n"
    )
}

/// A ground to the horizon with one texture, whose levels are read by the width of cones.
fn ground(folder: &Path, side: u32, samples: u32, texels: u32) -> Outcome<String> {
    picture(&folder.join("texture.png"), texels, 0)?;
    Ok(format!(
        "[camera]\neye = [0, 1, 0]\nlook_at = [0, 0.2, -4]\nvertical_fov = 60\n[image]\nwidth = {side}\nheight = {side}\n\
         [sampling]\nspp = {samples}\nfootprint = \"cone\"\n[background]\ncolor = [0.5, 0.7, 1.0]\n[[texture]]\n\
         name = \"t\"\nfile = \"texture.png\"\ncolor_space = \"linear\"\n[[sampler]]\nname = \"s\"\nmip = \"linear\"\n\
         [[material]]\nname = \"m\"\nmodel = \"unlit\"\ntexture = \"t\"\nsampler = \"s\"\n[[plane]]\n\
         origin = [0, 0, 0]\ntangent = [4, 0, 0]\nbitangent = [0, 0, 4]\nhalf_extent = 250\nmaterial = \"m\"\n"
    ))
}

/// Returns the middles and the half width of the cells of the square from -1 to 1 that hold `count` shapes.
fn cells(count: u32) -> (impl Iterator<Item = (f64, f64)>, f64) {
    let across = f64::from(count).sqrt().ceil() as u32;
    let half = 1.0 / f64::from(across);
    let middle = move |cell: u32| (2.0 * f64::from(cell) + 1.0) * half - 1.0;
    ((0..count).map(move |i| (middle(i % across), middle(i / across))), half)
}

fn spheres(count: u32, _: &Path) -> Outcome<String> {
    let mut scene = front(SIDE, SAMPLES) + "[[material]]\nname = \"m\"\nmodel = \"unlit\"\n";
    let (middles, half) = cells(count);
    for (x, y) in middles {
        write!(scene, "[[sphere]]\ncenter = [{x}, {y}, 0]\nradius = {}\nmaterial = \"m\"\n", 0.9 * half)?;
    }
    Ok(scene)
}

fn triangles(count: u32, _: &Path) -> Outcome<String> {
    let mut scene = front(SIDE, SAMPLES) + "[[material]]\nname = \"m\"\nmodel = \"unlit\"\n";
    let (middles, half) = cells(count);
    for (x, y) in middles {
        let (left, right, low, high) = (x - 0.9 * half, x + 0.9 * half, y - 0.9 * half, y + 0.9 * half);
        writeln!(
            scene,
            "[[triangle]]\nvertices = [[{left}, {low}, 0], [{right}, {low}, 0], [{x}, {high}, 0]]\nmaterial = \"m\""
        )?;
    }
    Ok(scene)
}

/// A sphere with waves, of 4 · `down`² triangles.
fn mesh(down: u32, folder: &Path) -> Outcome<String> {
    fs::write(folder.join("mesh.ply"), meshes::ply(2 * down, down + 1))?;
    Ok(front(SIDE, SAMPLES)
        + "[[material]]\nname = \"m\"\nmodel = \"unlit\"\n[[mesh]]\nfile = \"mesh.ply\"\nmaterial = \"m\"\n")
}

/// A wall of always the same quads, of which each has one of the textures, by a material of its own.
fn textures(count: u32, folder: &Path) -> Outcome<String> {
    let mut scene = front(SIDE, SAMPLES) + "[[sampler]]\nname = \"s\"\n";
    for i in 0..count {
        picture(&folder.join(format!("{i}.png")), SMALL_TEXTURE, i)?;
        writeln!(
            scene,
            "[[texture]]\nname = \"t{i}\"\nfile = \"{i}.png\"\ncolor_space = \"linear\"\n[[material]]\nname = \"m{i}\"\n\
             model = \"unlit\"\ntexture = \"t{i}\"\nsampler = \"s\""
        )?;
    }
    let mut model = String::from("vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n");
    let (middles, half) = cells(QUADS);
    for ((x, y), i) in middles.zip(0..) {
        for (side, up) in [(-half, -half), (half, -half), (half, half), (-half, half)] {
            writeln!(model, "v {} {} 0", x + side, y + up)?;
        }
        let corner = 4 * i;
        writeln!(
            model,
            "usemtl m{}\nf {}/1 {}/2 {}/3 {}/4",
            i % count,
            corner + 1,
            corner + 2,
            corner + 3,
            corner + 4
        )?;
    }
    fs::write(folder.join("wall.obj"), model)?;
    let pairs: Vec<String> = (0..count).map(|i| format!("m{i} = \"m{i}\"")).collect();
    writeln!(scene, "[[mesh]]\nfile = \"wall.obj\"\nmaterial = {{ {} }}", pairs.join(", "))?;
    Ok(scene)
}

/// A white ground under a ring of point lights, and more shapes.
fn lit(count: u32, shapes: &str) -> String {
    let mut scene = front(SIDE, SAMPLES).replace("eye = [0, 0, 3]", "eye = [0, 2, 3]")
        + "[[plane]]\norigin = [0, 0, 0]\ntangent = [1, 0, 0]\nbitangent = [0, 0, -1]\nhalf_extent = 2\n"
        + shapes;
    for i in 0..count {
        let turn = std::f64::consts::TAU * f64::from(i) / f64::from(count);
        let (x, z, power) = (3.0 * turn.cos(), 3.0 * turn.sin(), 30.0 / f64::from(count));
        scene += &format!(
            "[[light]]\nkind = \"point\"\nposition = [{x}, 2, {z}]\nintensity = [{power}, {power}, {power}]\n"
        );
    }
    scene
}

/// Writes a picture of grey texels without a pattern.
fn picture(path: &Path, side: u32, seed: u32) -> Outcome<()> {
    let mut encoder = png::Encoder::new(std::io::BufWriter::new(fs::File::create(path)?), side, side);
    encoder.set_color(png::ColorType::Grayscale);
    encoder.set_compression(png::Compression::Fast);
    let texel = |i: u32| ((i ^ i >> 15 ^ seed << 7).wrapping_mul(0x9E37_79B9) >> 24) as u8;
    let texels: Vec<u8> = (0..side * side).map(texel).collect();
    encoder.write_header()?.write_image_data(&texels)?;
    Ok(())
}
