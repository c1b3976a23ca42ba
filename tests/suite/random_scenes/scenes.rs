//! Random scenes of polygons, as text, so that a failing one can be rendered by the program. Each kind has a
//! feature that once made beams or cones err: mirrors that face or cut each other, that stand in an infinite
//! ground or are one, coplanar shapes, shapes close behind them; parallel rays; shadows; a last bounce.

use std::path::Path;

use glam::DVec3;
use moire::internal::lab::verify::queries::Rng;
use moire::internal::scene::model::Scene;
use moire::internal::scene::parse;

#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Kind {
    /// Polygons through each other, some lit and in shadow.
    Plain,
    /// Mirrors anywhere.
    Mirrors,
    /// Two mirrors that face each other.
    Facing,
    /// Two mirrors through each other.
    Crossing,
    /// The infinite ground is a mirror through which polygons reach.
    MirrorGround,
    /// Mirrors seen by parallel rays.
    Parallel,
}

impl Kind {
    pub const ALL: [Kind; 6] =
        [Kind::Plain, Kind::Mirrors, Kind::Facing, Kind::Crossing, Kind::MirrorGround, Kind::Parallel];
}

fn list(v: DVec3) -> String {
    format!("[{}, {}, {}]", v.x, v.y, v.z)
}

fn within(rng: &mut Rng, reach: f64) -> DVec3 {
    let [x, y, z] = [(); 3].map(|()| rng.between(-reach, reach));
    DVec3::new(x, y, z)
}

fn color(rng: &mut Rng) -> DVec3 {
    within(rng, 0.45) + 0.5
}

fn one_in(rng: &mut Rng, count: u64) -> bool {
    rng.bits().is_multiple_of(count)
}

struct Writer {
    rng: Rng,
    text: String,
    triangles: usize,
}

impl Writer {
    fn material(&mut self, name: &str, model: &str, color: DVec3, more: &str) {
        self.text +=
            &format!("[[material]]\nname = '{name}'\nmodel = '{model}'\ncolor = {}\n{more}", list(color));
    }

    fn triangle(&mut self, corners: [DVec3; 3], material: &str) {
        let corners = corners.map(list).join(", ");
        self.text += &format!("[[triangle]]\nvertices = [{corners}]\nmaterial = '{material}'\n");
        self.triangles += 1;
    }

    fn any_triangle(&mut self, around: DVec3, reach: f64, material: &str) {
        let corners = [(); 3].map(|()| around + within(&mut self.rng, reach));
        self.triangle(corners, material);
    }

    fn plane(&mut self, origin: DVec3, axes: [DVec3; 2], extent: Option<f64>, material: &str) {
        let extent = extent.map_or(String::new(), |extent| format!("half_extent = {extent}\n"));
        let [u, v] = axes.map(list);
        let origin = list(origin);
        self.text += &format!(
            "[[plane]]\norigin = {origin}\ntangent = {u}\nbitangent = {v}\n{extent}material = '{material}'\n"
        );
    }

    /// A mirror across n, in half of the cases with a polygon close behind it.
    fn mirror(&mut self, at: DVec3, n: DVec3, extent: f64) {
        let (u, v) = n.any_orthonormal_pair();
        self.plane(at, [u, v], Some(extent), "mirror");
        if one_in(&mut self.rng, 2) {
            let behind = at - n * self.rng.between(0.02, 0.5);
            self.any_triangle(behind, 0.3, "odd");
        }
    }

    /// A level one, in which both are met at exactly the same point; the first of these hits counts.
    fn two_in_one_plane(&mut self) {
        for _ in 0..2 {
            let corners = [(); 3].map(|()| DVec3 { y: 0.125, ..within(&mut self.rng, 0.8) });
            let material = self.any_material();
            self.triangle(corners, material);
        }
    }

    fn any_material(&mut self) -> &'static str {
        ["plain", "odd", "black", "lit", "lit", "pale", "squares"][(self.rng.bits() % 7) as usize]
    }
}

