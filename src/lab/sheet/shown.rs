//! What a sheet shows of a film: a part, developed as its cell asks, averaged if it is wide, and the difference from the
//! reference. Input: linear films. Output: colours of sRGB without a bound, which the sheet is written with.

use super::plan::Plan;
use super::reference::Reference;
use crate::core::film::Film;
use crate::lab::study::pictures::{self, Window};
use crate::output::DisplayTransform;

/// What is shown of a picture.
pub struct Shown {
    /// The part, in the pixels of the picture or averaged over squares.
    pub film: Film,
    /// |picture − reference|, the mean of three channels.
    pub difference: Option<Vec<f32>>,
}

/// Returns what is seen of a film with a display; the difference is that of what is seen.
pub(super) fn shown(
    plan: &Plan,
    display: &DisplayTransform,
    film: &Film,
    reference: Option<&Reference>,
) -> Shown {
    let view = &plan.view;
    let part = view.part([film.width, film.height]);
    let window = Window { x: part.x, y: part.y, width: part.width, height: part.height };
    let step = view.reduced([film.width, film.height]);
    let seen = |film: &Film| display.developed(&pictures::crop(film, window));
    let own = seen(film);
    let difference = |reference: &Reference| {
        let values = pictures::differences(&own, &seen(&reference.film));
        let pixels = values.into_iter().map(|v| [v; 3]).collect();
        let whole = Film { width: window.width, height: window.height, pixels, samples: 0 };
        pictures::averaged(&whole, step).pixels.into_iter().map(|pixel| pixel[0]).collect()
    };
    let difference = reference.filter(|_| view.difference).map(difference);
    Shown { film: within(pictures::averaged(&own, step), plan, display), difference }
}

/// Cuts colours off that the picture's own primaries do not have, where those of the sheet do.
pub(super) fn within(mut film: Film, plan: &Plan, display: &DisplayTransform) -> Film {
    if display.gamut != plan.gamut() {
        film.pixels.iter_mut().flatten().for_each(|value| *value = value.clamp(0.0, 1.0));
    }
    film
}
