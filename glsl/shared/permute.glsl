// Jittered strata whose rows and columns are permuted. `permute` returns the position of entry i in
// permutation p of the numbers below `length`: Kensler 2013, "Correlated Multi-Jittered Sampling", with its
// last offset limited to 24 bits, as i + p beyond 2^32 would map two entries to one position. Patterns:
// multi-jittered (ibid., any number of samples) and n-rooks (Shirley 1991).
#ifndef PERMUTE_GLSL
#define PERMUTE_GLSL

#include "rng.glsl"
#include "strata.glsl"

uint permute(uint i, uint length, uint p) {
    // All bits of length - 1 and below.
    uint mask = length == 1u ? 0u : 0xFFFFFFFFu >> (31u - uint(findMSB(length - 1u)));
    // Entries beyond the length are mapped again until they are below it (cycle walking).
    do {
        i ^= p;
        i *= 0xE170893Du;
        i ^= p >> 16u;
        i ^= (i & mask) >> 4u;
        i ^= p >> 8u;
        i *= 0x0929EB3Fu;
        i ^= p >> 23u;
        i ^= (i & mask) >> 1u;
        i *= 1u | (p >> 27u);
        i *= 0x6935FA69u;
        i ^= (i & mask) >> 11u;
        i *= 0x74DCB303u;
        i ^= (i & mask) >> 2u;
        i *= 0x9E501CC3u;
        i ^= (i & mask) >> 2u;
        i *= 0xC860A3DFu;
        i &= mask;
        i ^= i >> 5u;
    } while (i >= length);
    return (i + (p >> 8u)) % length;
}

// Returns a sample of columns × rows cells with one sample each, of which all samples have one in each of
// `count` rows and at most one in each of columns × rows columns: the order of the rows within a cell is the
// same for all columns.
uvec2 multi_jittered(uint s, uint columns, uint count, uvec2 key) {
    uint rows = (count + columns - 1u) / columns;
    uint column = permute(s % columns, columns, key.x);
    uint column_in_cell = permute(s / columns, rows, key.y);
    uvec2 jitter = sample_bits(key, s) >> 8u;
    return uvec2(fine_position(column * rows + column_in_cell, jitter.x, columns * rows),
                 fine_position(s, jitter.y, count));
}

// Returns one sample in each of `count` rows and of `count` columns.
uvec2 n_rooks(uint s, uint count, uvec2 key) {
    uvec2 jitter = sample_bits(key, s) >> 8u;
    return uvec2(fine_position(permute(s, count, key.x), jitter.x, count), fine_position(s, jitter.y, count));
}

#endif
