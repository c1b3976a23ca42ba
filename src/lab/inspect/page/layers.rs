//! The section of layers: each as a picture with its legend, whose text is the page's. Input: an inspection, and the
//! legends. Output: markup.

use crate::lab::inspect::folder::{EXR, Inspection, PICTURE, file_of};
use crate::lab::inspect::legend::{Key, Legend, Swatch};
use crate::lab::inspect::scale::Tick;
use crate::lab::plot::html::{Html, html};
use crate::render::layers::Aov;

/// Entries of a legend that are always seen; the others are folded.
const OPEN: usize = 8;
/// Entries of a legend at most.
const MOST: usize = 4096;
/// Letters under a bar at most; of more, every second value is left out.
const LETTERS: usize = 20;
/// Colours along a bar, between which the browser blends.
const STOPS: u32 = 16;

/// Returns the section's markup.
pub fn layers(inspection: &Inspection, legends: &[Legend]) -> Html {
    let own = figure(PICTURE, "picture", "the scene as it is rendered", Html::default());
    let others =
        inspection.layers.iter().zip(legends).map(|(own, legend)| {
            figure(&file_of(own.aov), own.aov.name(), meaning(own.aov), key(&legend.key))
        });
    let figures: Html = std::iter::once(own).chain(others).collect();
    let left_out: Html = inspection.left_out.iter().map(|why| html!("<p>Left out: {}.</p>\n", why)).collect();
    html!("<div class=\"grid wide\">\n{}</div>\n", figures)
        + left_out
        + html!(
            "<p>All numbers are in <a href=\"{}\">{}</a>, a channel each: <code>level.Y</code>, <code>uv.U</code>.</p>\n",
            EXR,
            EXR
        )
}

/// Returns a sentence on what a layer shows.
fn meaning(aov: Aov) -> &'static str {
    match aov {
        Aov::Texels => "texels that a pixel covers along the longer axis of its footprint",
        Aov::Magnification => "log2 of the pixels that a texel covers: red is magnified, blue minified",
        Aov::Level => "the level that the scene's sampler reads for a whole pixel",
        Aov::Anisotropy => "how many times longer than wide the footprint is",
        Aov::Surfaces => "how many surfaces the samples of a pixel meet; the background is one",
        Aov::Uv => "the place in the texture",
        Aov::Normal => "the shading normal, towards the camera",
        Aov::Depth => "distance along the view direction",
        Aov::Instance => "the shape, by its number",
        Aov::Material => "the material",
        Aov::Samples => "samples of the pixel",
        Aov::Error => "estimated error of the pixel's colour",
        Aov::Albedo => "the material's colour times its texture, without light",
    }
}

fn figure(file: &str, name: &str, what: &str, legend: Html) -> Html {
    html!(
        "<figure><a href=\"{}\"><img class=\"pixels\" src=\"{}\" alt=\"{}: {}\" loading=\"lazy\"/></a>\
         <figcaption>{}<b>{}</b>: {}</figcaption></figure>\n",
        file,
        file,
        name,
        what,
        legend,
        name,
        what
    )
}

fn key(key: &Key) -> Html {
    match key {
        Key::Bar { color, ticks } => bar(*color, ticks),
        Key::Swatches(swatches) => list(swatches),
        Key::None => Html::default(),
    }
}

fn css([r, g, b]: [u8; 3]) -> String {
    format!("#{r:02x}{g:02x}{b:02x}")
}

/// Returns a bar with the values under it.
fn bar(color: fn(f64) -> [u8; 3], ticks: &[Tick]) -> Html {
    let stops = (0..=STOPS).map(|i| css(color(f64::from(i) / f64::from(STOPS))));
    let stops = stops.collect::<Vec<_>>().join(", ");
    let tick = |tick: &Tick| {
        let at = format!("{:.2}", 100.0 * tick.at);
        // Texts at the ends stay within the bar.
        let shift = format!("{:.0}", -100.0 * tick.at);
        html!("<li style=\"left: {}%; transform: translateX({}%)\">{}</li>", at, shift, tick.text)
    };
    let letters: usize = ticks.iter().map(|tick| tick.text.chars().count()).sum();
    let every = if letters > LETTERS { 2 } else { 1 };
    let ticks: Html = ticks.iter().step_by(every).map(tick).collect();
    html!(
        "<div class=\"scale\"><div style=\"background: linear-gradient(to right, {})\"></div><ol>{}</ol></div>\n",
        stops,
        ticks
    )
}

/// Returns the entries, the most frequent first, those beyond the first few folded.
fn list(swatches: &[Swatch]) -> Html {
    let entry =
        |own: &Swatch| html!("<li><span style=\"background: {}\"></span>{}</li>", css(own.color), own.name);
    let entries =
        |own: &[Swatch]| html!("<ul class=\"entries\">{}</ul>\n", own.iter().map(entry).collect::<Html>());
    let (open, folded) = swatches.split_at(swatches.len().min(OPEN));
    if folded.is_empty() {
        return entries(open);
    }
    let (folded, beyond) = folded.split_at(folded.len().min(MOST - OPEN));
    let beyond = match beyond.len() {
        0 => Html::default(),
        n => html!("<p>{} more have less pixels.</p>\n", n.to_string()),
    };
    let count = folded.len().to_string();
    entries(open)
        + html!("<details><summary>{} more</summary>\n{}{}</details>\n", count, entries(folded), beyond)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lab::plot::html::Fragment;

    fn markup(key_of: &Key) -> String {
        key(key_of).markup().into_owned()
    }

    fn swatches(count: usize) -> Key {
        let swatch = |i: usize| Swatch { color: [0, 16, i as u8], name: format!("n{i}.") };
        Key::Swatches((0..count).map(swatch).collect())
    }

    #[test]
    fn every_entry_is_listed_and_many_are_folded() {
        assert!(!markup(&swatches(OPEN)).contains("details"));
        let many = markup(&swatches(100));
        (0..100).for_each(|i| assert!(many.contains(&format!("n{i}.</li>")), "{i}"));
        let folded = many.find("<details>").unwrap();
        assert!(many.find("n7.").unwrap() < folded && folded < many.find("n8.").unwrap(), "{many}");
        assert!(many.contains("92 more") && many.contains("background: #001008"));
    }

    #[test]
    fn the_ends_of_a_bar_have_its_colours_and_values() {
        let ticks = [("1", 0.0), ("2", 0.5), ("4", 1.0)].map(|(text, at)| Tick { at, text: text.into() });
        let found = markup(&Key::Bar { color: |at| [(255.0 * at) as u8, 0, 0], ticks: ticks.into() });
        for part in ["(to right, #000000,", ", #ff0000)", "left: 50.00%; transform: translateX(-50%)\">2<"] {
            assert!(found.contains(part), "{found}");
        }
    }

    #[test]
    fn long_values_leave_room_for_each_other() {
        let ticks = (0..5).map(|i| Tick { at: f64::from(i) / 4.0, text: format!("0.0{i}234") });
        let found = markup(&Key::Bar { color: |_| [0; 3], ticks: ticks.collect() });
        let shown: Vec<bool> = (0..5).map(|i| found.contains(&format!("0.0{i}234"))).collect();
        assert_eq!(shown, [true, false, true, false, true]);
    }
}
