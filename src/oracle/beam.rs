//! One beam a pixel (Heckbert & Hanrahan 1984): the pixel's square, cut along the edges of the polygons that it
//! meets and where they pass through each other; of each visible piece the exact area in the pixel, and the
//! exact integral of its colour. Mirrors send the piece on. What this cannot do is left to samples. Twin of
//! `glsl/shared/beam_main.glsl`.

use std::f64::consts::PI;

use glam::{DVec3, DVec4};

use super::forms::{
    Frame, Quotient, Region, coordinates, may_meet_sphere, mirrored_frame, pixel_frame, point_at, ray_at,
    shadow_region, shape_plane, shape_region,
};
use super::math::xyz;
use super::polygon::{Form, LEAST_AREA, MAX_CORNERS, Polygon, area, middle, range, split, unit_square};
use super::rows::{Grid, SMALLEST, checker_grid, coarser, in_grid, longest_edge, mean_over, texture_grid};
use crate::layout::{Light, Material, NO_MATERIAL, NO_SHAPE, NO_TEXTURE};
use crate::pack::{EntityKind, LightKind, MapKind, PackedScene, TextureKind};
use crate::scene::model::Model;
use crate::texture::procedural::ProceduralKind;
use crate::texture::sampler_spec::{Address, Filter};

/// Shapes that a beam may meet.
const MAX_MET: usize = 8;
/// Pieces that wait at a time.
const MAX_PIECES: usize = 12;
/// Mirrored beams that wait at a time.
const MAX_BEAMS: usize = 6;
/// Cells of textures that a pixel's edges may cross.
const MOST_CELLS: u32 = 40_000;
/// Planes whose nearness differs by less, relatively, lie in each other: the first of the list is seen.
const COPLANAR: f64 = 4e-6;

/// A part of the pixel, and how its rays go.
struct Beam {
    polygon: Polygon,
    frame: Frame,
    carried: DVec3,
    /// The mirror that it left, and that one's nearness.
    skip: u32,
    limit: Form,
    depth: u32,
}

/// A part of the picture, of which the first `stage` tests are done.
#[derive(Clone, Copy)]
struct Piece {
    polygon: Polygon,
    stage: usize,
}

/// Too much for a beam.
struct GaveUp;

type Result<T> = std::result::Result<T, GaveUp>;

struct Met {
    shape: u32,
    region: Region,
}

/// The colour of a pixel of the film; none where it takes samples.
pub fn beam(scene: &PackedScene, [x, y]: [u32; 2]) -> Option<DVec3> {
    let header = &scene.header;
    let frame = pixel_frame(header, [x + header.image[2], y + header.image[3]]);
    let first = Beam {
        polygon: unit_square(),
        frame,
        carried: DVec3::ONE,
        skip: NO_SHAPE,
        limit: Form::ZERO,
        depth: 0,
    };
    let mut waiting = vec![first];
    let mut pixel = Pixel { scene, color: DVec3::ZERO, crossed: 0, pieces: Vec::new() };
    while let Some(beam) = waiting.pop() {
        pixel.follow(&beam, &mut waiting).ok()?;
    }
    Some(pixel.color)
}

struct Pixel<'a> {
    scene: &'a PackedScene,
    color: DVec3,
    crossed: u32,
    /// Those that wait.
    pieces: Vec<Piece>,
}

