//! The page of `moire inspect`: what the view needs, every layer as a picture, and for each texture how densely it is
//! seen, which levels and texels are read, and whether its charts mix. Input: an inspection. Output: HTML beside pictures.

use super::advice::percent;
use super::charts::Charts;
use super::folder::{EXR, Inspection, PICTURE, file_of};
use super::scale::short;
use super::survey::View;
use crate::lab::plot::html::{Header, Html, code, document, html, section, table};
use crate::render::layers::Aov;
use crate::scene::model::Scene;

/// Shares below which a texture is not said to be too small.
const CLOSE: f64 = 0.05;

/// Returns the page.
pub fn html(scene: &Scene, inspection: &Inspection) -> String {
    let film = &inspection.picture.film;
    let name = scene.path.file_name().map_or("a scene".into(), |name| name.to_string_lossy());
    let facts = format!(
        "{} × {} pixels, on {}, moire {}",
        film.width,
        film.height,
        inspection.picture.device,
        env!("CARGO_PKG_VERSION")
    );
    let command = format!("moire render {} {}", scene.path.display(), inspection.advice.options.join(" "));
    let more = code(&command)
        + html!(
            "<p>These are rules of thumb for what is seen below; <code>moire study</code> measures which setting has the \
             smallest error in a given time.</p>\n"
        );
    let header = Header {
        title: &format!("What {name} sees"),
        facts: &facts,
        lead: &inspection.advice.sentence,
        more,
    };
    let sections = section("layers", "Layers", layers(inspection))
        + section("textures", "Textures", textures(scene, inspection))
        + section("method", "What is exact and what is sampled", method(inspection));
    document(&header, &sections, "")
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

fn figure(file: &str, name: &str, what: &str) -> Html {
    html!(
        "<figure><a href=\"{}\"><img class=\"pixels\" src=\"{}\" alt=\"{}: {}\" loading=\"lazy\"/></a>\
         <figcaption><b>{}</b>: {}</figcaption></figure>\n",
        file,
        file,
        name,
        what,
        name,
        what
    )
}

fn layers(inspection: &Inspection) -> Html {
    let own = figure(PICTURE, "picture", "the scene as it is rendered");
    let others =
        inspection.layers.iter().map(|own| figure(&file_of(own.aov), own.aov.name(), meaning(own.aov)));
    let figures: Html = std::iter::once(own).chain(others).collect();
    let left_out: Html = inspection.left_out.iter().map(|why| html!("<p>Left out: {}.</p>\n", why)).collect();
    html!("<div class=\"grid\">\n{}</div>\n", figures)
        + left_out
        + html!(
            "<p>All numbers are in <a href=\"{}\">{}</a>, a channel each: <code>level.Y</code>, <code>uv.U</code>.</p>\n",
            EXR,
            EXR
        )
}

fn textures(scene: &Scene, inspection: &Inspection) -> Html {
    let survey = &inspection.survey;
    let views = survey.views.iter().zip(&inspection.charts);
    let each: Html = views
        .map(|(view, charts)| {
            let name = scene.textures.get(view.texture).map_or("", |texture| texture.name.as_str());
            let [width, height] = view.size.map(|n| n.to_string());
            html!("<h3>{}: {} × {} texels</h3>\n", name, width, height)
                + texture(view, charts.as_ref(), survey.pixels)
        })
        .collect();
    let without = share_of(survey.untextured, survey.pixels);
    each + html!(
        "<p>Pixels that see no texture of texels: {}, {} of {}.</p>\n",
        survey.untextured.to_string(),
        without,
        survey.pixels.to_string()
    )
}

fn texture(view: &View, charts: Option<&Charts>, pixels: u64) -> Html {
    let seen = view.density.pixels();
    if seen == 0 {
        return html!("<p>No pixel of this view reads it directly; mirrors and bump maps may.</p>\n");
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

/// Returns whether the texture is larger or smaller than the view needs.
fn needs(view: &View) -> String {
    let factor = view.density.spare_factor();
    let size = |factor: f64| {
        let [w, h] = view.size.map(|n| (f64::from(n) / factor).round().max(1.0));
        format!("{w} × {h}")
    };
    let middle = short(view.density.quantile(0.5).unwrap_or(0.0));
    let close = 1.0 - view.density.above(0.5);
    if factor > 1.0 {
        format!(
            "Larger than this view needs: even the closest pixels cover {} texels and more, so {} texels would show the \
             same. Half of the pixels cover more than {middle}.",
            short(factor),
            size(factor)
        )
    } else if factor < 1.0 && close >= CLOSE {
        format!(
            "Smaller than this view needs: in {} of its pixels a texel is larger than two pixels; {} texels would give \
             the closest pixels one each. Half of the pixels cover more than {middle}.",
            percent(close),
            size(factor)
        )
    } else {
        format!("Of the size that this view needs: half of the pixels cover more than {middle} texels.")
    }
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
    let Some(level) = charts.bleeds_from() else {
        return Some(format!("Its {count} charts mix on none of its levels."));
    };
    let shared = charts.shared[(level - charts.first_level) as usize];
    let readers: u64 = view.level_pixels.iter().skip(level as usize).sum();
    let so = if readers > 0 {
        format!(
            "{readers} look-ups of this view read such a level: leave more room between charts, or read no more than \
             {level} levels"
        )
    } else {
        "this view reads none of these levels".to_owned()
    };
    Some(format!(
        "Its {count} charts bleed from level {level} on, where {shared} texels hold two or more; {so}."
    ))
}

fn method(inspection: &Inspection) -> Html {
    let step = inspection.survey.step;
    let looked = if step > 1 {
        format!("The textures' numbers are of every {step}th pixel along both axes.")
    } else {
        "The textures' numbers are of all pixels.".into()
    };
    html!(
        "<p>Layers are those of one ray through the centre of each pixel, in the middle of the shutter's time and through \
         a pinhole, with the footprint of the whole pixel by ray differentials: they are exact for that ray, and say \
         nothing of what the rest of the pixel sees. <b>surfaces</b> is counted, and <b>albedo</b> averaged, over samples. \
         {} They are computed in float64. Texels that are never read are found with up to 16 × 16 points in each \
         footprint; what mirrors and glass show is not followed.</p>\n",
        looked
    )
}
