//! The page of `moire inspect`: what the view needs, every layer as a picture, and for each texture how densely it is
//! seen, which levels and texels are read, and whether its charts mix. Input: an inspection. Output: HTML beside pictures.

mod textures;

use super::folder::{EXR, Inspection, PICTURE, file_of};
use crate::lab::plot::html::{Header, Html, code, document, html, section};
use crate::render::layers::Aov;
use crate::scene::model::Scene;

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
        + section("textures", "Textures", textures::textures(scene, inspection))
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
         nothing of what the rest of the pixel sees. Layers of look-ups show the texture of the colour; the textures' own \
         numbers are of every texture that the material reads there. <b>surfaces</b> is counted, and <b>albedo</b> averaged, \
         over samples. {} They are computed in float64. Texels that are never read are found with up to 16 × 16 points in each \
         footprint; what mirrors and glass show is not followed.</p>\n",
        looked
    )
}
