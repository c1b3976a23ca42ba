//! The verdict on tiling for textures made for it: photographic ones (octave noise, gradients,
//! grain, skies with a sun) and patterns (bricks, tiles, planks, checkers, stripes, letters),
//! unchanged, rolled, cropped, and short of one texel. A tileable texture must never be judged not
//! to tile, a cropped one never to tile; an undecided verdict is allowed if the seam could be one
//! more edge.

use std::f64::consts::TAU;

use moire::internal::oracle::rng::mix_bits;
use moire::internal::texture::analysis::{AxisAnalysis, Seam, Verdict, analyse};
use moire::internal::texture::data::{ColorSpace, Dimension, TexelFormat, TextureData};

use crate::support::moire;

/// Grey values, rows first.
#[derive(Clone)]
struct Texture {
    width: usize,
    height: usize,
    values: Vec<f64>,
    /// 8 bits, or floats.
    float: bool,
}

const SIZE: (usize, usize) = (192, 144);

fn hash(a: usize, b: usize) -> f64 {
    f64::from(mix_bits(mix_bits(a as u32) ^ b as u32)) / f64::from(u32::MAX)
}

impl Texture {
    fn new((width, height): (usize, usize), value: impl Fn(usize, usize) -> f64) -> Texture {
        let places = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
        Texture { width, height, values: places.map(|(x, y)| value(x, y)).collect(), float: false }
    }

    fn at(&self, x: usize, y: usize) -> f64 {
        self.values[y % self.height * self.width + x % self.width]
    }

    /// From (x, y) on, around the border.
    fn part(&self, (x, y): (usize, usize), size: (usize, usize)) -> Texture {
        Texture { float: self.float, ..Texture::new(size, |i, j| self.at(x + i, y + j)) }
    }

    fn rolled(&self, x: usize, y: usize) -> Texture {
        self.part((x, y), (self.width, self.height))
    }

    fn cut(&self, u: f64, v: f64) -> Texture {
        let of = |length: usize, part: f64| (length as f64 * part) as usize;
        self.part((11, 7), (of(self.width, u), of(self.height, v)))
    }

    fn with_grain(mut self, size: f64) -> Texture {
        let grain = |i: usize| (0..4).map(|k| hash(i, 77 + k) - 0.5).sum::<f64>() * 1.7 * size;
        self.values.iter_mut().enumerate().for_each(|(i, v)| *v += grain(i));
        self
    }

    fn verdicts(&self) -> [AxisAnalysis; 2] {
        let texels = if self.float {
            self.values.iter().flat_map(|v| (*v as f32).to_ne_bytes()).collect()
        } else {
            self.values.iter().map(|v| (v.clamp(0.0, 1.0) * 255.0).round() as u8).collect()
        };
        let told = analyse(&TextureData {
            name: "made".into(),
            dimension: Dimension::Two,
            width: self.width as u32,
            height: self.height as u32,
            depth: 1,
            format: if self.float { TexelFormat::GreyFloat } else { TexelFormat::Grey8 },
            color_space: ColorSpace::Linear,
            file_channels: 1,
            texels,
            stored_levels: Vec::new(),
        });
        [told.u, told.v]
    }
}

/// Noise of octaves that tiles: a sum of waves with whole numbers of periods, amplitudes falling with their
/// frequency as clouds' do.
fn clouds(seed: usize) -> Texture {
    let waves: Vec<[f64; 4]> = (0..160)
        .map(|i| {
            let frequency = 1.0 + 40.0 * hash(i, seed).powi(3);
            let angle = TAU * hash(i, seed + 1);
            let [a, b] = [frequency * angle.cos(), frequency * angle.sin()].map(f64::round);
            [a, b, TAU * hash(i, seed + 2), 0.09 * frequency.powf(-0.9)]
        })
        .collect();
    Texture::new(SIZE, |x, y| {
        let (u, v) = (x as f64 / SIZE.0 as f64, y as f64 / SIZE.1 as f64);
        0.5 + waves
            .iter()
            .map(|[a, b, phase, size]| size * (TAU * (a * u + b * v) + phase).sin())
            .sum::<f64>()
    })
}

/// Bricks of 24 × 18 with joints of `joint` along their left and upper sides, every other row shifted by `shift`,
/// each brick with a tone of its own.
fn bricks(shift: usize, joint: usize) -> Texture {
    Texture::new(SIZE, |x, y| {
        let row = y / 18;
        let x = (x + if row % 2 == 1 { shift } else { 0 }) % SIZE.0;
        let is_joint = x % 24 < joint || y % 18 < joint;
        if is_joint { 0.8 } else { 0.25 + 0.35 * hash(x / 24, row) }
    })
}

