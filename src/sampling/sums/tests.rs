//! Sums of ranges merge to the same film in any order, and a wrong merge is noticed.

use super::*;

/// Samples of very different magnitudes, so that the order of addition is visible.
fn sample(x: u32, y: u32, s: u32) -> [f64; 3] {
    let mut rng = fastrand::Rng::with_seed(u64::from(x) << 40 | u64::from(y) << 20 | u64::from(s));
    std::array::from_fn(|_| (rng.f64() - 0.3) * 10f64.powi(rng.i32(-6..6)))
}

/// Returns the sums of a range as a backend computes them, in the order of the samples.
fn sums_of(range: &Range, signed: bool) -> FilmSums {
    let mut block = Block::new(range.clone());
    let mut negative = Vec::new();
    let mut weights = Vec::new();
    for (y, x) in range.pixels.rows().flat_map(|y| range.pixels.columns().map(move |x| (y, x))) {
        let (mut sum, mut below, mut weight) = ([0.0; 3], [0.0; 3], 0.0);
        for s in range.samples.clone() {
            let sign = if signed && (x + y + s) % 5 == 0 { -1.0 } else { 1.0 };
            for (c, value) in sample(x, y, s).into_iter().enumerate() {
                sum[c] += sign * value;
                below[c] += if sign < 0.0 { value } else { 0.0 };
            }
            weight += sign;
        }
        block.sums.push(sum);
        negative.push(below);
        weights.push(weight);
    }
    block.signed = signed.then_some(Signed { mean_sign: 0.6, negative, weights });
    block.into()
}

const SIZE: [u32; 2] = [13, 9];
const SAMPLES: u32 = 29;
/// Samples are split only at multiples of this number.
const BLOCK: u32 = 8;

fn whole() -> Range {
    Range { pixels: Rect::whole(SIZE), samples: 0..SAMPLES }
}

/// Returns blocks of samples, with the pixels of each split at random, in random order.
fn partition(rng: &mut fastrand::Rng) -> Vec<Range> {
    let mut parts = Vec::new();
    for block in whole().by_samples(BLOCK) {
        match rng.u32(0..3) {
            0 => parts.extend(block.tiles(rng.u32(1..9))),
            1 => parts.extend(block.strips(rng.u32(1..9))),
            _ => parts.extend(block.halves().into_iter().flatten()),
        }
    }
    rng.shuffle(&mut parts);
    parts
}

fn bits(film: &Film) -> Vec<[u32; 3]> {
    film.pixels.iter().map(|p| p.map(f32::to_bits)).collect()
}

fn film_of(parts: &[FilmSums]) -> Film {
    let mut sums = FilmSums::default();
    parts.iter().for_each(|part| sums.merge(part.clone()).unwrap());
    sums.to_film(SIZE, SAMPLES).unwrap()
}

#[test]
fn any_partition_handed_out_in_any_order_to_any_number_of_backends_gives_the_same_film() {
    let mut rng = fastrand::Rng::with_seed(5);
    for signed in [false, true] {
        let in_order: Vec<FilmSums> = whole().by_samples(BLOCK).map(|r| sums_of(&r, signed)).collect();
        let expected = bits(&film_of(&in_order));
        for _ in 0..40 {
            let backends = rng.usize(1..5);
            let mut each = vec![FilmSums::default(); backends];
            for range in partition(&mut rng) {
                each[rng.usize(0..backends)].merge(sums_of(&range, signed)).unwrap();
            }
            rng.shuffle(&mut each);
            assert_eq!(bits(&film_of(&each)), expected, "{backends} backends, signed: {signed}");
        }
    }
}

#[test]
fn merging_is_associative_and_commutative() {
    let mut rng = fastrand::Rng::with_seed(6);
    let merged = |a: &FilmSums, b: &FilmSums| {
        let mut sums = a.clone();
        sums.merge(b.clone()).unwrap();
        sums
    };
    for _ in 0..20 {
        let parts: Vec<FilmSums> = partition(&mut rng).iter().map(|r| sums_of(r, true)).collect();
        let [a, b, c] = &parts[..3] else { panic!("{} parts", parts.len()) };
        assert_eq!(merged(&merged(a, b), c), merged(a, &merged(b, c)));
        assert_eq!(merged(a, b), merged(b, a));
    }
}

/// Adds blocks in the order of arrival, which a merge must not do.
fn merge_by_arrival(parts: &[FilmSums]) -> Film {
    let mut sums = vec![[0.0; 3]; whole().pixels.area()];
    for block in parts.iter().flat_map(FilmSums::blocks) {
        let pixels = block.range.pixels;
        let places = pixels.rows().flat_map(|y| pixels.columns().map(move |x| (y * SIZE[0] + x) as usize));
        for (at, own) in places.zip(&block.sums) {
            (0..3).for_each(|c| sums[at][c] += own[c]);
        }
    }
    let mut film = Film::new(SIZE[0], SIZE[1], SAMPLES);
    let means = sums.iter().map(|sum| sum.map(|v| (v / f64::from(SAMPLES)) as f32));
    film.pixels.iter_mut().zip(means).for_each(|(pixel, mean)| *pixel = mean);
    film
}

#[test]
fn a_merge_in_the_order_of_arrival_is_noticed() {
    let mut parts: Vec<FilmSums> = whole().by_samples(1).map(|r| sums_of(&r, false)).collect();
    // The first two samples cancel: if they are added last, the sums between them are lost even in f64.
    for (part, value) in parts.iter_mut().zip([1e17, -1e17]) {
        part.blocks[0].sums.iter_mut().for_each(|sum| *sum = [value; 3]);
    }
    let backwards: Vec<FilmSums> = parts.iter().rev().cloned().collect();
    assert_eq!(bits(&merge_by_arrival(&parts)), bits(&film_of(&parts)));
    assert_ne!(bits(&merge_by_arrival(&backwards)), bits(&film_of(&backwards)));
}

#[test]
fn what_would_count_twice_or_is_missing_is_refused() {
    let range = |x, samples| Range { pixels: Rect { x, y: 2, width: 3, height: 4 }, samples };
    let mut sums = sums_of(&range(0, 0..8), false);
    sums.merge(sums_of(&range(3, 0..8), false)).unwrap();
    sums.merge(sums_of(&range(0, 8..9), false)).unwrap();
    let error = sums.merge(sums_of(&range(5, 7..9), false)).unwrap_err().to_string();
    assert!(error.contains("samples 7 to 7 of pixel (5, 2)"), "{error}");
    let error = sums.to_film([13, 9], 8).unwrap_err().to_string();
    assert!(error.contains("204 of 936 samples"), "{error}");
}