/// A scene of `side`² pixels.
pub fn text(kind: Kind, seed: u64, side: u32) -> String {
    let mut w = Writer { rng: Rng::new(seed), text: String::new(), triangles: 0 };
    let rng = &mut w.rng;
    let eye = DVec3::new(rng.between(-1.5, 1.5), rng.between(0.5, 2.0), rng.between(2.5, 3.5));
    let look_at = within(rng, 0.3);
    let lens = match kind {
        Kind::Parallel => format!("orthographic_height = {}", rng.between(1.5, 2.5)),
        _ => format!("vertical_fov = {}", rng.between(30.0, 50.0)),
    };
    let depth = [0, 1, 2, 3, 4, 4][(rng.bits() % 6) as usize];
    let sky = color(rng);
    w.text = format!(
        "[camera]\neye = {}\nlook_at = {}\n{lens}\n[image]\nwidth = {side}\nheight = {side}
[sampling]\nmax_depth = {depth}\n[background]\ncolor = {}
[[texture]]\nname = 'checker'\nprocedural = 'checker'\n",
        list(eye),
        list(look_at),
        list(sky)
    );
    let colors: Vec<DVec3> = (0..5).map(|_| color(&mut w.rng)).collect();
    w.material("plain", "unlit", colors[0], "");
    w.material("odd", "unlit", colors[1], "");
    w.material("black", "unlit", DVec3::ZERO, "");
    w.material("lit", "lambert", colors[2], "");
    w.material("pale", "lambert", colors[3], "");
    let squares = "texture = 'checker'\nmapping = { kind = 'surface', scale = [2.7, 2.7], rotate = 20 }\n";
    w.material("squares", "unlit", DVec3::ONE, squares);
    w.material("mirror", "mirror", 0.3 + 0.7 * colors[4], "");
    for _ in 0..w.rng.bits() % 3 {
        let rng = &mut w.rng;
        let place = DVec3::new(rng.between(-2.0, 2.0), rng.between(2.0, 3.5), rng.between(-1.0, 3.0));
        w.text += &match one_in(rng, 2) {
            true => format!("[[light]]\nkind = 'point'\nposition = {}\nintensity = [9, 9, 8]\n", list(place)),
            false => {
                format!(
                    "[[light]]\nkind = 'directional'\ndirection = {}\nirradiance = [2, 2, 3]\n",
                    list(place)
                )
            }
        };
    }
    let ground = DVec3::new(0.0, -0.6, 0.0);
    let level = [DVec3::X, -DVec3::Z];
    let below = if kind == Kind::MirrorGround { "mirror" } else { w.any_material() };
    match w.rng.bits() % 4 {
        _ if kind == Kind::MirrorGround => w.plane(0.5 * ground, level, None, below),
        0 => {}
        1 => w.plane(ground, level, Some(2.0), below),
        _ => w.plane(ground, level, None, below),
    }
    let n = within(&mut w.rng, 1.0).normalize_or(DVec3::Z);
    match kind {
        Kind::Plain | Kind::MirrorGround => {}
        Kind::Mirrors | Kind::Parallel => {
            w.any_triangle(DVec3::ZERO, 0.9, "mirror");
            let at = within(&mut w.rng, 0.5);
            w.mirror(at, n, 0.6);
        }
        Kind::Facing => {
            // Across the view, so that both are seen.
            let n = DVec3::new(1.0, 0.3 * n.y, 0.3 * n.z).normalize();
            w.mirror(0.7 * n, -n, 0.9);
            w.mirror(-0.7 * n, n, 0.9);
        }
        Kind::Crossing => {
            let other = within(&mut w.rng, 1.0).normalize_or(DVec3::X);
            w.mirror(0.2 * n, n, 0.8);
            w.mirror(0.2 * other, other, 0.8);
        }
    }
    while w.triangles < 6 {
        let around = within(&mut w.rng, 0.5);
        let material = w.any_material();
        w.any_triangle(around, 0.6, material);
    }
    if one_in(&mut w.rng, 2) {
        w.two_in_one_plane();
    }
    w.text
}

pub fn scene(text: &str) -> Scene {
    parse(Path::new("random.toml"), text).unwrap_or_else(|e| panic!("{e}\n{text}"))
}
