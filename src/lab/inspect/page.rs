//! The page of `moire inspect`: what the view needs, every layer as a picture, and for each texture how densely it is
//! seen, which levels and texels are read, and whether its charts mix. Input: an inspection. Output: HTML beside pictures.

mod layers;
mod textures;

pub use textures::sizes;

use super::folder::Inspection;
use super::legend::Legend;
use crate::lab::plot::html::{Header, Html, code, document, html, section};
use crate::scene::model::Scene;

/// Returns the page. `view`: options that choose what is seen; `legends`: of the layers, in their order.
pub fn html(scene: &Scene, inspection: &Inspection, view: &[String], legends: &[Legend]) -> String {
    let film = &inspection.picture.film;
    let name = scene.path.file_name().map_or("a scene".into(), |name| name.to_string_lossy());
    let facts = format!(
        "{} × {} pixels, on {}, moire {}",
        film.width,
        film.height,
        inspection.picture.device,
        env!("CARGO_PKG_VERSION")
    );
    let path = scene.path.display().to_string();
    let words = [&path].into_iter().chain(view).chain(&inspection.advice.options).map(|word| quoted(word));
    let command = format!("moire render {}", words.collect::<Vec<_>>().join(" "));
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
    let sections = section("layers", "Layers", layers::layers(inspection, legends))
        + section("textures", "Textures", textures::textures(scene, inspection))
        + section("method", "What is exact and what is sampled", method(inspection));
    document(&header, &sections, "")
}

/// Returns a word as shells read it.
fn quoted(word: &str) -> String {
    let is_plain = |c: char| c.is_alphanumeric() || "-_./:=@%+,".contains(c);
    if !word.is_empty() && word.chars().all(is_plain) {
        return word.to_owned();
    }
    format!("'{}'", word.replace('\'', "'\\''"))
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
         nothing of what the rest of the pixel sees. Layers of look-ups show the texture of the colour, or, of a material \
         without one, the first of its maps; the textures' own numbers are of every texture that the material reads there. <b>surfaces</b> is counted, and <b>albedo</b> averaged, \
         over samples. {} They are computed in float64. Texels that are never read are found with up to 16 × 16 points in each \
         footprint; what mirrors and glass show is not followed.</p>\n",
        looked
    )
}

#[cfg(test)]
mod tests {
    use super::quoted;

    #[test]
    fn shells_read_the_word_back() {
        assert_eq!(quoted("a/b-1.glb"), "a/b-1.glb");
        assert_eq!(quoted("my model's.glb"), r"'my model'\''s.glb'");
        assert_eq!([quoted(""), quoted("$x")], ["''", "'$x'"]);
    }
}
