//! Counter-based random bits: integers in, integers out, no state. Jarzynski & Olano 2020, "Hash Functions
//! for GPU Rendering" (pcg2d, pcg3d), pcg2d without its last step, v ^= v >> 16, which changes the lower half
//! alone: less than 2^-16 of the range of a position. Bit-identical to its twin `glsl/shared/rng.glsl`.

const MULTIPLIER: u32 = 1_664_525;
const INCREMENT: u32 = 1_013_904_223;

/// One step of a linear congruential generator (Press et al., "Numerical Recipes", ranqd1).
fn step(x: u32) -> u32 {
    x.wrapping_mul(MULTIPLIER).wrapping_add(INCREMENT)
}

pub fn pcg2d(v: [u32; 2]) -> [u32; 2] {
    let [mut x, mut y] = v.map(step);
    x = x.wrapping_add(y.wrapping_mul(MULTIPLIER));
    y = y.wrapping_add(x.wrapping_mul(MULTIPLIER));
    x ^= x >> 16;
    y ^= y >> 16;
    x = x.wrapping_add(y.wrapping_mul(MULTIPLIER));
    y = y.wrapping_add(x.wrapping_mul(MULTIPLIER));
    [x, y]
}

/// Hashes one word to one word: Wellons 2018, "Prospecting for Hash Functions" (lowbias32).
pub fn mix_bits(mut v: u32) -> u32 {
    v ^= v >> 16;
    v = v.wrapping_mul(0x7FEB_352D);
    v ^= v >> 15;
    v = v.wrapping_mul(0x846C_A68B);
    v ^ (v >> 16)
}

pub fn pcg3d(v: [u32; 3]) -> [u32; 3] {
    let [mut x, mut y, mut z] = v.map(step);
    for round in 0..2 {
        x = x.wrapping_add(y.wrapping_mul(z));
        y = y.wrapping_add(z.wrapping_mul(x));
        z = z.wrapping_add(x.wrapping_mul(y));
        if round == 0 {
            x ^= x >> 16;
            y ^= y >> 16;
            z ^= z >> 16;
        }
    }
    [x, y, z]
}

/// Returns the key of a pixel; if pixels share a key it is that of a pixel outside the picture.
pub fn pixel_key(pixel: [u32; 2], seed: u32, shared_key: bool) -> [u32; 2] {
    let [x, y] = if shared_key { [u32::MAX; 2] } else { pixel };
    let [a, b, _] = pcg3d([x, y, seed]);
    [a, b]
}

/// Returns two words of random bits for sample `s` of the pixel with this key. Both words of the counter
/// change with `s`: with counters in one word alone, `pcg2d` leaves the means of first coordinates at 0.7 of
/// their variance.
pub fn sample_bits(key: [u32; 2], s: u32) -> [u32; 2] {
    pcg2d([key[0].wrapping_add(s), key[1] ^ s.wrapping_mul(0x9E37_79B9)])
}