fn planks() -> Texture {
    let grain = clouds(9);
    Texture::new(SIZE, |x, y| {
        if x % 24 < 2 { 0.1 } else { 0.3 + 0.25 * hash(x / 24, 5) + 0.15 * (grain.at(x, y) - 0.5) }
    })
}

fn checker(cell: usize) -> Texture {
    Texture::new(SIZE, |x, y| if (x / cell + y / cell) % 2 == 1 { 0.9 } else { 0.1 })
}

/// Bands across both axes, hard or as waves.
fn stripes(along_u: f64, along_v: f64, hard: bool) -> Texture {
    Texture::new(SIZE, |x, y| {
        let phase = (along_u * x as f64 / SIZE.0 as f64 + along_v * y as f64 / SIZE.1 as f64).fract();
        match hard {
            true => 0.1 + if phase < 0.5 { 0.8 } else { 0.0 },
            false => 0.5 + 0.4 * (TAU * phase).sin(),
        }
    })
}

/// Lines of 18 with glyphs of 12, five by seven dots of two.
fn letters() -> Texture {
    Texture::new(SIZE, |x, y| {
        let (column, line) = (x / 12, y / 18);
        let glyph = (26.0 * hash(column, line)) as usize;
        let (i, j) = ((x % 12) / 2, (y % 18) / 2);
        let ink =
            i < 5 && (1..8).contains(&j) && !glyph.is_multiple_of(6) && hash(glyph * 64 + i * 8 + j, 3) < 0.5;
        if ink { 0.08 } else { 0.95 }
    })
}

/// Stones: the nearest of scattered points, around the border.
fn stones() -> Texture {
    Texture::new(SIZE, |x, y| {
        let away = |i: usize| {
            let [w, h] = [SIZE.0 as f64, SIZE.1 as f64];
            let dx = (x as f64 - w * hash(i, 1)).rem_euclid(w);
            let dy = (y as f64 - h * hash(i, 2)).rem_euclid(h);
            dx.min(w - dx).hypot(dy.min(h - dy))
        };
        let mut order: Vec<usize> = (0..30).collect();
        order.sort_by(|&a, &b| away(a).total_cmp(&away(b)));
        if away(order[1]) - away(order[0]) < 2.5 { 0.08 } else { 0.3 + 0.4 * hash(order[0], 3) }
    })
}

/// Around the horizon: u tiles; above and below differ. Radiance with a sun of a few texels, up to 20 000.
fn sky(horizon: f64) -> Texture {
    let noise = clouds(4);
    let mut sky = Texture::new(SIZE, |x, y| {
        let up = 1.0 - 2.0 * (y as f64 + 0.5) / SIZE.1 as f64;
        let base = if up > horizon { 0.25 + 0.9 * (-2.5 * (up - horizon)).exp() } else { 0.12 };
        let from_sun = (x as f64 - 61.0).hypot(y as f64 - 30.0);
        base * (0.6 + 0.8 * noise.at(x, y)) + 20_000.0 * (-from_sun * from_sun).exp()
    });
    sky.float = true;
    sky
}

/// Clouds that tile both ways, and a sun.
fn clouds_with_sun() -> Texture {
    let noise = clouds(6);
    let sun =
        |x: usize, y: usize| 9000.0 * (-((x as f64 - 100.0).hypot(y as f64 - 50.0)).powi(2) / 3.0).exp();
    Texture { float: true, ..Texture::new(SIZE, |x, y| noise.at(x, y) + sun(x, y)) }
}

/// Nothing that tiles: clouds on a gradient, darker towards the corners.
fn photo() -> Texture {
    let noise = clouds(12);
    Texture::new(SIZE, |x, y| {
        let (u, v) = (x as f64 / SIZE.0 as f64, y as f64 / SIZE.1 as f64);
        (noise.at(x / 2 + 5, y / 2 + 9) + 0.3 * u - 0.2 * v) * (1.0 - 0.3 * (u - 0.3).hypot(v - 0.4))
    })
    .with_grain(0.01)
}

use Verdict::{No, Perhaps, Yes};

