//! Pictures of rare bright features: a sun in a mirror, stars, defocused sparks, slits of light.
//! The error estimate of adaptive sampling is compared with the true error over scenes and seeds.

use std::path::Path;

use moire::internal::core::film::Film;
use moire::internal::integrators::adaptive::{Goal, Outcome};
use moire::internal::scene::model::{Algorithm, Pattern, Scene};
use moire::internal::scene::parse;

use super::{rmse, to_goal};
use crate::stage::{packed, render};
use crate::support::data;

/// The beginning of all scenes.
const HEAD: &str = "
[camera]
eye = [0, 0, 4]
look_at = [0, 0, 0]
vertical_fov = 30
CAMERA
[image]
width = 32
height = 32
[sampling]
pattern = 'sobol-owen'
spp = 16
[background]
BACKGROUND
[[material]]
name = 'wall'
model = 'unlit'
color = [0.4, 0.5, 0.3]
[[material]]
name = 'spark'
model = 'unlit'
color = [900, 700, 500]
[[material]]
name = 'matte'
color = [0.8, 0.7, 0.6]
[[texture]]
name = 'stars'
color_space = 'linear'
file = 'rare/stars.png'
[[sampler]]
name = 's'
filter = 'nearest'
";

const GREY: &str = "color = [0.2, 0.3, 0.4]";
const SUN: &str = "environment = 'sky'";
const SKY: &str = "[[texture]]\nname = 'sky'\nfile = 'rare/sky-sun.exr'\n";
const WALL: &str =
    "[[plane]]\norigin = [0, 0, -1]\ntangent = [1, 0, 0]\nbitangent = [0, 1, 0]\nmaterial = 'wall'\n";

struct Rare {
    name: &'static str,
    camera: &'static str,
    background: &'static str,
    shapes: String,
    /// An RMSE that takes several passes.
    goal: f64,
}

fn rare(name: &'static str, goal: f64, background: &'static str, shapes: &str) -> Rare {
    Rare { name, camera: "", background, shapes: shapes.into(), goal }
}

fn spheres(count: i32, radius: f64, z: f64, material: &str) -> String {
    let at = |i: i32| {
        // Positions by the R2 sequence (Roberts 2018).
        let [x, y] = [0.754_877_67, 0.569_840_29].map(|a: f64| (0.5 + a * f64::from(i)).fract() * 1.8 - 0.9);
        format!("[[sphere]]\ncenter = [{x}, {y}, {z}]\nradius = {radius}\nmaterial = '{material}'\n")
    };
    (0..count).map(at).collect()
}

fn ball(lines: &str) -> String {
    format!(
        "{SKY}[[material]]\nname = 'ball'\n{lines}\n[[sphere]]\ncenter = [0, 0, 0]\nradius = 0.5\nmaterial = 'ball'\n"
    )
}

fn scenes() -> Vec<Rare> {
    let starred = |scale: f64, tint: &str| {
        format!(
            "[[material]]\nname = 'sheet'\nmodel = 'unlit'\ncolor = {tint}\ntexture = 'stars'\nsampler = 's'\n\
             mapping = {{ kind = 'surface', scale = [{scale}, {scale}] }}\n[[plane]]\norigin = [0, 0, 0]\n\
             tangent = [1, 0, 0]\nbitangent = [0, 1, 0]\nmaterial = 'sheet'\n"
        )
    };
    let glossy_floor = "[[material]]\nname = 'gloss'\nmodel = 'mirror'\nroughness = 0.25\n[[plane]]\n\
                        origin = [0, -0.5, 0]\ntangent = [1, 0, 0]\nbitangent = [0, 0, -1]\nmaterial = 'gloss'\n";
    vec![
        rare("a sun in a glossy ball", 0.05, SUN, &ball("model = 'mirror'\nroughness = 0.3")),
        rare("a sun in a rougher ball", 0.05, SUN, &ball("model = 'mirror'\nroughness = 0.5")),
        rare("a sun through rough glass", 0.2, SUN, &ball("model = 'dielectric'\nior = 1.5\nroughness = 0.3")),
        rare("stars far away", 2e-3, GREY, &starred(1.0, "[1, 1, 1]")),
        rare("stars nearby", 2e-2, GREY, &starred(0.15, "[10, 10, 10]")),
        rare("sparks", 0.5, GREY, &format!("{WALL}{}", spheres(12, 0.002, 0.0, "spark"))),
        Rare {
            camera: "lens_radius = 0.2\nfocus_distance = 3",
            ..rare("sparks out of focus", 0.05, GREY, &format!("{WALL}{}", spheres(12, 0.004, 0.0, "spark")))
        },
        rare(
            "a spark that flies",
            0.3,
            GREY,
            &format!("{WALL}{}motion = [1.2, 0.7, 0]\n", spheres(1, 0.006, 0.1, "spark")),
        ),
        rare("sparks in a glossy floor", 0.2, GREY, &format!("{glossy_floor}{}", spheres(8, 0.01, -0.5, "spark"))),
        rare("sparks in a mirror ball", 0.3, GREY, &format!(
            "[[material]]\nname = 'ball'\nmodel = 'mirror'\n[[sphere]]\ncenter = [0, 0, -1]\nradius = 1\nmaterial = 'ball'\n{}",
            spheres(10, 0.01, 3.0, "spark")
        )),
        rare("wires", 2e-2, GREY, &(0..9).map(|i| {
            let x = -0.9 + 0.2 * f64::from(i);
            let w = 2e-4;
            format!(
                "[[triangle]]\nvertices = [[{x}, -1, 0], [{}, -1, 0], [{}, 1, 0]]\nmaterial = 'spark'\n",
                x + w, x + 0.1
            )
        }).collect::<String>()),
    ]
}

