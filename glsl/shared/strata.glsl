// Positions in strata, as integers in [0, 2^24) on each axis. With n strata per side, L = ceil(log2 n) and B
// = 24 - L bits of jitter j, the position in stratum c is floor(((c << B) + j) * 2^24 / (n << B)) = floor((c
// * 2^24 + j * 2^L) / n), in 32-bit integers.
#ifndef STRATA_GLSL
#define STRATA_GLSL

uint stratum_position(uint cell, uint jitter, uint side, uint side_log2) {
    if (side == (1u << side_log2)) return (cell << (24u - side_log2)) + jitter;
    // Long division of cell * 2^24 by side, 12 bits at a time: side <= 4096 keeps everything below 2^24.
    uint high = cell << 12u;
    uint low = (high % side) << 12u;
    uint quotient = ((high / side) << 12u) + low / side;
    return quotient + (low % side + (jitter << side_log2)) / side;
}

// As above for up to 2^24 strata per side and a jitter of 24 bits, of which the upper B are used. Long
// division 8 bits at a time: the remainder stays below 2^24.
uint fine_position(uint cell, uint jitter, uint cells) {
    uint cells_log2 = uint(findMSB(cells - 1u) + 1);
    jitter >>= cells_log2;
    if (cells == (1u << cells_log2)) return (cell << (24u - cells_log2)) + jitter;
    uint quotient = 0u;
    uint rest = cell;
    for (uint i = 0u; i < 3u; i++) {
        quotient = (quotient << 8u) + (rest << 8u) / cells;
        rest = (rest << 8u) % cells;
    }
    return quotient + (rest + (jitter << cells_log2)) / cells;
}

#endif
