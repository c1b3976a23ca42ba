//! The edge of a spot light: within equal angles its light is whole, beyond them there is none.

use std::path::Path;

use moire::internal::scene::parse;

use crate::stage::{packed, render, render_on_oracle};

/// A pixel covers less than 0.02° about the edge of 15°, which all pixels but one are off.
#[test]
fn a_spot_of_equal_angles_ends_at_them() {
    let edge = 15f64.to_radians().tan();
    let text = format!(
        "[camera]\neye = [{edge:?}, 0, 5]\nlook_at = [{edge:?}, 0, 0]\northographic_height = 0.0002\n\
         [image]\nwidth = 21\nheight = 1\n[sampling]\npattern = 'center'\n\
         [[light]]\nkind = 'spot'\nposition = [0, 0, 1]\ndirection = [0, 0, -1]\nintensity = [3.14159265, 3.14159265, 3.14159265]\n\
         inner = 15.0\nouter = 15.0\n[[material]]\nname = 'm'\nmodel = 'lambert'\n\
         [[plane]]\norigin = [0, 0, 0]\ntangent = [1, 0, 0]\nbitangent = [0, 1, 0]\nmaterial = 'm'\n"
    );
    let scene = packed(parse(Path::new("spot.toml"), &text).unwrap(), None);
    // I cos θ / r² over π, with r = 1 / cos θ.
    let whole = |pixel: usize| (1.0 + (edge + 0.0002 * (pixel as f64 - 10.0)).powi(2)).powf(-1.5);
    for film in [render(&scene), render_on_oracle(&scene)] {
        let seen: Vec<f64> = film.pixels.iter().map(|pixel| f64::from(pixel[0])).collect();
        assert!((0..10).all(|pixel| (seen[pixel] - whole(pixel)).abs() < 1e-4), "{seen:?}");
        assert!(seen[11..].iter().all(|light| *light == 0.0), "{seen:?}");
    }
}
