//! What a pixel is made of, by the oracle: the surface at its centre, what that reads of its textures over the pixel's
//! footprint, and where the pixel's samples lie and what they meet. Input: a scene and a pixel. Output: JSON.

use glam::DVec2;
use serde_json::{Value, json};

use super::means::{Means, Part};
use super::texel::{face, in_file, texel};
use super::textures::Textures;
use super::window;
use crate::core::error::Result;
use crate::lab::inspect::uses::name_of;
use crate::oracle::camera::{Ray, camera_at, camera_ray};
use crate::oracle::camera_sample::camera_sample;
use crate::oracle::footprint::{RayDifferential, camera_differential};
use crate::oracle::pixel_filter::Place;
use crate::oracle::quantities::{FirstHit, LookUp, Slot, first_hit};
use crate::pack::{PackedScene, TextureKind, pack};
use crate::render::layers::for_rays;
use crate::scene::model::{Algorithm, Scene};
use crate::schema::layout::NO_SHAPE;

/// Samples of a pixel that are looked at.
const MAX_SAMPLES: u32 = 256;

/// A setting's scene as the oracle reads it.
pub struct Inspector {
    scene: Scene,
    packed: PackedScene,
    /// Means of texels that windows have shown.
    means: Vec<(Part, Means)>,
}

/// A sample of a pixel.
struct Sample<'a> {
    place: Place,
    ray: Ray,
    /// What it meets first.
    first: Option<FirstHit<'a>>,
}

/// Returns what a texture is read for.
fn words_of(slot: Slot) -> &'static str {
    match slot {
        Slot::Color => "Colour",
        Slot::Bump => "Bump or normal map",
        Slot::Roughness => "Roughness and metallic",
        Slot::Emission => "Emission",
        Slot::Occlusion => "Occlusion",
        Slot::SpecularWeight => "Weight of the reflection",
        Slot::SpecularTint => "Tint of the reflection",
        Slot::Transmission => "Transmission",
    }
}

impl Inspector {
    /// Packs the scene with the textures of the page.
    pub fn new(scene: Scene, textures: &Textures) -> Result<Inspector> {
        let (textures, _) = textures.of(&scene)?;
        let packed = pack(&for_rays(&scene), textures, None)?;
        Ok(Inspector { scene, packed, means: Vec::new() })
    }

    /// Returns what a pixel with that number of samples is made of.
    pub fn told(&mut self, place: [u32; 2], count: u32) -> Result<Value> {
        self.scene.sampling.spp = count;
        self.packed.set_sampling(&self.scene);
        let mut means = std::mem::take(&mut self.means);
        let (ray, beam) = self.centre(place);
        let first = first_hit(&self.packed, &ray, &beam, NO_SHAPE);
        let samples = self.samples(place);
        let look_ups = match &first {
            Some(first) => self.look_ups(first, &ray, &samples, &mut means)?,
            None => Vec::new(),
        };
        let (samples, surfaces) = self.met(&samples);
        let told = json!({
            "place": place,
            "surface": first.as_ref().and_then(|first| self.surface(first, &ray)),
            "look_ups": look_ups,
            "samples": samples,
            "surfaces": surfaces,
        });
        self.means = means;
        Ok(told)
    }

    /// Returns the ray through a pixel's centre at the middle of the shutter's time, as wide as the pixel.
    fn centre(&self, place: [u32; 2]) -> (Ray, RayDifferential) {
        let mut header = self.packed.header;
        header.sample_side = 1.0;
        let [opens, open] = [header.shutter_opens, header.shutter_time].map(f64::from);
        let time = opens + 0.5 * open;
        let camera = if header.camera_moves { camera_at(&header, time) } else { header };
        let mut ray = camera_ray(&camera, place, DVec2::splat(0.5));
        ray.time = time;
        if header.camera_moves {
            ray.origin += time * header.eye_motion;
        }
        (ray, camera_differential(&camera, &ray))
    }

    /// Returns the name of a shape, by its number from 0.
    fn shape(&self, number: u32) -> String {
        let kind = self.scene.shapes.kind_of(number as usize);
        kind.map_or("background".into(), |(name, number)| format!("{name} {number}"))
    }

    /// Returns the name of a material; that behind the last one is the environment.
    fn material(&self, number: u32) -> String {
        let number = number as usize;
        if number < self.scene.materials.len() { name_of(&self.scene, number) } else { "environment".into() }
    }

    fn surface(&self, first: &FirstHit<'_>, ray: &Ray) -> Option<Value> {
        let hit = first.hit?;
        let surface = &first.surface;
        let eye = self.scene.camera.eye;
        Some(json!({
            "shape": self.shape(hit.shape),
            "material": self.material(surface.material),
            "model": self.scene.materials.get(surface.material as usize).map(|own| own.model.name()),
            "point": (surface.point + eye).to_array(),
            "normal": surface.normal.to_array(),
            "depth": hit.t,
            "distance": hit.t * ray.direction.length(),
            "uv": surface.own_uv.to_array(),
        }))
    }