impl Pixel<'_> {
    fn follow(&mut self, beam: &Beam, waiting: &mut Vec<Beam>) -> Result<()> {
        let met = shapes_met(self.scene, beam)?;
        let mut left = area(&beam.polygon);
        for own in 0..met.len() {
            self.pieces.push(Piece { polygon: beam.polygon, stage: 0 });
            while let Some(piece) = self.pieces.pop() {
                // Stage 0 cuts out the shape itself, the others take away what lies before it.
                if piece.stage > met.len() {
                    left -= area(&piece.polygon);
                    self.shade(beam, &met[own], &piece.polygon, waiting)?;
                } else if piece.stage == own + 1 {
                    push(&mut self.pieces, Piece { stage: piece.stage + 1, ..piece })?;
                } else {
                    let kept = piece.stage == 0;
                    let by = &met[if kept { own } else { piece.stage - 1 }];
                    let first = if kept { beam.beyond_mirror(by) } else { before(by, &met[own], &piece.polygon) };
                    carve(&mut self.pieces, piece, &by.region, first, kept)?;
                }
            }
        }
        if left > LEAST_AREA {
            if self.scene.header.counts[3] != NO_MATERIAL {
                return Err(GaveUp);
            }
            self.color += left * beam.carried * xyz(self.scene.header.background);
        }
        Ok(())
    }

    /// A visible piece: its colour, or the beam that goes on.
    fn shade(&mut self, beam: &Beam, seen: &Met, polygon: &Polygon, waiting: &mut Vec<Beam>) -> Result<()> {
        let scene = self.scene;
        let [material, map] = links(scene, seen.shape);
        let record = &scene.materials[material as usize];
        let near = seen.region.nearness;
        let carried = beam.carried * xyz(record.color);
        let model = Model::ALL[record.link[0] as usize];
        let textured = record.link[1] != NO_TEXTURE;
        if !is_simple(scene, seen.shape, record, map) {
            return Err(GaveUp);
        }
        if model == Model::Mirror {
            if beam.depth < scene.header.size[3] {
                if waiting.len() == MAX_BEAMS {
                    return Err(GaveUp);
                }
                let plane = shape_plane(scene, seen.shape);
                waiting.push(Beam {
                    polygon: *polygon,
                    frame: mirrored_frame(&beam.frame, plane.truncate(), plane.w),
                    carried,
                    skip: seen.shape,
                    limit: near,
                    depth: beam.depth + 1,
                });
            }
            return Ok(());
        }
        let quotient = textured.then(|| coordinates(scene, &beam.frame, seen.shape, map, near));
        let paint = Paint { record, quotient, plane: shape_plane(scene, seen.shape), frame: beam.frame, near };
        let unlit = model == Model::Unlit;
        let lights = if unlit { 1 } else { scene.lights.len() };
        for i in 0..lights {
            let light = if unlit { None } else { Some(&scene.lights[i]) };
            let lit = self.lit_by(&paint, seen.shape, polygon, light)?;
            self.color += carried * lit;
        }
        Ok(())
    }

    /// The integral over those parts of a piece that see the light; without one, over all of it.
    fn lit_by(&mut self, paint: &Paint, shape: u32, polygon: &Polygon, light: Option<&Light>) -> Result<DVec3> {
        let scene = self.scene;
        let [planes, spheres, triangles, _] = scene.header.counts;
        let shapes = (planes + spheres + triangles) as usize;
        let mut sum = DVec3::ZERO;
        let bottom = self.pieces.len();
        match light {
            None => push(&mut self.pieces, Piece { polygon: *polygon, stage: shapes })?,
            Some(light) if is_lit(paint, polygon, light) => {
                push(&mut self.pieces, Piece { polygon: *polygon, stage: 0 })?;
            }
            Some(_) => {}
        }
        while self.pieces.len() > bottom {
            let Some(piece) = self.pieces.pop() else { break };
            let (by, Some(light)) = (piece.stage as u32, light.filter(|_| piece.stage < shapes)) else {
                sum += self.integral(paint, &piece.polygon, light)?;
                continue;
            };
            let is_sphere = by >= planes && by < planes + spheres;
            if is_sphere {
                let sphere = &scene.spheres[(by - planes) as usize];
                if may_shade(paint, &piece.polygon, light, xyz(sphere.ball), sphere.ball[3].into()) {
                    return Err(GaveUp);
                }
            }
            if by == shape || is_sphere {
                push(&mut self.pieces, Piece { stage: piece.stage + 1, ..piece })?;
                continue;
            }
            let region = shadow_region(scene, &paint.frame, paint.near, by, light);
            carve(&mut self.pieces, piece, &region, None, false)?;
        }
        Ok(sum)
    }

    /// ∬ of texture times irradiance / π over the piece, in strips within which the depth hardly changes: there
    /// equal areas of the texture are equal areas of the picture.
    fn integral(&mut self, paint: &Paint, polygon: &Polygon, light: Option<&Light>) -> Result<DVec3> {
        let scene = self.scene;
        let Paint { record, quotient, .. } = paint;
        let depth = match quotient {
            Some(quotient) => quotient.below,
            None if paint.frame.parallel => Form::Z,
            None => paint.near,
        };
        let (low, high) = range(polygon, depth);
        let span = (high / low.max(1e-30 * high)).ln().min(DEEPEST);
        let flat = quotient.is_none() && light.is_none();
        let strips = if flat { 1.0 } else { (STRIPS * span).sqrt().ceil().clamp(1.0, MOST_STRIPS) };
        let most = CELLS_OF_AN_EDGE + CELLS_OF_ALL / strips;
        let grid = quotient.map(|_| {
            let image = &scene.textures[record.link[1] as usize];
            if image.link[3] == TextureKind::Procedural as u32 {
                return checker_grid();
            }
            texture_grid(&scene.row_sums, record.link[1], image, &scene.samplers[record.link[2] as usize])
        });
        let mut rest = *polygon;
        let mut sum = DVec3::ZERO;
        for k in 1..=strips as u32 {
            let mut strip = rest;
            if f64::from(k) < strips {
                let limit = high * (-span * f64::from(k) / strips).exp();
                [strip, rest] = split(&rest, depth - limit * Form::Z);
                if strip.count > MAX_CORNERS || rest.count > MAX_CORNERS {
                    return Err(GaveUp);
                }
            }
            let share = area(&strip);
            if strip.count < 3 || share <= 0.0 {
                continue;
            }
            let color = match (quotient, &grid) {
                (Some(quotient), Some(grid)) => {
                    let mean = mean_color(scene, record, grid, &strip, quotient, most, &mut self.crossed);
                    mean.ok_or(GaveUp)?
                }
                _ => DVec3::ONE,
            };
            if self.crossed > MOST_CELLS {
                return Err(GaveUp);
            }
            let irradiance = light.map_or(DVec3::ONE, |light| irradiance(paint, &strip, light));
            sum += share * color * irradiance;
        }
        Ok(sum)
    }
}