/// Each with the allowed verdicts for u and v.
fn check(cases: Vec<(&str, Texture, [&[Verdict]; 2])>) {
    let mut wrong = String::new();
    for (name, texture, allowed) in cases {
        for ((axis, told), allowed) in ["u", "v"].iter().zip(texture.verdicts()).zip(allowed) {
            if !allowed.contains(&told.seam.verdict()) {
                wrong += &format!("\n{name} in {axis}: {allowed:?} expected, {told:?}");
            }
        }
    }
    assert!(wrong.is_empty(), "{wrong}");
}

const TILES: [&[Verdict]; 2] = [&[Yes], &[Yes]];
const NEITHER: [&[Verdict]; 2] = [&[No], &[No]];

#[test]
fn planks_that_were_made_to_tile_do() {
    check(vec![("planks", planks(), TILES)]);
}

#[test]
fn textures_that_were_made_to_tile_do() {
    check(vec![
        ("clouds", clouds(1).rolled(9, 20), TILES),
        ("clouds, rolled", clouds(2).rolled(77, 31), TILES),
        ("clouds with grain", clouds(3).with_grain(0.05), TILES),
        ("grain", Texture::new(SIZE, |_, _| 0.5).with_grain(0.2), TILES),
        ("bricks, joint on the border", bricks(12, 3), TILES),
        ("bricks, joint behind the border", bricks(12, 3).rolled(3, 3), TILES),
        ("bricks, border within a joint", bricks(12, 3).rolled(1, 1).with_grain(0.03), TILES),
        ("bricks by thirds", bricks(8, 2).with_grain(0.02), TILES),
        ("bricks, border anywhere", bricks(12, 3).rolled(17, 8).with_grain(0.01), TILES),
        ("tiles, joint on the border", bricks(0, 4).with_grain(0.02), TILES),
        ("checker", checker(12), TILES),
        ("checker with grain", checker(8).with_grain(0.03), TILES),
        ("upright stripes", stripes(8.0, 0.0, true), TILES),
        ("slanted stripes", stripes(8.0, 6.0, true).with_grain(0.01), TILES),
        ("waves", stripes(5.0, 3.0, false), TILES),
        ("stones", stones().with_grain(0.01).rolled(40, 30), TILES),
        ("letters", letters(), TILES),
        ("clouds with a sun", clouds_with_sun(), TILES),
        ("clouds with a sun on the border", clouds_with_sun().rolled(100, 50), TILES),
    ]);
}

/// Waves of 8 texels, of which roundings make some steps a code longer than others.
#[test]
fn whole_periods_of_a_wave_tile_whatever_their_roundings() {
    let waves = Texture::new((32, 32), |_, y| 0.5 + 100.0 / 255.0 * (y as f64 * TAU / 8.0).sin());
    check(vec![("four waves", waves.rolled(0, 5), TILES), ("four waves from 0", waves, TILES)]);
}

/// Wherever the border lies, also on the hardest edge.
#[test]
fn rolled_textures_are_never_told_not_to_tile_and_seldom_doubted() {
    for (name, texture) in [("stones", stones()), ("letters", letters()), ("clouds", clouds(8))] {
        let told =
            (0..24).flat_map(|i| texture.rolled(i * 8, i * 6).verdicts().map(|axis| axis.seam.verdict()));
        let told: Vec<Verdict> = told.collect();
        assert!(!told.contains(&No), "{name}: {told:?}");
        let doubts = told.iter().filter(|verdict| **verdict == Perhaps).count();
        assert!(doubts <= told.len() / 4, "{name}: {doubts} of {}", told.len());
    }
}

#[test]
fn cut_textures_do_not_tile() {
    check(vec![
        ("clouds", clouds(1).cut(0.7, 0.8), NEITHER),
        ("clouds with grain", clouds(3).with_grain(0.03).cut(0.6, 0.7), NEITHER),
        ("a photo", photo(), NEITHER),
        ("bricks", bricks(12, 3).cut(0.8, 0.7), NEITHER),
        ("bricks with grain", bricks(12, 3).with_grain(0.03).cut(0.69, 0.83), NEITHER),
        ("bricks by thirds", bricks(8, 2).with_grain(0.02).cut(0.9, 0.66), NEITHER),
        ("bricks, short of a texel", bricks(12, 3).part((0, 0), (191, 143)), NEITHER),
        ("tiles", bricks(0, 4).with_grain(0.02).cut(0.85, 0.9), NEITHER),
        ("planks", planks().cut(0.8, 0.75), NEITHER),
        ("checker", checker(12).cut(0.83, 0.78), NEITHER),
        ("checker of an odd number of cells", checker(12).part((0, 0), (180, 132)), NEITHER),
        ("slanted stripes", stripes(8.0, 6.0, true).cut(0.83, 0.79), NEITHER),
        ("waves", stripes(6.0, 4.0, false).cut(0.9, 0.9), NEITHER),
        ("stones", stones().with_grain(0.01).cut(0.8, 0.75), NEITHER),
        ("letters", letters().cut(0.79, 0.81), [&[No], &[No, Perhaps]]),
        ("clouds with a sun", clouds_with_sun().cut(0.8, 0.7), NEITHER),
        ("a slope", Texture::new(SIZE, |x, y| (x + y) as f64 / 400.0), NEITHER),
    ]);
}

