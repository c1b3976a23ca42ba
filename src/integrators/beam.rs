//! One beam per pixel: the backend resolves all pixels and flags those that it cannot resolve; these take
//! samples.

use super::{Integrated, Integrator};
use crate::core::error::Result;
use crate::core::film::Film;
use crate::core::progress::Progress;
use crate::core::range::Rect;
use crate::sampling::{Backend, HalfSums};
use crate::schema::layout::PixelBatch;

/// One beam per pixel, and `samples` samples for pixels that a beam cannot resolve.
#[derive(Clone, Copy, Debug)]
pub struct Beam {
    pub samples: u32,
}

impl Integrator for Beam {
    fn render(
        &self,
        backend: &mut dyn Backend,
        mut film: Film,
        progress: &dyn Progress,
    ) -> Result<Integrated> {
        let size = [film.width, film.height];
        film.samples = 1;
        let mut flagged: Vec<u32> = Vec::new();
        for (i, [r, g, b, sampled]) in (0..).zip(backend.resolve(Rect::whole(size), progress)?) {
            film.pixels[i as usize] = [r, g, b];
            if sampled != 0.0 {
                flagged.push(i);
            }
        }
        let sampled_pixels = Some(flagged.len() as u64);
        if !flagged.is_empty() {
            let batch = |&i: &u32| PixelBatch {
                place: PixelBatch::place_of(i, size[0]),
                part: 0,
                first: 0,
                count: self.samples,
            };
            backend.sample(&flagged.iter().map(batch).collect::<Vec<_>>(), progress)?;
            let mut sums = HalfSums::new(size);
            backend.read(&mut sums)?;
            for i in flagged {
                let sum = sums.halves[0][i as usize];
                film.pixels[i as usize] = std::array::from_fn(|c| sum[c] / self.samples as f32);
            }
        }
        Ok(Integrated { sampled_pixels, ..Integrated::from(film) })
    }
}
