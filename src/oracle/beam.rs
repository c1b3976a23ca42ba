//! One beam a pixel (Heckbert & Hanrahan 1984): the pixel's square, cut along the edges of the polygons that it
//! meets and where they pass through each other; of each visible fragment the exact area in the pixel, and the
//! exact integral of its colour. Mirrors send the fragment on. What this cannot do is left to samples. Twin of
//! `glsl/shared/beam_main.glsl`.

use glam::DVec3;

use super::bsdf::{is_lit, is_specular};
use super::geometry::beams::{
    coordinates, has_region, may_meet, may_shade, shadow_region, shape_links, shape_plane, shape_region,
};
use super::geometry::kinds::shape_count;
use super::polygon::{AffineFunction, MAX_CORNERS, MIN_AREA, Polygon, area, range, split, unit_square};
use super::projective::{ConvexRegion, PixelFrustum, add, mirrored_frame, pixel_frame};
use super::shading_integral::{GaveUp, Result, ShadingIntegral, integral, is_facing, is_simple};
use crate::pack::{LightKind, PackedScene};
use crate::schema::layout::{Light, NO_MATERIAL, NO_SHAPE, NO_TEXTURE};

/// Shapes that a beam may meet.
const MAX_MET: usize = 8;
/// Pieces that wait at a time.
const MAX_FRAGMENTS: usize = 12;
/// Mirrored beams that wait at a time.
const MAX_BEAMS: usize = 6;
/// Planes whose inverse depth differs by less, relatively, lie in each other: the first of the list is seen.
const COPLANAR: f64 = 4e-6;

/// A part of the pixel, and how its rays go.
struct PixelBeam {
    polygon: Polygon,
    frame: PixelFrustum,
    carried: DVec3,
    /// The mirror that it left, and that one's inverse_depth.
    skip: u32,
    limit: AffineFunction,
    depth: u32,
}

/// A part of the picture, of which the first `stage` tests are done.
#[derive(Clone, Copy)]
struct Fragment {
    polygon: Polygon,
    stage: usize,
}

struct Met {
    shape: u32,
    region: ConvexRegion,
}

/// The colour of a pixel of the film; none where it takes samples.
pub fn beam(scene: &PackedScene, [x, y]: [u32; 2]) -> Option<DVec3> {
    let header = &scene.header;
    let frame = pixel_frame(header, [x + header.crop.x, y + header.crop.y]);
    let first = PixelBeam {
        polygon: unit_square(),
        frame,
        carried: DVec3::ONE,
        skip: NO_SHAPE,
        limit: AffineFunction::ZERO,
        depth: 0,
    };
    let mut waiting = vec![first];
    let mut pixel = Pixel { scene, color: DVec3::ZERO, crossed: 0, fragments: Vec::new() };
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
    fragments: Vec<Fragment>,
}