#[test]
fn a_texture_may_tile_along_one_axis() {
    check(vec![
        ("a sky with a sun", sky(-1.0), [&[Yes], &[No]]),
        ("a sky with a sun over ground", sky(-0.2), [&[Yes], &[No]]),
        ("bricks cut in u", bricks(12, 3).part((5, 0), (155, 144)), [&[No], &[Yes]]),
        ("bricks cut in v", bricks(12, 3).part((0, 5), (192, 101)), [&[Yes], &[No]]),
        ("clouds cut in u", clouds(5).part((3, 0), (140, 144)), [&[No], &[Yes]]),
    ]);
}

#[test]
fn a_seam_that_may_be_one_more_edge_is_doubtful_or_told_by_its_like() {
    // Two tiles along each side: their edge inside recurs, but two are no pattern.
    let two = Texture::new(SIZE, |x, y| {
        let tone = 0.3 + 0.3 * hash(x / 96, y / 72);
        if x % 96 < 4 || y % 72 < 4 { 0.85 } else { tone }
    });
    check(vec![
        (
            "one tile",
            Texture::new(SIZE, |x, y| if x < 5 || y < 5 { 0.8 } else { 0.4 }).with_grain(0.02),
            TILES,
        ),
        ("two tiles", two.with_grain(0.01), [&[Yes, Perhaps], &[Yes, Perhaps]]),
    ]);
    // A column less of something smooth: visible on close inspection.
    let short = clouds(7).part((0, 0), (191, 144)).verdicts();
    assert!(short[0].seam.verdict() != Yes, "{:?}", short[0]);
}

#[test]
fn rank_is_the_part_of_the_steps_inside_that_are_smaller() {
    let ramp = Texture::new((64, 4), |x, _| x as f64 / 63.0).verdicts();
    let rank = ramp[0].rank.unwrap();
    assert_eq!((rank.share, ramp[0].seam), (1.0, Seam::Visible));
    assert!((rank.of_largest.unwrap() - 51.0).abs() < 1.0, "255 steps of 4 or 5: {rank:?}");
    let alike = checker(12).verdicts();
    // 15 edges inside, equal to the seam, among 191 steps.
    assert!((alike[0].rank.unwrap().share - (176.0 + 7.5) / 191.0).abs() < 1e-12, "{:?}", alike[0]);
    assert_eq!((alike[0].period.map(|p| p.texels), alike[0].seam), (Some(12), Seam::Pattern));
}

#[test]
fn command_says_where_the_seam_ranks_and_what_repeats() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("wall.png");
    let wall = bricks(12, 3);
    let bytes: Vec<u8> = wall.values.iter().map(|v| (v * 255.0) as u8).collect();
    image::save_buffer(&path, &bytes, SIZE.0 as u32, SIZE.1 as u32, image::ColorType::L8).unwrap();
    let run = |options: &[&str]| {
        let output = moire().arg("texture").arg(&path).args(options).output().unwrap();
        assert_eq!(output.status.code(), Some(0));
        String::from_utf8(output.stdout).unwrap()
    };
    let told = run(&[]);
    assert!(told.contains("tiles in u  yes") && told.contains("% of the steps inside"), "{told}");
    assert!(told.contains("repeats every"), "{told}");
    let json: serde_json::Value = serde_json::from_str(&run(&["--json"])).unwrap();
    let v = &json["tiling"]["v"];
    assert_eq!((&v["tiles"], &v["verdict"]), (&true.into(), &"yes".into()));
    assert!(v["rank"].as_f64().unwrap() > 0.9 && v["misfit"].as_f64().unwrap() < 0.2, "{v}");
    assert_eq!(v["period"].as_u64().unwrap() % 18, 0, "{v}");
}
