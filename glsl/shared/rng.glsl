// Counter-based random bits: integers in, integers out, no state. Jarzynski & Olano 2020, "Hash Functions for
// GPU Rendering" (pcg2d, pcg3d), pcg2d without its last step, v ^= v >> 16, which changes the lower half
// alone: less than 2^-16 of the range of a position. Bit-identical to its twin src/oracle/rng.rs.
#ifndef RNG_GLSL
#define RNG_GLSL

uvec2 pcg2d(uvec2 v) {
    v = v * 1664525u + 1013904223u;
    v.x += v.y * 1664525u;
    v.y += v.x * 1664525u;
    v ^= v >> 16u;
    v.x += v.y * 1664525u;
    v.y += v.x * 1664525u;
    return v;
}

// Hashes one word to one word: Wellons 2018, "Prospecting for Hash Functions" (lowbias32).
uint mix_bits(uint v) {
    v ^= v >> 16u;
    v *= 0x7FEB352Du;
    v ^= v >> 15u;
    v *= 0x846CA68Bu;
    return v ^ (v >> 16u);
}

uvec3 pcg3d(uvec3 v) {
    v = v * 1664525u + 1013904223u;
    v.x += v.y * v.z;
    v.y += v.z * v.x;
    v.z += v.x * v.y;
    v ^= v >> 16u;
    v.x += v.y * v.z;
    v.y += v.z * v.x;
    v.z += v.x * v.y;
    return v;
}

// Returns the key of a pixel; if pixels share a key it is that of a pixel outside the picture.
uvec2 pixel_key(uvec2 pixel, uint seed, bool shared_key) {
    return pcg3d(uvec3(shared_key ? uvec2(0xFFFFFFFFu) : pixel, seed)).xy;
}

// Returns two words of random bits for sample `s` of the pixel with this key. Both words of the counter
// change with s: with counters in one word alone, pcg2d leaves the means of first coordinates at 0.7 of their
// variance.
uvec2 sample_bits(uvec2 key, uint s) {
    return pcg2d(uvec2(key.x + s, key.y ^ (s * 0x9E3779B9u)));
}

#endif