    fn look_ups(
        &self,
        first: &FirstHit<'_>,
        ray: &Ray,
        samples: &[Sample<'_>],
        means: &mut Vec<(Part, Means)>,
    ) -> Result<Vec<Value>> {
        let mut told = Vec::new();
        for slot in Slot::ALL {
            let Some(([texture, _], mapped)) = first.mapped(slot, &self.packed, ray) else { continue };
            let image = &self.packed.records.textures[texture as usize];
            let name = self.packed.texture_names.get(texture as usize);
            let use_of = words_of(slot);
            if image.kind == TextureKind::Procedural {
                let at = |own: &Sample<'_>| {
                    let ([read, _], mapped) = own.first.as_ref()?.mapped(slot, &self.packed, &own.ray)?;
                    (read == texture).then(|| mapped.at.truncate())
                };
                let at = samples.iter().filter_map(at).collect();
                let procedural = &self.packed.records.procedurals[image.procedural as usize];
                told.push(json!({
                    "use": use_of,
                    "texture": name,
                    "uv": mapped.at.to_array(),
                    "change": mapped.change.map(|change| change.to_array()),
                    "window": window::of_procedural(procedural, mapped.at, mapped.change, at)?,
                }));
            } else if let Some(look_up) = first.look_up(slot, &self.packed, ray) {
                let at = |own: &Sample<'_>| {
                    let read = own.first.as_ref()?.look_up(slot, &self.packed, &own.ray)?;
                    let is_same = (read.texture, read.face) == (look_up.texture, look_up.face);
                    is_same.then(|| read.coordinate.at.truncate())
                };
                let at: Vec<DVec2> = samples.iter().filter_map(at).collect();
                let window = window::of_texels(&self.packed, &look_up, &at, means)?;
                told.push(self.look_up(&look_up, use_of, name, window));
            }
        }
        Ok(told)
    }

    fn look_up(
        &self,
        look_up: &LookUp<'_>,
        use_of: &str,
        name: Option<&String>,
        window: Option<Value>,
    ) -> Value {
        let LookUp { image, how, coordinate, spread, .. } = look_up;
        let size = [image.size.x, image.size.y];
        let place = look_up.place();
        let texel = texel(look_up);
        let source = self.scene.textures.get(look_up.texture as usize);
        let in_file = source.zip(texel.as_deref()).and_then(|(source, texel)| in_file(source, texel, size));
        let [major, minor] = [spread.major, spread.minor].map(f64::sqrt);
        json!({
            "use": use_of,
            "texture": name,
            "size": size,
            "depth": (image.kind == TextureKind::Volume).then_some(image.size.z),
            "levels": image.levels,
            "uv": coordinate.at.to_array(),
            "change": coordinate.change.map(|change| change.to_array()),
            "place": place.to_array(),
            "texel": texel,
            "face": face(look_up),
            "in_file": in_file,
            "texels": [major, minor],
            "level": look_up.level(),
            "magnified": major <= 1.0,
            "filter": (if major <= 1.0 { how.mag_filter } else { how.min_filter }).name(),
            "mip": how.mip_mode.name(),
            "address": [how.address_u.name(), how.address_v.name()],
            "window": window,
        })
    }

    /// Returns the samples of a pixel, some of them if there are many.
    fn samples(&self, place: [u32; 2]) -> Vec<Sample<'_>> {
        let packed = &self.packed;
        if self.scene.sampling.algorithm == Algorithm::Cone {
            return Vec::new();
        }
        let sample = |s: u32| {
            let (path, place) = camera_sample(packed, &packed.header, place, 0, s);
            let beam = camera_differential(&packed.header, &path.ray);
            let first = first_hit(packed, &path.ray, &beam, NO_SHAPE);
            Sample { place, ray: path.ray, first }
        };
        (0..packed.samples.min(MAX_SAMPLES)).map(sample).collect()
    }

    /// Returns the places of samples, each with the number of what it meets first, and those surfaces.
    fn met(&self, samples: &[Sample<'_>]) -> (Vec<Value>, Vec<Value>) {
        let mut met: Vec<([u32; 2], u32)> = Vec::new();
        let mut places = Vec::new();
        for Sample { place: at, first, .. } in samples {
            let surface = first.as_ref().and_then(|first| Some((first.hit?.shape, first.surface.material)));
            let (shape, material) = surface.unwrap_or((NO_SHAPE, u32::MAX));
            let what = [shape, material];
            let number = met.iter().position(|(own, _)| *own == what).unwrap_or_else(|| {
                met.push((what, 0));
                met.len() - 1
            });
            met[number].1 += 1;
            places.push(json!([at.inside.x, at.inside.y, number, at.sign]));
        }
        let surface = |&([shape, material], samples): &([u32; 2], u32)| {
            let hits = shape != NO_SHAPE;
            json!({
                "shape": if hits { self.shape(shape) } else { "background".into() },
                "material": hits.then(|| self.material(material)),
                "samples": samples,
            })
        };
        (places, met.iter().map(surface).collect())
    }
}
