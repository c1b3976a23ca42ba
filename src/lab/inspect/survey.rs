//! What the view reads of each image, by the oracle: one ray through the centre of each pixel, with the footprint of the
//! whole pixel, and every texture that the material there reads. Input: a scene, and the same packed. Output: for each
//! image of texels what it is read for, its density, the levels that are read, and the texels that no footprint covers.
//! In large pictures every n-th pixel of every n-th row is looked at.

use std::collections::BTreeMap;

use glam::DVec2;
use rayon::prelude::*;

use super::density::Density;
use super::marks::{Mark, Marks, NeverRead};
use super::uses::{Use, uses};
use crate::oracle::camera::camera_ray;
use crate::oracle::footprint::camera_differential;
use crate::oracle::quantities::{LookUp, Slot, first_hit};
use crate::pack::{PackedScene, TextureKind};
use crate::scene::model::{Scene, TextureSource};
use crate::schema::layout::{NO_SHAPE, Texture};
use crate::texture::data::{ColorSpace, MipKernel};
use crate::texture::sampler_spec::MipMode;

/// Pixels that are looked at, at most.
const MAX_PIXELS: u64 = 1 << 20;
/// Footprints longer than this many widths count as elongated.
pub const ELONGATED: f64 = 2.0;
/// Texels that cover more than so many pixels show their outline under `linear`.
pub const LARGE_TEXEL: f64 = 2.0;

/// How an image is seen. A pixel counts once, by its longest footprint, even if its material reads the image more often; what
/// size the image needs is told by the shortest.
#[derive(Clone, Debug)]
pub struct View {
    /// Indices of its textures: an image that is read as colours and as numbers is two of them.
    pub textures: Vec<usize>,
    pub size: [u32; 2],
    pub levels: u32,
    /// By all materials, in their order.
    pub uses: Vec<Use>,
    pub density: Density,
    /// The same by the shortest footprint of each pixel: the use for which the image has to be largest.
    pub closest: Density,
    /// Pixels whose footprint covers more than a texel, and those of them that are elongated.
    pub minified: u64,
    pub elongated: u64,
    /// Pixels that read each level; those between two levels read both.
    pub level_pixels: Vec<u64>,
    /// Of level 0; none for volumes.
    pub never_read: Option<NeverRead>,
}

/// How many pixels see textures, and how; images of one texel count as colours.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Seen {
    /// They read an image at least.
    pub textured: u64,
    /// Of these: they cover more than a texel of one.
    pub minified: u64,
    /// Of those: with a footprint more than twice as long as wide.
    pub elongated: u64,
    /// Of the textured ones: a texel is larger than two pixels.
    pub magnified: u64,
}

/// How all images are seen.
#[derive(Clone, Debug)]
pub struct Survey {
    pub views: Vec<View>,
    pub seen: Seen,
    /// Pixels that were looked at.
    pub pixels: u64,
    /// Pixels that read no image.
    pub untextured: u64,
    /// Every so many pixels along both axes.
    pub step: u32,
}

/// What one pixel reads of one image.
struct Reading {
    /// Index of the image's first texture.
    image: usize,
    material: u32,
    /// A bit for each slot.
    slots: u8,
    major: f64,
    /// The least `major` of all that the pixel reads.
    least: f64,
    is_elongated: bool,
    /// A bit for each level.
    levels: u32,
}

/// What the pixels of a row see.
#[derive(Default)]
struct Row {
    readings: Vec<Reading>,
    seen: Seen,
    untextured: u64,
}

/// Looks at the pixels of a scene; `packed` for rays through their centres.
pub fn survey(scene: &Scene, packed: &PackedScene) -> Survey {
    let [width, height] = packed.header.film_size.to_array();
    let all = u64::from(width) * u64::from(height);
    let step = (all as f64 / MAX_PIXELS as f64).sqrt().ceil().max(1.0) as u32;
    let rows: Vec<u32> = (0..height).step_by(step as usize).collect();
    let columns: Vec<u32> = (0..width).step_by(step as usize).collect();
    let images = images(&scene.textures, packed.records.textures.len());
    let marks: Vec<Option<Marks>> = packed
        .records
        .textures
        .iter()
        .enumerate()
        .map(|(i, texture)| (images[i] == i).then(|| marks(texture)).flatten())
        .collect();
    let looking = Looking { packed, images: &images, marks: &marks };
    let row = |&y: &u32| {
        let mut row = Row::default();
        columns.iter().for_each(|&x| looking.look([x, y], &mut row));
        row
    };
    let rows: Vec<Row> = rows.par_iter().map(row).collect();
    let sum = |of: fn(&Row) -> u64| rows.iter().map(of).sum();
    let seen = Seen {
        textured: sum(|row| row.seen.textured),
        minified: sum(|row| row.seen.minified),
        elongated: sum(|row| row.seen.elongated),
        magnified: sum(|row| row.seen.magnified),
    };
    let (pixels, untextured) = ((rows.len() * columns.len()) as u64, sum(|row| row.untextured));
    let mut of: Vec<Vec<Reading>> = images.iter().map(|_| Vec::new()).collect();
    for reading in rows.into_iter().flat_map(|row| row.readings) {
        of[reading.image].push(reading);
    }
    let has_texels =
        |&i: &usize| images[i] == i && packed.records.textures[i].kind != TextureKind::Procedural;
    let view_of = |i: usize| {
        let textures: Vec<usize> = (i..images.len()).filter(|&other| images[other] == i).collect();
        View {
            uses: uses(scene, &textures, &pixels_of_slots(&of[i])),
            textures,
            never_read: marks[i].as_ref().map(Marks::never_read),
            ..view(&packed.records.textures[i], &of[i])
        }
    };
    let views = (0..images.len()).filter(has_texels).map(view_of).collect();
    Survey { views, seen, pixels, untextured, step }
}

