//! The section of textures: what each image is read for, how densely it is seen, which levels and texels are read, and
//! whether its charts mix. Input: a scene, and the inspection. Output: markup.

use crate::core::counted::{counted, verb};
use crate::lab::inspect::advice::percent;
use crate::lab::inspect::charts::{Bleeding, Charts};
use crate::lab::inspect::density::CLOSEST;
use crate::lab::inspect::folder::Inspection;
use crate::lab::inspect::scale::short;
use crate::lab::inspect::survey::{LARGE_TEXEL, View};
use crate::lab::plot::html::{Html, html, table};
use crate::scene::model::Scene;

/// Returns the section's markup.
pub fn textures(scene: &Scene, inspection: &Inspection) -> Html {
    let survey = &inspection.survey;
    let views = survey.views.iter().zip(&inspection.charts);
    let each: Html = views
        .map(|(view, charts)| {
            let named = view.textures.first().and_then(|&texture| scene.textures.get(texture));
            let name = named.map_or("", |texture| texture.name.as_str());
            let [width, height] = view.size.map(|n| n.to_string());
            html!("<h3>{}: {} × {} texels</h3>\n", name, width, height)
                + uses(scene, view)
                + texture(view, charts.as_ref(), survey.pixels)
        })
        .collect();
    let without = share_of(survey.untextured, survey.pixels);
    each + html!(
        "<p>Pixels that read no texture of texels: {}, {} of {}.</p>\n",
        survey.untextured.to_string(),
        without,
        survey.pixels.to_string()
    )
}

fn texture(view: &View, charts: Option<&Charts>, pixels: u64) -> Html {
    let seen = view.density.pixels();
    if seen == 0 {
        return html!(
            "<p>No pixel of this view reads it: what it is on is hidden, outside the picture, or seen in mirrors and \
             through glass alone.</p>\n"
        );
    }
    let said = [Some(needs(view)), never_read(view), charts.and_then(|charts| bleeding(charts, view))];
    let said: Html = said.into_iter().flatten().map(|sentence| html!("<p>{}</p>\n", sentence)).collect();
    let range = |octave: i32| {
        let [from, to] = [octave, octave + 1].map(|power| short(f64::from(power).exp2()));
        format!("{from} to {to}")
    };
    let bins = view.density.histogram();
    let bins = bins.iter().map(|bin| row(&range(bin.octave), bin.pixels, seen));
    let levels = view.level_pixels.iter().enumerate().filter(|(_, n)| **n > 0);
    let levels = levels.map(|(level, &n)| row(&level.to_string(), n, seen));
    html!("<p>Seen by {} pixels, {} of all.</p>\n", seen.to_string(), share_of(seen, pixels))
        + said
        + table(
            "Texels for each pixel, along the longer axis",
            &["texels", "pixels", "share", ""],
            &bins.collect::<Vec<_>>(),
        )
        + table(
            "Levels that are read; a pixel between two levels reads both",
            &["level", "pixels", "share", ""],
            &levels.collect::<Vec<_>>(),
        )
}

/// Returns a row of a histogram, with a bar.
fn row(name: &str, count: u64, all: u64) -> Vec<Html> {
    let width = format!("{:.1}", 100.0 * count as f64 / all.max(1) as f64);
    vec![
        html!("{}", name),
        html!("{}", count.to_string()),
        html!("{}", share_of(count, all)),
        html!("<span class=\"count\" style=\"width: {}%\"></span>", width),
    ]
}

fn share_of(part: u64, all: u64) -> String {
    percent(part as f64 / all.max(1) as f64)
}

/// Returns for each texture that pixels read its size, and whether that is larger or smaller than the view needs.
pub fn sizes(scene: &Scene, inspection: &Inspection) -> Vec<String> {
    let views = inspection.survey.views.iter().filter(|view| view.density.pixels() > 0);
    let told = |view: &View| {
        let texture = view.textures.first().and_then(|&texture| scene.textures.get(texture))?;
        let [width, height] = view.size;
        Some(format!("texture \"{}\", {width} × {height} texels: {}", texture.name, size_needed(view)))
    };
    views.filter_map(told).collect()
}

