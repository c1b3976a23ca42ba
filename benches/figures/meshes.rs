//! A mesh of a million triangles: `cargo bench -- meshes`. A sphere of 1024 × 489 quads with waves on it, seen at 1024²,
//! unlit and with a shadow: seconds of loading, and of rendering at several numbers of samples.

use std::f64::consts::{PI, TAU};
use std::fs;

use crate::{Bench, Outcome};

const AROUND: u32 = 1024;
const DOWN: u32 = 489;

/// Returns a mesh of 2 · `around_count` · (`down_count` − 1) triangles, beside those of no area at its poles, as PLY.
pub fn ply(around_count: u32, down_count: u32) -> Vec<u8> {
    let count = (around_count + 1) * (down_count + 1);
    let faces = 2 * around_count * down_count;
    let mut bytes = format!(
        "ply\nformat binary_little_endian 1.0\nelement vertex {count}\nproperty float x\nproperty float y\n\
         property float z\nproperty float u\nproperty float v\nelement face {faces}\n\
         property list uchar uint vertex_indices\nend_header\n"
    )
    .into_bytes();
    // Waves of 3 to 48 radians a unit, alike in slope.
    let waves: [(f64, [f64; 3]); 12] = std::array::from_fn(|k| {
        let k = k as f64;
        (3.0 * 1.28f64.powf(k), [k.cos(), (2.0 * k).sin(), (3.0 * k).cos()])
    });
    for down in 0..=down_count {
        for around in 0..=around_count {
            let (theta, phi) = (
                PI * f64::from(down) / f64::from(down_count),
                TAU * f64::from(around % around_count) / f64::from(around_count),
            );
            let way = [theta.sin() * phi.cos(), theta.cos(), theta.sin() * phi.sin()];
            let height: f64 = (0..)
                .zip(&waves)
                .map(|(k, (frequency, turn))| {
                    let along: f64 = turn.iter().zip(way).map(|(a, b)| a * b).sum();
                    (frequency * along + f64::from(k)).sin() * 0.12 / frequency
                })
                .sum();
            let coordinates = [
                4.0 * f64::from(around) / f64::from(around_count),
                2.0 * f64::from(down) / f64::from(down_count),
            ];
            for number in way.map(|part| part * (1.0 + height)).into_iter().chain(coordinates) {
                bytes.extend_from_slice(&(number as f32).to_le_bytes());
            }
        }
    }
    for down in 0..down_count {
        for around in 0..around_count {
            let a = down * (around_count + 1) + around;
            let (b, c, d) = (a + 1, a + around_count + 2, a + around_count + 1);
            for face in [[a, b, c], [a, c, d]] {
                bytes.push(3);
                face.iter().for_each(|index| bytes.extend_from_slice(&index.to_le_bytes()));
            }
        }
    }
    bytes
}

fn scene(is_lit: bool) -> String {
    let (model, light) = if is_lit {
        ("lambert", "[[light]]\nkind = \"directional\"\ndirection = [1, 1, 1]\nirradiance = [3, 3, 3]\n")
    } else {
        ("unlit", "")
    };
    format!(
        "[camera]\neye = [0, 1, 2.9]\nlook_at = [0, 0, 0]\nvertical_fov = 40\n[image]\nwidth = 1024\nheight = 1024\n\
         [background]\ncolor = [0.5, 0.7, 1.0]\n{light}[[texture]]\nname = \"noise\"\nfile = \"noise.png\"\n\
         color_space = \"linear\"\n[[sampler]]\nname = \"plain\"\n[[material]]\nname = \"m\"\nmodel = \"{model}\"\n\
         texture = \"noise\"\nsampler = \"plain\"\n[[mesh]]\nfile = \"million.ply\"\nmaterial = \"m\"\n"
    )
}

/// Prints the medians.
pub fn table(bench: &Bench) -> Outcome<()> {
    let folder = bench.picture.path();
    fs::write(folder.join("million.ply"), ply(AROUND, DOWN))?;
    fs::copy("data/textures/bench/noise.png", folder.join("noise.png"))?;
    println!("\n| mesh of {} triangles, 1024² | samples | load s | render s |", 2 * AROUND * (DOWN - 1));
    println!("| --- | --- | --- | --- |");
    for (name, is_lit, samples) in
        [("unlit", false, "1"), ("unlit", false, "16"), ("unlit", false, "64"), ("lit, shadows", true, "16")]
    {
        let file = folder.join("scene.toml");
        fs::write(&file, scene(is_lit))?;
        let file = file.display().to_string();
        let mut runs = Vec::new();
        for _ in 0..bench.runs {
            runs.push(bench.run_file(&file, &["--spp", samples], &[])?);
        }
        let median = |pointer: &str| {
            let mut all: Vec<f64> = runs.iter().map(|run| run.figure(pointer)).collect();
            all.sort_by(f64::total_cmp);
            all[all.len() / 2]
        };
        println!(
            "| {name} | {samples} | {:.2} | {:.3} |",
            median("/seconds/load"),
            median("/seconds/render")
        );
    }
    Ok(())
}