/// Returns for each texture the first one of the same image, whatever its texels mean.
fn images(textures: &[TextureSource], count: usize) -> Vec<usize> {
    let image = |texture: &TextureSource| TextureSource {
        color_space: ColorSpace::Linear,
        color_space_stated: true,
        mip_kernel: MipKernel::Box,
        ..texture.identity()
    };
    let identities: Vec<TextureSource> = textures.iter().map(image).collect();
    let first = |i: usize| {
        let own = identities.get(i)?;
        identities.iter().position(|other| other == own)
    };
    (0..count).map(|i| first(i).unwrap_or(i)).collect()
}

fn marks(texture: &Texture) -> Option<Marks> {
    let faces = if texture.kind == TextureKind::Cube { 6 } else { 1 };
    let is_flat = !matches!(texture.kind, TextureKind::Volume | TextureKind::Procedural);
    is_flat.then(|| Marks::new([texture.size.x, texture.size.y], faces))
}

/// What looks at pixels.
struct Looking<'a> {
    packed: &'a PackedScene,
    images: &'a [usize],
    marks: &'a [Option<Marks>],
}

impl Looking<'_> {
    /// Adds what a pixel reads.
    fn look(&self, [x, y]: [u32; 2], row: &mut Row) {
        let header = &self.packed.header;
        let place = [x + header.crop.x, y + header.crop.y];
        let ray = camera_ray(header, place, DVec2::splat(0.5));
        let first = first_hit(self.packed, &ray, &camera_differential(header, &ray), NO_SHAPE);
        let before = row.readings.len();
        let mut seen = Seen::default();
        let look_ups = first.iter().flat_map(|first| {
            let look_up = |slot: Slot| Some((slot, first.look_up(slot, self.packed, &ray)?));
            Slot::ALL.into_iter().filter_map(look_up).map(|own| (own, first.surface.material))
        });
        for ((slot, look_up), material) in look_ups {
            let image = self.images[look_up.texture as usize];
            if let Some(marks) = &self.marks[image] {
                marks.add(&mark_of(&look_up));
            }
            let reading = Reading { image, material, ..reading(slot, &look_up) };
            if look_up.image.size.x.max(look_up.image.size.y) > 1 {
                seen.minified |= u64::from(reading.major > 1.0);
                seen.elongated |= u64::from(reading.major > 1.0 && reading.is_elongated);
                seen.magnified |= u64::from(reading.major * LARGE_TEXEL <= 1.0);
            }
            match row.readings[before..].iter_mut().find(|other| other.image == image) {
                Some(other) => other.join(&reading),
                None => row.readings.push(reading),
            }
        }
        let is_textured = row.readings.len() > before;
        row.untextured += u64::from(!is_textured);
        row.seen.textured += u64::from(is_textured);
        row.seen.minified += seen.minified;
        row.seen.elongated += seen.elongated;
        row.seen.magnified += seen.magnified;
    }
}

fn mark_of(look_up: &LookUp<'_>) -> Mark {
    Mark {
        at: look_up.coordinate.at.truncate(),
        change: look_up.coordinate.change.map(|d| d.truncate()),
        address: [look_up.how.address_u, look_up.how.address_v],
        face: look_up.face,
    }
}

fn reading(slot: Slot, look_up: &LookUp<'_>) -> Reading {
    let [major, minor] = [look_up.spread.major, look_up.spread.minor].map(f64::sqrt);
    let level = look_up.level();
    let low = (level.floor() as u32).min(look_up.image.levels.saturating_sub(1));
    let blends = look_up.how.mip_mode == MipMode::Linear && level.fract() > 0.0;
    let high = if blends && low + 1 < look_up.image.levels { low + 1 } else { low };
    Reading {
        image: 0,
        material: 0,
        slots: 1 << slot as u8,
        major,
        least: major,
        is_elongated: major > ELONGATED * minor,
        levels: 1 << low | 1 << high,
    }
}

impl Reading {
    fn join(&mut self, other: &Reading) {
        self.slots |= other.slots;
        self.levels |= other.levels;
        self.least = self.least.min(other.least);
        if other.major > self.major {
            (self.major, self.is_elongated) = (other.major, other.is_elongated);
        }
    }
}

/// Returns the pixels that read an image for each slot of each material.
fn pixels_of_slots(readings: &[Reading]) -> BTreeMap<(usize, Slot), u64> {
    let mut pixels = BTreeMap::new();
    for own in readings {
        for slot in Slot::ALL.into_iter().filter(|&slot| own.slots >> slot as u8 & 1 != 0) {
            *pixels.entry((own.material as usize, slot)).or_default() += 1;
        }
    }
    pixels
}

fn view(image: &Texture, readings: &[Reading]) -> View {
    let minified = || readings.iter().filter(|own| own.major > 1.0);
    let reads = |level: u32| readings.iter().filter(|own| own.levels >> level & 1 != 0).count() as u64;
    View {
        textures: Vec::new(),
        size: [image.size.x, image.size.y],
        levels: image.levels,
        uses: Vec::new(),
        density: Density::new(readings.iter().map(|own| own.major).collect()),
        closest: Density::new(readings.iter().map(|own| own.least).collect()),
        minified: minified().count() as u64,
        elongated: minified().filter(|own| own.is_elongated).count() as u64,
        level_pixels: (0..image.levels).map(reads).collect(),
        never_read: None,
    }
}
