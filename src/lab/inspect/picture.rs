//! A layer as a false-colour picture with its legend. Input: the layer, and the names of materials. Output: a film whose
//! colours are meant to be looked at.

use super::colors::{NOTHING, category, diverging, light, viridis};
use super::legend::{Key, Legend, Swatch, with_legend};
use super::scale::{Kind, Scale};
use crate::core::film::Film;
use crate::core::layer::Layer;
use crate::render::layers::{Aov, MAX_SURFACES};

/// Returns the picture of a layer with its legend under it. `names`: of the materials, for the legend of `material`.
pub fn picture(aov: Aov, layer: &Layer, size: [u32; 2], names: &[String]) -> Film {
    let (film, legend) = colored(aov, layer, size, names);
    with_legend(&film, &legend)
}

/// Returns the picture of a layer, and its legend apart.
pub fn colored(aov: Aov, layer: &Layer, [width, height]: [u32; 2], names: &[String]) -> (Film, Legend) {
    let looks = Looks::new(aov, layer, names);
    let mut film = Film::new(width, height, 1);
    for (i, pixel) in film.pixels.iter_mut().enumerate() {
        let present = layer.present.get(i).copied().unwrap_or(false);
        let value = |c: usize| layer.channels.get(c).map_or(0.0, |channel| channel.values[i]);
        *pixel = if present { (looks.color)([value(0), value(1), value(2)]) } else { light(NOTHING) };
    }
    (film, looks.legend)
}

/// The colours of a layer.
struct Looks {
    /// Linear light by the values of the channels.
    color: Box<dyn Fn([f32; 3]) -> [f32; 3]>,
    legend: Legend,
}

impl Looks {
    fn new(aov: Aov, layer: &Layer, names: &[String]) -> Looks {
        let values = || layer.first_values();
        let by = |kind| Scale::new(kind, values());
        match aov {
            Aov::Texels => Looks::bar("texels a pixel covers, longer axis", by(Kind::Octaves), viridis),
            Aov::Magnification => {
                Looks::bar("log2 of pixels a texel, above 0 magnified", by(Kind::Signed), diverging)
            }
            Aov::Level => {
                let last = values().fold(1.0, f32::max).ceil();
                Looks::bar("level that is read", Scale::between(0.0, last.into()), viridis)
            }
            Aov::Anisotropy => Looks::bar("longer axis / shorter axis", by(Kind::Octaves), viridis),
            Aov::Surfaces => {
                let most = values().fold(2.0, f32::max).min(MAX_SURFACES as f32);
                Looks::bar("surfaces a pixel sees", Scale::between(1.0, most.into()), viridis)
            }
            Aov::Samples => Looks::bar("samples of a pixel", by(Kind::Octaves), viridis),
            Aov::Error => Looks::bar("estimated error", by(Kind::Linear), viridis),
            Aov::Depth => Looks::bar("distance along the view direction", by(Kind::Octaves), viridis),
            Aov::Uv => Looks::text("place in the texture: red u, green v", |[u, v, _]| {
                light([u, v, 0.0].map(|x| (255.0 * x.clamp(0.0, 1.0)).round() as u8))
            }),
            Aov::Normal => Looks::text("normal: red x, green y, blue z", |n| {
                light(n.map(|x| (127.5 * (x + 1.0)).clamp(0.0, 255.0).round() as u8))
            }),
            Aov::Albedo => Looks::text("colour of material and texture", |color| color),
            Aov::Instance => Looks::numbers("shape", layer, &[]),
            Aov::Material => Looks::numbers("material", layer, names),
        }
    }

    fn bar(title: &str, scale: Scale, map: fn(f64) -> [u8; 3]) -> Looks {
        Looks {
            color: Box::new(move |[value, ..]| light(map(scale.place(value.into())))),
            legend: Legend { title: title.into(), key: Key::Bar { color: map, ticks: scale.ticks() } },
        }
    }

    fn text(title: &str, color: fn([f32; 3]) -> [f32; 3]) -> Looks {
        Looks { color: Box::new(color), legend: Legend { title: title.into(), key: Key::None } }
    }

    /// Returns a colour for each number, the most frequent first in the legend.
    fn numbers(what: &str, layer: &Layer, names: &[String]) -> Looks {
        let mut counts = std::collections::BTreeMap::<u32, usize>::new();
        layer.first_values().for_each(|value| *counts.entry(value as u32).or_default() += 1);
        let mut numbers: Vec<(u32, usize)> = counts.into_iter().collect();
        numbers.sort_by_key(|&(number, count)| (std::cmp::Reverse(count), number));
        let title = format!("{what}: {} seen", numbers.len());
        let swatch = |&(number, _): &(u32, usize)| Swatch {
            color: category(number),
            name: (number as usize)
                .checked_sub(1)
                .and_then(|i| names.get(i))
                .map_or(number.to_string(), Clone::clone),
        };
        Looks {
            color: Box::new(|[value, ..]| light(category(value as u32))),
            legend: Legend { title, key: Key::Swatches(numbers.iter().map(swatch).collect()) },
        }
    }
}
