// Smooth noise from random values on the integer lattice: gradient noise after Perlin 2002, sums of its
// octaves, and the distance to the nearest jittered point (Worley 1996, F1). Hashes are integers, so every
// device has the same lattice; cell indices wrap at 2^32. Averages over a footprint fade to the mean as the
// footprint grows. Twin: src/oracle/noise.rs.
#ifndef NOISE_GLSL
#define NOISE_GLSL

#include "math.glsl"
#include "rng.glsl"

// Statistics of gradient noise over space, from 3e6 random points.
const float NOISE_VARIANCE = 0.0729;
const float FOLDED_MEAN = 0.2203; // of |noise|
const float FOLDED_VARIANCE = 0.0244;
const vec2 FOLDED_SLICES = vec2(-0.11, -0.094); // see `slice_mean`

// Returns the weight of the value at the footprint's centre relative to the mean, for a footprint of this
// many cells: the regression of the mean over a square on the value at its centre, within 0.07, for noise and
// for cells.
float kept(float cells) {
    if (!PROCEDURAL_FILTERED) return 1.0;
    float x = min(0.5 * cells, 1.0);
    float weight = 1.0 - x * x * (3.0 - 2.0 * x);
    return weight;
}

// Returns the mean of a function that is constant along the axes that the footprint does not extend along:
// planes of the lattice differ from the volume. With s the distance from the centre of a cell, the mean over
// a plane is nearly linear in s², whose mean over all planes is 1/12; the slopes are those at the centre and
// at the border.
float slice_mean(float mean, vec2 slopes, vec3 fraction, vec3 widths) {
    vec3 s = fraction - 0.5;
    vec3 square = s * s;
    vec3 off = (square - 1.0 / 12.0) * (slopes.x + (slopes.y - slopes.x) * (4.0 * square));
    float shifted = mean + (off.x * kept(widths.x) + off.y * kept(widths.y) + off.z * kept(widths.z));
    return shifted;
}

// Returns the index of a cell. Beyond 2^31 no f32 has a fraction, and any cell will do.
uvec3 lattice_cell(real3 whole) {
    bvec3 near = lessThanEqual(abs(whole), real3(2147483520.0));
    return uvec3(ivec3(mix(real3(0.0), whole, near)));
}

// Returns the dot product with one of the 12 vectors from a cube's centre to its edges.
float lattice_gradient(uvec3 cell, float x, float y, float z) {
    uint code = pcg3d(cell).x >> 28u;
    float u = code < 8u ? x : y;
    float v = code < 4u ? y : (code == 12u || code == 14u ? x : z);
    float product = ((code & 1u) != 0u ? -u : u) + ((code & 2u) != 0u ? -v : v);
    return product;
}

float blend(float a, float b, float weight) {
    float value = a + weight * (b - a);
    return value;
}

// Returns gradient noise in [-1, 1], 0 at lattice points, with continuous second derivatives.
float gradient_noise(real3 p, uvec3 key) {
    real3 whole = floor(p);
    vec3 f = vec3(p - whole);
    vec3 g = f - 1.0;
    vec3 s = f * f * f * (f * (f * 6.0 - 15.0) + 10.0);
    uvec3 a = lattice_cell(whole) + key;
    uvec3 b = a + 1u;
    float low = blend(blend(lattice_gradient(a, f.x, f.y, f.z),
                            lattice_gradient(uvec3(b.x, a.yz), g.x, f.y, f.z), s.x),
                      blend(lattice_gradient(uvec3(a.x, b.y, a.z), f.x, g.y, f.z),
                            lattice_gradient(uvec3(b.xy, a.z), g.x, g.y, f.z), s.x), s.y);
    float high = blend(blend(lattice_gradient(uvec3(a.xy, b.z), f.x, f.y, g.z),
                             lattice_gradient(uvec3(b.x, a.y, b.z), g.x, f.y, g.z), s.x),
                       blend(lattice_gradient(uvec3(a.x, b.yz), f.x, g.y, g.z),
                             lattice_gradient(b, g.x, g.y, g.z), s.x), s.y);
    return clamp(blend(low, high, s.z), -1.0, 1.0);
}

// Returns in x the weighted mean of the octaves of noise, or of |noise| if `folded`, in y the variance that
// has faded out of it. `size` and `widths` of the footprint are in units of the coordinate. All octaves but
// the first are shifted by fractions of a cell, so that their zeros do not coincide.
vec2 octave_sum(const Procedural what, real3 at, float size, vec3 widths, bool folded) {
    float sum = 0.0;
    float faded = 0.0;
    float weight = what.normalization;
    float frequency = 1.0;
    for (uint k = 0u; k < what.octaves; k++) {
        uvec3 key = pcg3d(uvec3(what.seed, k, 0u));
        vec3 shift = k == 0u ? vec3(0.0) : vec3(key >> 8u) * (1.0 / 16777216.0);
        real3 p = at * frequency + shift;
        float value = gradient_noise(p, key);
        float keep = kept(size * frequency);
        float mean = 0.0;
        float variance = NOISE_VARIANCE;
        if (folded) {
            value = abs(value);
            mean = slice_mean(FOLDED_MEAN, FOLDED_SLICES, vec3(fract(p)), widths * frequency);
            variance = FOLDED_VARIANCE;
        }
        sum += weight * (keep * value + (1.0 - keep) * mean);
        faded += weight * weight * variance * (1.0 - keep * keep);
        weight *= what.gain;
        frequency *= what.lacunarity;
    }
    return vec2(sum, faded);
}

// Returns the distance to the nearest point, at most 1: nearer points are in the 27 cells that are searched.
float cell_distance(real3 p, uint seed, float jitter) {
    real3 whole = floor(p);
    vec3 f = vec3(p - whole);
    uvec3 cell = lattice_cell(whole) + pcg3d(uvec3(seed, 0u, 0u));
    float nearest = 1.0;
    for (uint i = 0u; i < 27u; i++) {
        uvec3 step = uvec3(i % 3u, (i / 3u) % 3u, i / 9u);
        vec3 random = vec3(pcg3d(cell + step - 1u) >> 8u) * (1.0 / 16777216.0);
        vec3 away = ((vec3(step) - 0.5) + jitter * (random - 0.5)) - f;
        nearest = min(nearest, dot3(away, away));
    }
    return sqrt(nearest);
}

// Returns the mean of `cell_distance`, within 0.002, with its variation between planes, within 0.01:
// polynomials through values from 3e5 random points.
float cell_mean(real3 p, vec3 widths, float jitter) {
    float j = jitter * jitter;
    float mean = 0.4803 + j * (0.0504 - 0.0099 * j);
    vec2 slopes = vec2(1.175 + j * (0.36 * j - 1.42), 0.96 - 0.93 * jitter);
    return slice_mean(mean, slopes, vec3(fract(p)), widths);
}

#endif
