// The Halton sequence with Owen's nested scrambling: pair k has the bases PRIMES[2k] and PRIMES[2k + 1]. Base
// 2 is that of sobol.glsl. In other bases digit d becomes slope · d + shift mod base, with a hashed slope and
// shift for each interval of the preceding digits: affine maps permute pairs of digits uniformly, on which
// alone the variance depends (Owen 2003, "Variance with Alternative Scramblings of Digital Nets").
#ifndef HALTON_GLSL
#define HALTON_GLSL

#include "sobol.glsl"

const uint PRIMES[32] = uint[32](2u, 3u, 5u, 7u, 11u, 13u, 17u, 19u, 23u, 29u, 31u, 37u, 41u, 43u, 47u, 53u,
                                 59u, 61u, 67u, 71u, 73u, 79u, 83u, 89u, 97u, 101u, 103u, 107u, 109u, 113u,
                                 127u, 131u);
// Paths longer than this number of pairs continue with random points.
const uint HALTON_PAIRS = uint(PRIMES.length()) / 2u;
// The largest power of each prime below 2^30, and 2^56 over it.
const uint TOTALS[32] = uint[32](536870912u, 387420489u, 244140625u, 282475249u, 214358881u, 815730721u,
                                 410338673u, 893871739u, 148035889u, 594823321u, 887503681u, 69343957u,
                                 115856201u, 147008443u, 229345007u, 418195493u, 714924299u, 844596301u,
                                 20151121u, 25411681u, 28398241u, 38950081u, 47458321u, 62742241u, 88529281u,
                                 104060401u, 112550881u, 131079601u, 141158161u, 163047361u, 260144641u,
                                 294499921u);
const uint RECIPROCALS[32] = uint[32](134217728u, 185993245u, 295147905u, 255093479u, 336153994u, 88335025u,
                                      175605173u, 80612901u, 486757599u, 121141171u, 81191318u, 1039132999u,
                                      621957162u, 490159562u, 314188632u, 172306003u, 100790523u, 85316018u,
                                      3575860322u, 2835609105u, 2537396384u, 1849998567u, 1518334246u,
                                      1148470199u, 813940802u, 692459315u, 640222390u, 549723934u, 510474162u,
                                      441942718u, 276990499u, 244677804u);

uint high_product(uint a, uint b) {
    uint high, low;
    umulExtended(a, b, high, low);
    return high;
}

// Returns the scrambled radical inverse of `index` in this base. `stream` is the scrambled position within
// the interval, as 24 bits, if all further digits are zero: its first digit in this base is the shift, the
// remainder the fraction within that digit's interval. Any other digit begins a new stream. `path` identifies
// the interval. Widths and positions are in units of 1 / `total`, so that intervals end exactly.
uint scrambled_inverse(uint index, uint base, uint total, uint reciprocal, uint seed) {
    uint path = seed;
    uint stream = path >> 8u;
    uint width = total;
    uint place = 0u;
    while (index != 0u) {
        uint digit = index % base;
        index /= base;
        uint slope = 1u + (((stream & 0xFFFFu) * (base - 1u)) >> 16u);
        uint digits = stream * base;
        width /= base;
        place += ((slope * digit + (digits >> 24u)) % base) * width;
        path = (path + digit) * 0x9E3779B1u;
        path ^= path >> 15u;
        stream = digit == 0u ? digits & 0xFFFFFFu : path >> 8u;
    }
    place += high_product(stream << 8u, width);
    // floor(place * 2^24 / total): the product is that or one less.
    uint position = high_product(place, reciprocal);
    uint rest = (place << 24u) - position * total;
    return position + (rest >= total ? 1u : 0u);
}

uint of_prime(uint index, uint i, uint seed) {
    return scrambled_inverse(index, PRIMES[i], TOTALS[i], RECIPROCALS[i], seed);
}

uvec2 halton(uint s, uint pair, uvec2 key) {
    if (pair == 0u) {
        return uvec2(bitfieldReverse(laine_karras(s, key.x)) >> 8u,
                     scrambled_inverse(s, PRIMES[1], TOTALS[1], RECIPROCALS[1], key.y));
    }
    return uvec2(of_prime(s, 2u * pair, key.x), of_prime(s, 2u * pair + 1u, key.y));
}

#endif
