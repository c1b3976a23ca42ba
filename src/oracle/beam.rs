//! One beam per pixel (Heckbert & Hanrahan 1984): the pixel's square is cut along the edges of the polygons
//! that it meets and along their intersections; each visible fragment contributes its exact area in the pixel
//! and the exact integral of its colour. Mirrors reflect the fragment's beam. Pixels beyond this are left to
//! samples. Twin of `glsl/shared/beam_main.glsl`.

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

/// Most shapes that a beam may meet.
const MAX_MET: usize = 8;
/// Most pending fragments.
const MAX_FRAGMENTS: usize = 12;
/// Most pending mirrored beams.
const MAX_BEAMS: usize = 6;
/// Planes whose inverse depths differ by a smaller relative amount are coplanar: the first in the list is
/// visible.
const COPLANAR: f64 = 4e-6;

/// A part of the pixel, and its rays.
struct PixelBeam {
    polygon: Polygon,
    frame: PixelFrustum,
    carried: DVec3,
    /// The mirror that it left, and that mirror's inverse depth.
    skip: u32,
    limit: AffineFunction,
    depth: u32,
}

/// A part of the picture, for which the first `stage` tests are done.
#[derive(Clone, Copy)]
struct Fragment {
    polygon: Polygon,
    stage: usize,
}

struct Met {
    shape: u32,
    region: ConvexRegion,
}

/// Returns the colour of a pixel of the film; `None` if it needs samples.
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
    /// The pending fragments.
    fragments: Vec<Fragment>,
}

impl Pixel<'_> {
    /// Adds everything that one beam sees, except through its mirrors.
    fn follow(&mut self, beam: &PixelBeam, waiting: &mut Vec<PixelBeam>) -> Result<()> {
        let met = shapes_met(self.scene, beam)?;
        let mut left = area(&beam.polygon);
        for own in 0..met.len() {
            self.fragments.push(Fragment { polygon: beam.polygon, stage: 0 });
            while let Some(fragment) = self.fragments.pop() {
                // Stage 0 clips to the shape itself, the other stages remove the parts hidden by each shape.
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

    /// Adds the colour of a visible fragment, or pushes the mirrored beam.
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
            // Beams cannot integrate the penumbra of area lights.
            if light.is_some_and(|l| l.kind >= LightKind::Spot) {
                return Err(GaveUp);
            }
            self.lit_by(&paint, seen.shape, polygon, light)?;
        }
        Ok(())
    }

    /// Adds the integral over the parts of a fragment that see the light; without a light, over all of it.
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
            // A shape in the surface's own plane, or below it, does not occlude the light.
            if range(&fragment.polygon, region.lines[0]).1 <= least {
                push(&mut self.fragments, Fragment { stage: fragment.stage + 1, ..fragment })?;
                continue;
            }
            carve(&mut self.fragments, fragment, &region, None, false)?;
        }
        Ok(())
    }
}

/// Returns the difference of inverse depths below which planes count as coplanar.
fn negligible(inverse_depth: AffineFunction, polygon: &Polygon) -> f64 {
    let (low, high) = range(polygon, inverse_depth);
    COPLANAR * high.max(-low)
}

/// Returns all shapes that the beam may meet. For a beam from a mirror these are clipped to the mirror's
/// front: anything behind it is neither visible nor an occluder.
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

/// Returns a function that is positive where `by` is nearer than `own`.
fn before(by: &Met, own: &Met, polygon: &Polygon) -> AffineFunction {
    let apart = by.region.inverse_depth - own.region.inverse_depth;
    let (low, high) = range(polygon, apart);
    if high.max(-low) > negligible(own.region.inverse_depth, polygon) {
        return apart;
    }
    if by.shape < own.shape { AffineFunction::Z } else { -AffineFunction::Z }
}

/// Cuts the fragment along the lines of a region, preceded by the line `first`. If `kept`, the part within
/// all lines is kept, otherwise the parts outside.
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