impl Pixel<'_> {
    /// Adds all that one beam sees but for what its mirrors send on.
    fn follow(&mut self, beam: &PixelBeam, waiting: &mut Vec<PixelBeam>) -> Result<()> {
        let met = shapes_met(self.scene, beam)?;
        let mut left = area(&beam.polygon);
        for own in 0..met.len() {
            self.fragments.push(Fragment { polygon: beam.polygon, stage: 0 });
            while let Some(fragment) = self.fragments.pop() {
                // Stage 0 cuts out the shape itself, the others take away what lies before it.
                if fragment.stage > met.len() {
                    left -= area(&fragment.polygon);
                    self.shade(beam, &met[own], &fragment.polygon, waiting)?;
                } else if fragment.stage == own + 1 {
                    push(&mut self.fragments, Fragment { stage: fragment.stage + 1, ..fragment })?;
                } else {
                    let kept = fragment.stage == 0;
                    let by = &met[if kept { own } else { fragment.stage - 1 }];
                    let first = (!kept).then(|| before(by, &met[own], &fragment.polygon));
                    carve(&mut self.fragments, fragment, &by.region, first, kept)?;
                }
            }
        }
        if left > MIN_AREA {
            if self.scene.header.environment_material != NO_MATERIAL {
                return Err(GaveUp);
            }
            self.color += left * beam.carried * self.scene.header.background.as_dvec3();
        }
        Ok(())
    }

    /// Adds the colour of a visible fragment, or sends its beam on.
    fn shade(
        &mut self,
        beam: &PixelBeam,
        seen: &Met,
        polygon: &Polygon,
        waiting: &mut Vec<PixelBeam>,
    ) -> Result<()> {
        let scene = self.scene;
        let [material, map] = shape_links(scene, seen.shape);
        let record = &scene.records.materials[material as usize];
        let near = seen.region.inverse_depth;
        let carried = beam.carried * record.color.as_dvec3();
        let textured = record.texture_index != NO_TEXTURE;
        if !is_simple(scene, seen.shape, record, map) {
            return Err(GaveUp);
        }
        if is_specular(record.model) {
            if beam.depth < scene.header.max_depth {
                if waiting.len() == MAX_BEAMS {
                    return Err(GaveUp);
                }
                let plane = shape_plane(scene, seen.shape);
                waiting.push(PixelBeam {
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
        let paint = ShadingIntegral {
            record,
            carried,
            quotient,
            plane: shape_plane(scene, seen.shape),
            frame: beam.frame,
            near,
        };
        let unlit = !is_lit(record.model);
        let lights = if unlit { 1 } else { scene.records.lights.len() };
        for i in 0..lights {
            let light = if unlit { None } else { Some(&scene.records.lights[i]) };
            // Of lights with an extent beams do not know the penumbra.
            if light.is_some_and(|l| l.kind >= LightKind::Sphere) {
                return Err(GaveUp);
            }
            self.lit_by(&paint, seen.shape, polygon, light)?;
        }
        Ok(())
    }

    /// Adds the integral over those parts of a fragment that see the light; without one, over all of it.
    fn lit_by(
        &mut self,
        paint: &ShadingIntegral,
        shape: u32,
        polygon: &Polygon,
        light: Option<&Light>,
    ) -> Result<()> {
        let scene = self.scene;
        let shapes = shape_count(scene) as usize;
        let bottom = self.fragments.len();
        match light {
            None => push(&mut self.fragments, Fragment { polygon: *polygon, stage: shapes })?,
            Some(light) if is_facing(paint, polygon, light) => {
                push(&mut self.fragments, Fragment { polygon: *polygon, stage: 0 })?;
            }
            Some(_) => {}
        }
        let least = if paint.frame.parallel { negligible(paint.near, polygon) } else { COPLANAR };
        while self.fragments.len() > bottom {
            let Some(fragment) = self.fragments.pop() else { break };
            let (by, Some(light)) = (fragment.stage as u32, light.filter(|_| fragment.stage < shapes)) else {
                let color = integral(scene, paint, &fragment.polygon, light, &mut self.crossed)?;
                self.color += paint.carried * color;
                continue;
            };
            let round = !has_region(scene, by);
            if round && may_shade(scene, (&paint.frame, paint.near), &fragment.polygon, light, by) {
                return Err(GaveUp);
            }
            if by == shape || round {
                push(&mut self.fragments, Fragment { stage: fragment.stage + 1, ..fragment })?;
                continue;
            }
            let region = shadow_region(scene, &paint.frame, paint.near, by, light);
            // What lies in the surface's own plane, or beyond it, keeps no light away.
            if range(&fragment.polygon, region.lines[0]).1 <= least {
                push(&mut self.fragments, Fragment { stage: fragment.stage + 1, ..fragment })?;
                continue;
            }
            carve(&mut self.fragments, fragment, &region, None, false)?;
        }
        Ok(())
    }
}

/// Differences of inverse depth that are none.
fn negligible(inverse_depth: AffineFunction, polygon: &Polygon) -> f64 {
    let (low, high) = range(polygon, inverse_depth);
    COPLANAR * high.max(-low)
}

/// All that the beam may meet. Behind a mirror that is what lies beyond it: what lies before it neither is seen
/// nor hides anything.
fn shapes_met(scene: &PackedScene, beam: &PixelBeam) -> Result<Vec<Met>> {
    let mut met = Vec::new();
    let mirrored = beam.skip != NO_SHAPE;
    let least = if mirrored { negligible(beam.limit, &beam.polygon) } else { 0.0 };
    for shape in 0..shape_count(scene) {
        if shape == beam.skip {
            continue;
        }
        if !has_region(scene, shape) {
            if may_meet(scene, &beam.frame, &beam.polygon, shape) {
                return Err(GaveUp);
            }
            continue;
        }
        let mut region = shape_region(scene, &beam.frame, shape);
        if mirrored {
            let beyond = beam.limit - region.inverse_depth;
            let (low, high) = range(&beam.polygon, beyond);
            if high <= least {
                continue;
            }
            if low < 0.0 {
                add(&mut region, beyond);
            }
        }
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
fn before(by: &Met, own: &Met, polygon: &Polygon) -> AffineFunction {
    let apart = by.region.inverse_depth - own.region.inverse_depth;
    let (low, high) = range(polygon, apart);
    if high.max(-low) > negligible(own.region.inverse_depth, polygon) {
        return apart;
    }
    if by.shape < own.shape { AffineFunction::Z } else { -AffineFunction::Z }
}

/// Cuts the fragment along the lines of a region, of which `first` is one more. What lies within them all is
/// kept, or all else is.
fn carve(
    fragments: &mut Vec<Fragment>,
    fragment: Fragment,
    region: &ConvexRegion,
    first: Option<AffineFunction>,
    kept: bool,
) -> Result<()> {
    let mut rest = fragment.polygon;
    let lines = first.into_iter().chain(region.lines[..region.count].iter().copied());
    for line in lines {
        let [inside, outside] = split(&rest, line);
        if inside.count > MAX_CORNERS || outside.count > MAX_CORNERS {
            return Err(GaveUp);
        }
        if !kept && area(&outside) > MIN_AREA {
            push(fragments, Fragment { polygon: outside, stage: fragment.stage + 1 })?;
        }
        rest = inside;
        if area(&rest) <= MIN_AREA {
            return Ok(());
        }
    }
    if kept { push(fragments, Fragment { polygon: rest, stage: fragment.stage + 1 }) } else { Ok(()) }
}

fn push(fragments: &mut Vec<Fragment>, fragment: Fragment) -> Result<()> {
    if fragments.len() == MAX_FRAGMENTS {
        return Err(GaveUp);
    }
    fragments.push(fragment);
    Ok(())
}
