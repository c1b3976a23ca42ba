//! The layer of surfaces: how many of them the samples of a pixel meet. Two samples meet the same surface if they meet the
//! same shape, and on triangles also the same smooth part of it: shading normals turn by less than an angle, and the way
//! from one to the other follows both facets; or if other samples of the pixel lead from one to the other in such steps.
//! Input: a scene, and backends that measure places and facets. Output: one number a pixel.

use std::collections::BTreeMap;

use glam::{DVec2, DVec3};
use rayon::prelude::*;

use super::layers::lightless;
use crate::core::error::Result;
use crate::core::film::Film;
use crate::core::progress::{Progress, SubProgress};
use crate::core::range::{Range, Rect};
use crate::sampling::Backend;
use crate::scene::model::{Facets, Footprint, Pattern, PixelFilter, Quantity, Scene};

/// More different surfaces in a pixel count as so many.
pub const MAX_SURFACES: usize = 8;
/// Samples that look for surfaces: those of the scene, at most so many; or so many of another pattern, if the scene has
/// fewer than the least number.
const MAX_LOOKING: u32 = 64;
const LOOKING: u32 = 16;
const MIN_LOOKING: u32 = 4;
/// Samples that are held at once, but for those of a row.
const AT_ONCE: u32 = 1 << 22;

/// Cosine of 30 degrees, by which a smooth surface may turn between two samples: below it, modelling programs shade edges
/// smoothly unless told otherwise.
const SMOOTH_COSINE: f64 = 0.866_025_403_784_438_6;
/// Sine of 15 degrees: a surface that turns evenly by 30 leaves the chord between its ends by half of that.
const CHORD_SINE: f64 = 0.258_819_045_102_520_8;

/// Returns the scene whose samples look for surfaces, each within its own pixel.
pub(super) fn looking(scene: &Scene) -> Scene {
    let mut scene = lightless(scene);
    scene.pixel_filter = PixelFilter::default();
    let sampling = &mut scene.sampling;
    (sampling.footprint, sampling.quantity) = (Footprint::None, Quantity::Albedo);
    if sampling.samples() < MIN_LOOKING {
        (sampling.pattern, sampling.spp, sampling.shared) = (Pattern::SobolOwen, LOOKING, false);
    }
    sampling.spp = sampling.spp.min(MAX_LOOKING);
    scene
}

/// What a shape is a part of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Whole {
    number: u32,
    has_facets: bool,
}

/// Returns for each shape, by its number from 1, what it is a part of; 0 is the background. Single triangles of a material
/// are one whole.
fn wholes(scene: &Scene) -> Vec<Whole> {
    let mut first_of = BTreeMap::new();
    let of = |(number, shape): (u32, &dyn crate::scene::model::Shape)| match shape.facets() {
        Facets::None => Whole { number, has_facets: false },
        Facets::One => {
            let number = *first_of.entry(shape.material()).or_insert(number);
            Whole { number, has_facets: true }
        }
        Facets::Many => Whole { number, has_facets: true },
    };
    let background = Whole { number: 0, has_facets: false };
    std::iter::once(background).chain((1..).zip(scene.shapes.iter()).map(of)).collect()
}

/// Takes samples from a backend.
pub(super) type Take<'t> = dyn FnMut(&mut dyn Backend) -> Result<()> + 't;
/// Opens a backend that measures a quantity of the samples, and hands it over.
pub(super) type Measure<'m> = dyn FnMut(Quantity, &mut Take<'_>) -> Result<()> + 'm;

/// Returns the number of different surfaces that the samples of each pixel meet, as the first of three values.
pub(super) fn count_surfaces(
    measure: &mut Measure<'_>,
    scene: &Scene,
    [width, height]: [u32; 2],
    progress: &dyn Progress,
) -> Result<Film> {
    let samples = scene.sampling.samples();
    let wholes = wholes(scene);
    let mut counts = Film::new(width, height, samples);
    for pixels in Rect::whole([width, height]).strips((AT_ONCE / (width * samples)).max(1)) {
        let mut met = vec![Met::default(); pixels.area() * samples as usize];
        for (number, quantity) in (0..).zip([Quantity::Facet, Quantity::Place]) {
            measure(quantity, &mut |backend| {
                for s in 0..samples {
                    let done = f64::from(number * samples + s) / f64::from(2 * samples);
                    let rows = f64::from(pixels.y) + done * f64::from(pixels.height);
                    let done = rows / f64::from(height);
                    let part = SubProgress { whole: progress, from: done, to: done };
                    let sums = backend.sum(&Range { pixels, samples: s..s + 1 }, &part)?;
                    let own = met.iter_mut().skip(s as usize).step_by(samples as usize);
                    for (met, value) in own.zip(sums.blocks().iter().flat_map(|block| &block.sums)) {
                        let value = value.map(|part| part as f32);
                        if quantity == Quantity::Facet {
                            met.facet = value;
                        } else {
                            met.place = value;
                        }
                    }
                }
                Ok(())
            })?;
        }
        let first = (pixels.y * width) as usize;
        let of_pixels = met.par_chunks_exact(samples as usize);
        of_pixels.zip(&mut counts.pixels[first..first + pixels.area()]).for_each(|(met, pixel)| {
            *pixel = [surfaces(met, &wholes) as f32, 0.0, 1.0];
        });
    }
    Ok(counts)
}

/// What a sample meets, as backends measure it.
#[derive(Clone, Copy, Debug, Default)]
struct Met {
    facet: [f32; 3],
    place: [f32; 3],
}

/// The place of a sample, and two normals there.
struct Place {
    whole: Whole,
    at: DVec3,
    facet: DVec3,
    normal: DVec3,
}

