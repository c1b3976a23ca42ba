// All texels one after the other, in 32-bit words; beside images what cannot be read from those. They lie in
// one texel buffer or, where a device's buffers are too short, in several of 2^BLOCK_LOG2 words.
#ifndef POOL_GLSL
#define POOL_GLSL

#include "features.glsl"

layout(set = 0, binding = 6) uniform usamplerBuffer texels[TEXEL_BLOCKS];

// Not every device can index descriptors by a variable, so the block is compared with constants. Blocks beyond
// the count are never chosen, but their constants must stay inside the array.
#define READ_BLOCK(i) \
    if (TEXEL_BLOCKS > (i) && block == (i)) word = texelFetch(texels[(i) < TEXEL_BLOCKS ? (i) : 0u], within).x;

uint texel_word(uint at) {
    if (TEXEL_BLOCKS == 1u) return texelFetch(texels[0], int(at)).x;
    uint block = at >> BLOCK_LOG2;
    int within = int(at & ((1u << BLOCK_LOG2) - 1u));
    uint word = 0u;
    READ_BLOCK(0u)
    READ_BLOCK(1u)
    READ_BLOCK(2u)
    READ_BLOCK(3u)
    READ_BLOCK(4u)
    READ_BLOCK(5u)
    READ_BLOCK(6u)
    READ_BLOCK(7u)
    READ_BLOCK(8u)
    READ_BLOCK(9u)
    READ_BLOCK(10u)
    READ_BLOCK(11u)
    READ_BLOCK(12u)
    READ_BLOCK(13u)
    READ_BLOCK(14u)
    READ_BLOCK(15u)
    return word;
}

#endif
