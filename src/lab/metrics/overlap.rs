//! The region in which two pictures are compared: the intersection of the films' placements. Films
//! of pictures of different size are compared pixel by pixel if they have the same size.

use crate::core::error::{Error, Result};
use crate::core::film::{Film, Placement};

/// Two films of one size, with their placement in the picture of which both are parts.
pub struct Common {
    pub a: Film,
    pub b: Film,
    pub placement: Placement,
}

pub fn common((a, at): (Film, Placement), (b, bt): (Film, Placement)) -> Result<Common> {
    if at.full != bt.full {
        // The sizes are compared later, as for any two films.
        let placement = Placement::whole(a.width, a.height);
        return Ok(Common { a, b, placement });
    }
    let ends = |film: &Film, p: Placement| [p.corner[0] + film.width, p.corner[1] + film.height];
    let (end_a, end_b) = (ends(&a, at), ends(&b, bt));
    let corner = [0, 1].map(|i| at.corner[i].max(bt.corner[i]));
    let end = [0, 1].map(|i| end_a[i].min(end_b[i]));
    if corner[0] >= end[0] || corner[1] >= end[1] {
        return Err(Error::with_help(
            format!(
                "the pictures have no pixel in common: {} and {} of {}×{} pixels",
                shown(&a, at),
                shown(&b, bt),
                at.full[0],
                at.full[1]
            ),
            "compare parts that overlap",
        ));
    }
    let size = [end[0] - corner[0], end[1] - corner[1]];
    let part = |film: Film, p: Placement| cut(film, [corner[0] - p.corner[0], corner[1] - p.corner[1]], size);
    Ok(Common { a: part(a, at), b: part(b, bt), placement: Placement { corner, full: at.full } })
}

fn shown(film: &Film, p: Placement) -> String {
    format!("{}×{} at ({}, {})", film.width, film.height, p.corner[0], p.corner[1])
}

fn cut(film: Film, [x, y]: [u32; 2], [width, height]: [u32; 2]) -> Film {
    if (film.width, film.height) == (width, height) {
        return film;
    }
    let rows = film.pixels.chunks_exact(film.width as usize).skip(y as usize).take(height as usize);
    let pixels = rows.flat_map(|row| &row[x as usize..(x + width) as usize]).copied().collect();
    Film { width, height, pixels, samples: film.samples }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn numbered(width: u32, height: u32, corner: [u32; 2], full: [u32; 2]) -> (Film, Placement) {
        let mut film = Film::new(width, height, 1);
        for (i, pixel) in film.pixels.iter_mut().enumerate() {
            let (x, y) = (i as u32 % width + corner[0], i as u32 / width + corner[1]);
            *pixel = [(y * full[0] + x) as f32; 3];
        }
        (film, Placement { corner, full })
    }

    #[test]
    fn parts_of_one_picture_are_compared_where_they_overlap() {
        let full = [10, 8];
        let found = common(numbered(5, 4, [1, 2], full), numbered(6, 6, [3, 0], full)).unwrap();
        assert_eq!((found.a.width, found.a.height, found.placement.corner), (3, 4, [3, 2]));
        assert_eq!(found.a, found.b);
        assert!(common(numbered(2, 2, [0, 0], full), numbered(2, 2, [2, 0], full)).is_err());
    }

    #[test]
    fn parts_of_different_pictures_are_compared_as_they_are() {
        let found = common(numbered(4, 3, [1, 1], [10, 8]), numbered(4, 3, [0, 0], [4, 3])).unwrap();
        assert_eq!((found.a.width, found.placement), (4, Placement::whole(4, 3)));
    }
}