impl Place {
    fn new(met: &Met, wholes: &[Whole]) -> Place {
        let [shape, facet, normal] = met.facet;
        let whole = wholes.get(shape as usize).copied().unwrap_or(wholes[0]);
        let [facet, normal] = [facet, normal].map(|number| direction(number.into()));
        Place { whole, at: DVec3::from_array(met.place.map(f64::from)), facet, normal }
    }

    /// Returns true if a smooth surface may lead from one to the other without a third in between.
    fn is_beside(&self, other: &Place) -> bool {
        if self.whole != other.whole {
            return false;
        }
        let (way, across) = (other.at - self.at, self.facet + other.facet);
        !self.whole.has_facets
            || (self.normal.dot(other.normal) >= SMOOTH_COSINE
                && way.dot(across).abs() <= CHORD_SINE * way.length() * across.length())
    }
}

/// Returns the unit vector of a number of `Quantity::Facet`.
fn direction(number: f64) -> DVec3 {
    let high = (number / 4096.0).floor();
    let p = 2.0 * DVec2::new(high, number - 4096.0 * high) / 4095.0 - 1.0;
    let z = 1.0 - p.x.abs() - p.y.abs();
    let fold = (-z).max(0.0);
    let toward = |x: f64| if x < 0.0 { x + fold } else { x - fold };
    DVec3::new(toward(p.x), toward(p.y), z).normalize_or_zero()
}

/// Returns the number of surfaces that samples meet.
fn surfaces(met: &[Met], wholes: &[Whole]) -> usize {
    let mut found: Vec<Vec<Place>> = Vec::new();
    for met in met {
        let place = Place::new(met, wholes);
        let is_beside = |surface: &[Place]| surface.iter().rev().any(|other| place.is_beside(other));
        let Some(first) = found.iter().position(|surface| is_beside(surface)) else {
            found.push(vec![place]);
            continue;
        };
        // It may lead from one to others.
        for other in (first + 1..found.len()).rev() {
            if is_beside(&found[other]) {
                let others = found.swap_remove(other);
                found[first].extend(others);
            }
        }
        found[first].push(place);
    }
    found.len().min(MAX_SURFACES)
}

#[cfg(test)]
mod tests {
    use super::*;

    const WHOLES: [Whole; 4] = [
        Whole { number: 0, has_facets: false },
        Whole { number: 1, has_facets: true },
        Whole { number: 1, has_facets: true },
        Whole { number: 3, has_facets: false },
    ];
    /// Numbers of the directions +z, +x and of one between them.
    const Z: f64 = 2048.0 * 4097.0;
    const X: f64 = 4095.0 * 4096.0 + 2048.0;
    const BETWEEN: f64 = 3071.0 * 4096.0 + 2048.0;

    fn met(shape: f64, normal: f64, at: [f64; 3]) -> Met {
        Met { facet: [shape, normal, normal].map(|part| part as f32), place: at.map(|part| part as f32) }
    }

    fn count(met: &[Met]) -> usize {
        surfaces(met, &WHOLES)
    }

    #[test]
    fn numbers_are_directions() {
        assert!(direction(Z).distance(DVec3::Z) < 1e-3 && direction(X).distance(DVec3::X) < 1e-3);
        assert!(direction(BETWEEN).distance(DVec3::new(1.0, 0.0, 1.0).normalize()) < 1e-3);
        assert!(direction(0.0).distance(-DVec3::Z) < 1e-3, "a corner is folded over");
    }

    #[test]
    fn one_plane_is_one_surface_whichever_triangles_it_has() {
        let plane = [0.0, 0.1, 0.2].map(|x| met(1.0, Z, [x, 0.3 * x, -5.0]));
        assert_eq!(count(&plane), 1);
        assert_eq!(count(&[plane[0], met(2.0, Z, [0.3, 0.0, -5.0])]), 1);
        assert_eq!(count(&[plane[0], met(3.0, Z, [0.3, 0.0, -5.0]), Met::default()]), 3);
    }

    #[test]
    fn layers_and_edges_of_one_mesh_are_several_surfaces() {
        let at = |depth: f64, x: f64| met(1.0, Z, [x, 0.0, depth]);
        assert_eq!(count(&[at(-5.0, 0.0), at(-5.0, 0.1), at(-6.0, 0.05), at(-6.0, 0.15)]), 2);
        // Two sides of a box, on both sides of its edge.
        let box_of = |normal| [met(1.0, Z, [-0.1, 0.0, 0.0]), met(1.0, normal, [0.0, 0.0, -0.1])];
        assert_eq!(count(&box_of(X)), 2);
    }

    #[test]
    fn places_between_lead_from_one_to_the_other() {
        // Along a cylinder, from where it faces the eye to its outline.
        let turned = |t: f64| {
            let n = DVec3::new(t.sin(), 0.0, t.cos());
            let p = (n.truncate() / (n.x + n.z) * 0.5 + 0.5) * 4095.0;
            met(1.0, p.x.round() * 4096.0 + 2048.0, n.to_array())
        };
        let steps = |n: u32| (0..=n).map(|i| turned(1.5 * f64::from(i) / f64::from(n))).collect::<Vec<_>>();
        assert_eq!(count(&steps(1)), 2);
        assert_eq!(count(&steps(8)), 1);
        let mut both: Vec<Met> = steps(8);
        both.swap(1, 8);
        assert_eq!(count(&both), 1, "the last one leads from one part to the other");
    }

    #[test]
    fn more_surfaces_than_are_told_apart_count_as_the_most() {
        let many: Vec<Met> = (0..20).map(|i| met(1.0, Z, [0.0, 0.01, -f64::from(i)])).collect();
        assert_eq!(count(&many), MAX_SURFACES);
    }
}