/// Returns whether the texture is larger or smaller than the view needs.
fn size_needed(view: &View) -> String {
    // Whatever else a pixel reads there: the use that magnifies most has to have enough texels.
    let density = &view.closest;
    let wanted = density.wanted(view.size);
    let [width, height] =
        view.size.map(|n| (f64::from(n) * f64::from(wanted.octaves).exp2()).round().max(1.0));
    let size = format!("{width} × {height}");
    let most = percent(1.0 - CLOSEST);
    if wanted.octaves < 0 {
        format!(
            "Larger than this view needs: {most} of its pixels cover {} texels and more, so {size} texels are enough for \
             them.",
            short(f64::from(-wanted.octaves).exp2())
        )
    } else if large(view) < CLOSEST {
        "Of the size that this view needs.".to_owned()
    } else if !wanted.is_capped {
        format!(
            "Smaller than this view needs: of {size} texels {most} of its pixels would cover one or more."
        )
    } else {
        let still = percent(density.below(f64::from(-wanted.octaves).exp2()));
        let beyond = match wanted.octaves {
            0 => "Of the size that most of its pixels need: a larger one would serve few".to_owned(),
            _ => format!(
                "Smaller than this view needs: {size} texels suit it, which are magnified in {still} of its pixels; more \
                 would serve few"
            ),
        };
        format!("{beyond}, so give the parts that are magnified more room in it.")
    }
}

/// Returns the share of the pixels that see texels larger than two pixels.
fn large(view: &View) -> f64 {
    1.0 - view.closest.above(1.0 / LARGE_TEXEL)
}

/// Returns what the texture's size is to the view, and in how many pixels it is magnified and minified.
fn needs(view: &View) -> String {
    format!(
        "{} It is magnified in {} of its pixels, with texels larger than two pixels in {}, and minified in {}. Half of its \
         pixels cover {} texels or more.",
        size_needed(view),
        percent(view.closest.below(1.0)),
        percent(large(view)),
        percent(view.density.above(1.0)),
        short(view.closest.quantile(0.5).unwrap_or(0.0))
    )
}

fn never_read(view: &View) -> Option<String> {
    let never = view.never_read?;
    let cells = match never.side {
        1 => "texels".to_owned(),
        side => format!("blocks of {side} × {side} texels"),
    };
    Some(format!(
        "Never read: {} of {} {cells} ({}) are under no pixel's footprint.",
        never.cells,
        never.all,
        share_of(never.cells, never.all)
    ))
}

/// Returns whether charts mix on the levels that are read.
fn bleeding(charts: &Charts, view: &View) -> Option<String> {
    let count = charts.count;
    if count < 2 {
        return None;
    }
    if charts.overlap {
        return Some(format!("Its {count} charts lie over each other, so they share texels at every level."));
    }
    let Some(Bleeding { level, texels }) = charts.bleeding else {
        return Some(format!("Its {count} charts mix on none of its levels."));
    };
    let readers: u64 = view.level_pixels.iter().skip(level as usize).sum();
    let so = if readers > 0 {
        format!(
            "{} of this view {} such a level: leave more room between charts, or read no more than {}",
            counted(readers, "look-up"),
            verb(readers, "reads", "read"),
            counted(level.max(1), "level")
        )
    } else {
        "this view reads none of these levels".to_owned()
    };
    Some(format!(
        "Its {count} charts bleed from level {level} on, where the linear filter reads {} of another chart; {so}.",
        counted(texels, "texel")
    ))
}

/// Materials that a sentence names; more are folded.
const FEW: usize = 4;

/// Returns what an image is read for, and by which materials.
fn uses(scene: &Scene, view: &View) -> Html {
    let all: Vec<String> = view.uses.iter().map(|own| own.words(scene)).collect();
    let (few, more) = all.split_at(all.len().min(FEW));
    let read = html!("<p>Read for {}", few.join(", "));
    if more.is_empty() {
        return read + html!(".</p>\n");
    }
    let entries: Html = more.iter().map(|own| html!("<li>{}</li>", own)).collect();
    let count = more.len().to_string();
    read + html!(
        " and more.</p>\n<details><summary>{} more</summary>\n<ul>{}</ul></details>\n",
        count,
        entries
    )
}