impl Rare {
    fn scene(&self) -> Scene {
        let head = HEAD.replace("CAMERA", self.camera).replace("BACKGROUND", self.background);
        let path = data().join("rare.toml");
        let mut scene = parse(Path::new(&path), &format!("{head}{}", self.shapes)).unwrap();
        scene.sampling.pattern = Pattern::SobolOwen;
        scene
    }

    fn reference(&self, seed: u32, spp: u32) -> Film {
        let mut scene = self.scene();
        scene.sampling.algorithm = Algorithm::Samples;
        scene.sampling.spp = spp;
        scene.sampling.seed = seed;
        render(&packed(scene, None))
    }

    fn adaptive(&self, algorithm: Algorithm, goal: Goal, seed: u32) -> (Film, Outcome) {
        let mut scene = self.scene();
        scene.sampling.algorithm = algorithm;
        scene.sampling.seed = seed;
        if let Goal::Samples(spp) = goal {
            scene.sampling.spp = spp;
        }
        to_goal(&packed(scene, None), goal, false)
    }
}

/// Returns the product of the picture's distances to two references, which is free of their errors, as these are
/// independent.
fn rmse_beside(film: &Film, [a, b]: [&Film; 2]) -> f64 {
    let off = |i: usize, c: usize, from: &Film| f64::from(film.pixels[i][c]) - f64::from(from.pixels[i][c]);
    let pixel = |i: usize| (0..3).map(|c| off(i, c, a) * off(i, c, b)).sum::<f64>() / 3.0;
    let mse = (0..film.pixels.len()).map(pixel).sum::<f64>() / film.pixels.len() as f64;
    mse.max(0.0).sqrt()
}

/// Samples of each reference: most for the long run, as rare light needs them; fewest where two references take each
/// other's errors out of a distance that is far longer than these.
const SPP: u32 = 1 << 16;
const PAIRED_SPP: u32 = 1 << 14;
const LONG_SPP: u32 = 1 << 20;

/// Returns how often, of `seeds` runs, the interval contains the true error; and how often the goal was reported as
/// reached although the error exceeds it by more than a tenth.
fn judge(rare: &Rare, goal: Goal, seeds: u32, [a, b]: &[Film; 2]) -> (u32, u32) {
    let (mut held, mut wrong) = (0, 0);
    for seed in 1..=seeds {
        let (film, outcome) = rare.adaptive(Algorithm::Auto, goal, seed);
        let error = rmse_beside(&film, [a, b]);
        let [low, high] = outcome.interval.unwrap();
        held += u32::from((low..=high).contains(&error));
        let missed = matches!(goal, Goal::Error(wanted) if outcome.reached && error > 1.1 * wanted);
        wrong += u32::from(missed);
        eprintln!(
            "{}, seed {seed}: error {error:.3e}, said {:.3e} ({low:.3e} to {high:.3e}), halves {:.3e}, reached {}, {} passes, \
             {:.1} samples, audit {}",
            rare.name,
            outcome.estimated_rmse,
            outcome.estimated_noise,
            outcome.reached,
            outcome.passes,
            outcome.mean_samples,
            outcome.audit_samples
        );
    }
    (held, wrong)
}

#[test]
fn a_goal_is_not_said_to_be_reached_where_rare_light_is_missing() {
    for rare in
        scenes().iter().filter(|r| ["a sun in a glossy ball", "stars far away", "sparks"].contains(&r.name))
    {
        let references = [77, 78].map(|seed| rare.reference(seed, PAIRED_SPP));
        let (held, wrong) = judge(rare, Goal::Error(rare.goal), 2, &references);
        assert_eq!((held, wrong), (2, 0), "{}", rare.name);
    }
}

/// Twenty runs of each scene, towards an error and with a number of samples: minutes.
#[test]
#[ignore = "takes minutes; its figures stand in docs/guide/render-to-a-goal.md"]
fn intervals_hold_the_truth_in_eighteen_of_twenty_runs() {
    let mut bad = Vec::new();
    for rare in scenes() {
        let references = [77, 78].map(|seed| rare.reference(seed, LONG_SPP));
        for goal in [Goal::Error(rare.goal), Goal::Samples(64)] {
            let (held, wrong) = judge(&rare, goal, 20, &references);
            eprintln!("{} {goal:?}: {held} of 20 held, {wrong} wrongly reached", rare.name);
            if held < 18 || wrong > 1 {
                bad.push(format!("{} {goal:?}: {held} held, {wrong} wrongly reached", rare.name));
            }
        }
    }
    assert!(bad.is_empty(), "{bad:#?}");
}

/// A texture of rare bright texels with thousands of samples per pixel: a pixel that met none in its first samples
/// still gets its share, so that the error is little more than with the same number of samples everywhere.
#[test]
fn no_pixel_of_rare_texels_is_left_with_its_first_samples() {
    let stars = scenes().into_iter().find(|r| r.name == "stars far away").unwrap();
    let reference = stars.reference(77, SPP);
    let (film, outcome) = stars.adaptive(Algorithm::Adaptive, Goal::Samples(4096), 3);
    let mut equal = stars.scene();
    equal.sampling.algorithm = Algorithm::Samples;
    equal.sampling.spp = 4096;
    equal.sampling.seed = 3;
    let (error, of_equal) = (rmse(&film, &reference), rmse(&render(&packed(equal, None)), &reference));
    // 1.12 was measured: counts that follow the samples bias the picture a little.
    assert!(error < 1.15 * of_equal, "{error:e}, for all alike {of_equal:e}: {outcome:?}");
}