/// Strips that a piece is cut into: √(STRIPS · logarithm of the ratio of depths).
const STRIPS: f64 = 2000.0;
const MOST_STRIPS: f64 = 64.0;
/// What lies e^7 times as deep as the piece's nearest part counts as one strip.
const DEEPEST: f64 = 7.0;
/// Cells that an edge of a strip may cross, and what all strips of a piece share beyond that.
const CELLS_OF_AN_EDGE: f64 = 32.0;
const CELLS_OF_ALL: f64 = 512.0;

/// What a piece is painted with.
struct Paint<'a> {
    record: &'a Material,
    quotient: Option<Quotient>,
    plane: DVec4,
    frame: Frame,
    near: Form,
}

impl Beam {
    /// Positive beyond the mirror that the beam left.
    fn beyond_mirror(&self, met: &Met) -> Option<Form> {
        (self.skip != NO_SHAPE).then(|| self.limit - met.region.nearness)
    }
}

/// All that the beam may meet.
fn shapes_met(scene: &PackedScene, beam: &Beam) -> Result<Vec<Met>> {
    let [planes, spheres, triangles, _] = scene.header.counts;
    let mut met = Vec::new();
    for shape in 0..planes + spheres + triangles {
        if shape == beam.skip {
            continue;
        }
        if shape >= planes && shape < planes + spheres {
            if may_meet_sphere(&beam.frame, &beam.polygon, &scene.spheres[(shape - planes) as usize]) {
                return Err(GaveUp);
            }
            continue;
        }
        let region = shape_region(scene, &beam.frame, shape);
        let touches = region.lines[..region.count].iter().all(|&line| range(&beam.polygon, line).1 > 0.0);
        if touches {
            if met.len() == MAX_MET {
                return Err(GaveUp);
            }
            met.push(Met { shape, region });
        }
    }
    Ok(met)
}

/// Positive where `by` lies before `own`.
fn before(by: &Met, own: &Met, polygon: &Polygon) -> Option<Form> {
    let apart = by.region.nearness - own.region.nearness;
    let (low, high) = range(polygon, apart);
    let (least, most) = range(polygon, own.region.nearness);
    if high.max(-low) > COPLANAR * most.max(-least) {
        return Some(apart);
    }
    Some(if by.shape < own.shape { Form::Z } else { -Form::Z })
}

/// Cuts the piece along the lines of a region, of which `first` is one more. What lies within them all is
/// kept, or all else is.
fn carve(pieces: &mut Vec<Piece>, piece: Piece, region: &Region, first: Option<Form>, kept: bool) -> Result<()> {
    let mut rest = piece.polygon;
    let lines = first.into_iter().chain(region.lines[..region.count].iter().copied());
    for line in lines {
        let [inside, outside] = split(&rest, line);
        if inside.count > MAX_CORNERS || outside.count > MAX_CORNERS {
            return Err(GaveUp);
        }
        if !kept && area(&outside) > LEAST_AREA {
            push(pieces, Piece { polygon: outside, stage: piece.stage + 1 })?;
        }
        rest = inside;
        if area(&rest) <= LEAST_AREA {
            return Ok(());
        }
    }
    if kept { push(pieces, Piece { polygon: rest, stage: piece.stage + 1 }) } else { Ok(()) }
}

fn push(pieces: &mut Vec<Piece>, piece: Piece) -> Result<()> {
    if pieces.len() == MAX_PIECES {
        return Err(GaveUp);
    }
    pieces.push(piece);
    Ok(())
}

/// Material and map.
fn links(scene: &PackedScene, shape: u32) -> [u32; 2] {
    let [planes, spheres, _, _] = scene.header.counts;
    let [material, map, _, _] = if shape < planes {
        scene.planes[shape as usize].link
    } else {
        scene.triangles[(shape - planes - spheres) as usize].link
    };
    [material, map]
}

