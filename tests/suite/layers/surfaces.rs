//! The layer of surfaces on meshes, with known answers: layers of one mesh over each other, sheets that fold over
//! themselves, outlines, and edges.

use std::f64::consts::{FRAC_PI_2, PI};
use std::fmt::Write;
use std::fs;

use moire::internal::render::layers::Aov;
use moire::internal::scene::{self, prune::prune};

use super::{DOWN, layer, stage};

/// An OBJ file.
#[derive(Default)]
struct Obj {
    text: String,
    vertices: usize,
}

impl Obj {
    /// Adds a sheet: a profile of places (x, y) and, where it is smooth, normals there, drawn along z in `columns` parts.
    fn sheet(mut self, profile: &[[f64; 2]], normals: Option<&[[f64; 2]]>, columns: usize) -> Obj {
        let first = self.vertices + 1;
        for (i, [x, y]) in profile.iter().enumerate() {
            for k in 0..=columns {
                let z = 4.0 * k as f64 / columns as f64 - 2.0;
                writeln!(self.text, "v {x} {y} {z}").unwrap();
                if let Some([nx, ny]) = normals.map(|normals| normals[i]) {
                    writeln!(self.text, "vn {nx} {ny} 0").unwrap();
                }
            }
        }
        let corner = |i: usize| if normals.is_some() { format!("{i}//{i}") } else { i.to_string() };
        for i in 0..profile.len() - 1 {
            for k in 0..columns {
                let a = first + i * (columns + 1) + k;
                let quad = [a, a + 1, a + columns + 2, a + columns + 1].map(corner);
                writeln!(self.text, "f {}", quad.join(" ")).unwrap();
            }
        }
        self.vertices += profile.len() * (columns + 1);
        self
    }

    fn flat(self, y: f64, [from, to]: [f64; 2], parts: usize) -> Obj {
        let at = |i: usize| [from + (to - from) * i as f64 / parts as f64, y];
        self.sheet(&(0..=parts).map(at).collect::<Vec<_>>(), None, parts)
    }
}

/// Seen from above by 16 columns of pixels from -1 to 1; returns the count of each pixel.
fn counts(obj: &Obj, spp: u32) -> Vec<f32> {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("m.obj"), &obj.text).unwrap();
    let head = DOWN.split("[[texture]]").next().unwrap();
    let text = format!(
        "{head}[sampling]\nspp = {spp}\n[[material]]\nname = 'm'\nmodel = 'unlit'\n[[mesh]]\nfile = 'm.obj'\nmaterial = 'm'\n"
    );
    let mut scene = scene::load(&stage(folder.path(), &text)).unwrap();
    prune(&mut scene);
    layer(&scene, Aov::Surfaces).channels.remove(0).values
}

/// Checks every row: `several` has the columns that see more than one surface.
fn columns(obj: &Obj, spp: u32, several: &[(usize, f32)]) {
    for (i, count) in counts(obj, spp).into_iter().enumerate() {
        let wanted = several.iter().find(|(column, _)| *column == i % 16).map_or(1.0, |(_, count)| *count);
        assert_eq!(count, wanted, "column {}, row {}", i % 16, i / 16);
    }
}

#[test]
fn parallel_quads_of_one_mesh_overlap_where_an_edge_is() {
    // Edges cut columns 1, 4, 11 and 14 in the middle. Few triangles are shapes of their own, many are one.
    for parts in [1, 8] {
        let both = Obj::default().flat(0.0, [-0.8125, 0.8125], parts).flat(0.5, [-0.4375, 0.4375], parts);
        columns(&both, 16, &[(1, 2.0), (4, 2.0), (11, 2.0), (14, 2.0)]);
    }
}

#[test]
fn two_edges_in_a_pixel_show_two_layers_and_the_background() {
    for parts in [1, 8] {
        let both = Obj::default().flat(0.0, [-0.84, 2.0], parts).flat(0.5, [-0.79, 2.0], parts);
        columns(&both, 16, &[(1, 3.0)]);
    }
}

#[test]
fn layers_much_nearer_than_a_pixel_is_wide_are_one() {
    let both = Obj::default().flat(0.0, [-2.0, 2.0], 8).flat(0.005, [-0.4375, 0.4375], 8);
    columns(&both, 16, &[]);
}

#[test]
fn a_smooth_sheet_that_folds_over_itself_is_two_surfaces_at_its_end_and_one_at_its_bend() {
    // Below to the right, around a half circle, and back above as far as the middle of column 4.
    let (mut profile, mut normals) = (vec![[-2.0, 0.0]], vec![[0.0, 1.0]]);
    for i in 0..=32 {
        let turn = PI * f64::from(i) / 32.0 - FRAC_PI_2;
        profile.push([0.5 + 0.25 * turn.cos(), 0.25 + 0.25 * turn.sin()]);
        normals.push([-turn.cos(), -turn.sin()]);
    }
    profile.push([-0.4375, 0.5]);
    normals.push([0.0, -1.0]);
    let folded = Obj::default().sheet(&profile, Some(&normals), 2);
    columns(&folded, 64, &[(4, 2.0)]);
}

#[test]
fn the_outline_of_a_ball_of_triangles_sees_it_and_the_background() {
    let (radius, rings, parts) = (0.75, 24, 48);
    let mut ball = Obj::default();
    for i in 0..=rings {
        for k in 0..=parts {
            let (tilt, turn) =
                (PI * f64::from(i) / f64::from(rings), 2.0 * PI * f64::from(k) / f64::from(parts));
            let n = [tilt.sin() * turn.cos(), tilt.cos(), tilt.sin() * turn.sin()];
            writeln!(ball.text, "v {} {} {}", radius * n[0], radius * n[1], radius * n[2]).unwrap();
            writeln!(ball.text, "vn {} {} {}", n[0], n[1], n[2]).unwrap();
        }
    }
    for i in 0..rings {
        for k in 0..parts {
            let a = i * (parts + 1) + k + 1;
            let quad = [a, a + 1, a + parts + 2, a + parts + 1].map(|i| format!("{i}//{i}"));
            writeln!(ball.text, "f {}", quad.join(" ")).unwrap();
        }
    }
    let mut outline = 0;
    for (i, count) in counts(&ball, 16).into_iter().enumerate() {
        let side = |at: usize| [at, at + 1].map(|edge| (edge as f64 / 8.0 - 1.0).abs());
        let [x, y] = [side(i % 16), side(i / 16)];
        let farthest = x[0].max(x[1]).hypot(y[0].max(y[1]));
        let nearest = x[0].min(x[1]).hypot(y[0].min(y[1]));
        // Triangles lie within the ball, by less than a hundredth of the radius.
        if farthest < 0.99 * radius || nearest > radius {
            assert_eq!(count, 1.0, "pixel {i}");
        } else {
            assert!(count <= 2.0, "pixel {i}: {count}");
            outline += usize::from(count == 2.0);
        }
    }
    assert!(outline >= 32, "{outline} pixels of the outline");
}

#[test]
fn a_sharp_edge_is_between_two_surfaces_and_a_blunt_one_within_one() {
    let roof = |slope: f64, parts: usize| {
        let profile = [[-2.0, -1.9375 * slope], [-0.0625, 0.0], [2.0, -2.0625 * slope]];
        Obj::default().sheet(&profile, None, parts)
    };
    for parts in [1, 40] {
        columns(&roof(1.0, parts), 16, &[(7, 2.0)]);
        // 10 degrees to each side.
        columns(&roof(0.176, parts), 16, &[]);
    }
}
