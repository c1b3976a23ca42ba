//! Two independent pictures as a reference: errors that are planted beside its noise are found, with an uncertainty that is
//! the true one.

use moire::internal::core::film::Film;
use moire::internal::lab::metrics::{Estimate, Halves, compare};

/// Noise of mean 0 and variance 1, of which the channels of a pixel have the same.
fn noise(rng: &mut fastrand::Rng) -> f32 {
    // The sum of twelve numbers from 0 to 1.
    (0..12).map(|_| rng.f32()).sum::<f32>() - 6.0
}

fn noisy(truth: &Film, deviation: f32, rng: &mut fastrand::Rng) -> Film {
    let mut film = truth.clone();
    film.pixels.iter_mut().for_each(|pixel| {
        let own = deviation * noise(rng);
        *pixel = pixel.map(|v| v + own);
    });
    film
}

fn with_planted(truth: &Film, error: f32) -> Film {
    let mut film = truth.clone();
    film.pixels.iter_mut().step_by(2).for_each(|pixel| *pixel = pixel.map(|v| v + error));
    film
}

fn truth() -> Film {
    let mut film = Film::new(40, 30, 4);
    film.pixels.iter_mut().enumerate().for_each(|(i, pixel)| *pixel = [i as f32 / 600.0, 0.5, 0.25]);
    film
}

#[test]
fn a_planted_error_is_found_whatever_the_noise_of_the_reference() {
    let (truth, mut rng) = (truth(), fastrand::Rng::with_seed(1));
    // Half of the pixels are off by 0.1: the squared error is 0.005. The noise of a half is as large as the error.
    let film = with_planted(&truth, 0.1);
    let mut scores = Vec::new();
    let mut naive = 0.0;
    for _ in 0..300 {
        let halves = Halves { a: noisy(&truth, 0.1, &mut rng), b: noisy(&truth, 0.1, &mut rng) };
        let found = halves.mse_of(&film).unwrap().unwrap();
        scores.push((found.value - 0.005) / found.deviation);
        naive += compare(&film, &halves.mean()).unwrap().mse / 300.0;
    }
    let mean = scores.iter().sum::<f64>() / 300.0;
    let spread = (scores.iter().map(|z| z * z).sum::<f64>() / 300.0).sqrt();
    // Of 300 numbers of variance 1, the mean has a deviation of 0.058 and the root of the mean square one of 0.041.
    assert!(mean.abs() < 0.24, "mean {mean} deviations off");
    assert!((0.83..1.17).contains(&spread), "{spread} times the deviation that was told");
    // Against the mean of both, the noise counts as an error of the picture.
    assert!(naive > 0.0095, "{naive}");
}

#[test]
fn errors_that_differ_by_less_than_the_noise_are_not_ranked_and_larger_ones_are() {
    let (truth, mut rng) = (truth(), fastrand::Rng::with_seed(2));
    let halves = Halves { a: noisy(&truth, 0.1, &mut rng), b: noisy(&truth, 0.1, &mut rng) };
    let [x, y, z] = [0.1, 0.1001, 0.15].map(|error| with_planted(&truth, error));
    let clear = |x: &Film, y: &Film| halves.mse_between(x, y).unwrap().unwrap().is_clear();
    assert!(!clear(&noisy(&x, 0.02, &mut rng), &noisy(&x, 0.02, &mut rng)), "noise is ranked");
    assert!(clear(&z, &x) && clear(&x, &z), "a third more is not seen");
    assert!(halves.mse_between(&x, &x).unwrap().unwrap().is_clear(), "a picture equals itself for sure");
    assert!(!halves.mse_of(&truth).unwrap().unwrap().is_clear(), "the truth has an error");
    let quiet = Halves { a: truth.clone(), b: truth.clone() };
    assert!(quiet.mse_between(&y, &x).unwrap().unwrap().is_clear(), "without noise all is clear");
    assert_eq!(quiet.mse_of(&truth).unwrap(), Some(Estimate { value: 0.0, deviation: 0.0 }));
}

#[test]
fn the_mean_has_half_of_the_difference_as_its_error() {
    let (truth, mut rng) = (truth(), fastrand::Rng::with_seed(3));
    let halves = Halves { a: noisy(&truth, 0.1, &mut rng), b: noisy(&truth, 0.1, &mut rng) };
    let found = compare(&halves.mean(), &truth).unwrap().rmse;
    // The mean of two has 0.1 / √2 = 0.0707; 1200 pixels tell it to 2 %.
    assert!((halves.rmse().unwrap() / found - 1.0).abs() < 0.1, "{found}");
    assert_eq!(halves.mean().samples, 8);
    let mut more = halves.clone();
    more.add(&Halves { a: halves.b.clone(), b: halves.a.clone() });
    assert_eq!((more.a.samples, more.rmse().unwrap() < 1e-7), (8, true), "both have all samples");
    let mut broken = truth.clone();
    broken.pixels[7][1] = f32::NAN;
    assert_eq!(halves.mse_of(&broken).unwrap(), None);
    assert!(halves.mse_of(&Film::new(3, 3, 1)).is_err());
}