/// Whether the integral of a shape's colour is known: of one that is unlit, diffuse or a plane mirror, with a
/// checker or a flat texture that is affine on it.
fn is_simple(scene: &PackedScene, shape: u32, record: &Material, map: u32) -> bool {
    let [planes, spheres, _, _] = scene.header.counts;
    let [model, texture, sampler, _] = record.link;
    let smooth = shape >= planes && scene.triangles[(shape - planes - spheres) as usize].v[3] != 0.0;
    let model = Model::ALL[model as usize];
    let shades = model == Model::Unlit || (matches!(model, Model::Lambert | Model::Mirror) && !smooth);
    if !shades || record.detail[0] != NO_TEXTURE {
        return false;
    }
    if texture == NO_TEXTURE {
        return true;
    }
    let [kind, entity, _, _] = scene.maps[map as usize].link;
    let flat = [MapKind::Plane as u32, MapKind::VertexUv as u32, MapKind::Affine as u32].contains(&kind);
    if !flat || entity != EntityKind::Position as u32 || model == Model::Mirror {
        return false;
    }
    let image = &scene.textures[texture as usize];
    if image.link[3] == TextureKind::Procedural as u32 {
        let [kind, _, _, dimensions] = scene.procedurals[image.place[0] as usize].link;
        return kind == ProceduralKind::Checker as u32 && dimensions < 3;
    }
    let sampler = &scene.samplers[sampler as usize];
    let known = |address: u32| {
        use Address::{ClampToEdge, MirroredRepeat, Repeat};
        [Repeat as u32, MirroredRepeat as u32, ClampToEdge as u32].contains(&address)
    };
    let steps = [Filter::Nearest as u32, Filter::Linear as u32].contains(&sampler.modes[2]);
    steps && known(sampler.modes[0]) && known(sampler.modes[1]) && scene.row_sums[texture as usize] > 0
}

fn mean_color(
    scene: &PackedScene,
    record: &Material,
    grid: &Grid,
    strip: &Polygon,
    quotient: &Quotient,
    most: f64,
    crossed: &mut u32,
) -> Option<DVec3> {
    let reach = longest_edge(strip, &in_grid(grid, quotient, [0, 0]));
    // The level at which it is short enough.
    let grid = if reach > most { coarser(*grid, (reach / most).log2().ceil() as i64) } else { *grid };
    if grid.unknown {
        return None;
    }
    let mean = mean_over(&grid, strip, quotient, reach < SMALLEST, crossed);
    let image = &scene.textures[record.link[1] as usize];
    if image.link[3] == TextureKind::Procedural as u32 {
        let what = &scene.procedurals[image.place[0] as usize];
        return Some(xyz(what.background).lerp(xyz(what.figure), mean.x));
    }
    Some(DVec3::splat(grid.least) + grid.step * mean)
}

/// A light behind the surface, as its beam sees it, gives nothing.
fn is_lit(paint: &Paint, polygon: &Polygon, light: &Light) -> bool {
    let n = paint.plane.truncate();
    let (way, _) = ray_at(&paint.frame, middle(polygon));
    let place = xyz(light.place);
    let above = if light.link[0] == LightKind::Point as u32 { n.dot(place) - paint.plane.w } else { n.dot(place) };
    above * n.dot(way) < 0.0
}

/// Irradiance over π at the middle of a strip, of a light that it sees.
fn irradiance(paint: &Paint, strip: &Polygon, light: &Light) -> DVec3 {
    let n = paint.plane.truncate();
    let place = xyz(light.place);
    let power = xyz(light.power) / PI;
    if light.link[0] != LightKind::Point as u32 {
        return power * n.dot(place).abs();
    }
    let way = place - point_at(&paint.frame, paint.near, middle(strip));
    let squared = way.length_squared();
    power * n.dot(way).abs() / (squared * squared.sqrt())
}

/// False where no way from the piece to the light can pass the sphere.
fn may_shade(paint: &Paint, polygon: &Polygon, light: &Light, center: DVec3, radius: f64) -> bool {
    let from = point_at(&paint.frame, paint.near, middle(polygon));
    let point = |k: usize| point_at(&paint.frame, paint.near, polygon.corners[k]);
    let wide = (0..polygon.count).map(|k| (point(k) - from).length()).fold(0.0, f64::max);
    let place = xyz(light.place);
    let way = if light.link[0] == LightKind::Point as u32 { place - from } else { place };
    let to = center - from;
    let squared = way.length_squared();
    let mut along = (to.dot(way) / squared).max(0.0);
    if light.link[0] == LightKind::Point as u32 {
        along = along.min(1.0);
    }
    (to - along * way).length() <= radius + wide
}
