// All texels one after the other, in 32-bit words; beside images those that images cannot hold. They are in
// one texel buffer or, if a device's buffers are too short, in several of 2^BLOCK_LOG2 words.
#ifndef TEXEL_BUFFER_GLSL
#define TEXEL_BUFFER_GLSL

#include "features.glsl"

layout(set = 0, binding = BINDING_TEXELS) uniform usamplerBuffer texels[TEXEL_BLOCKS];

// Not every device can index descriptors by a variable, so the block is compared with constants; those beyond
// the count are removed.
#define READ_BLOCK(i) if (TEXEL_BLOCKS > uint(i) && block == uint(i)) word = texelFetch(texels[i], within).x;

uint texel_word(uint at) {
    if (TEXEL_BLOCKS == 1u) return texelFetch(texels[0], int(at)).x;
    uint block = at >> BLOCK_LOG2;
    int within = int(at & ((1u << BLOCK_LOG2) - 1u));
    uint word = 0u;
    READ_BLOCK(0)
    READ_BLOCK(1)
    READ_BLOCK(2)
    READ_BLOCK(3)
    READ_BLOCK(4)
    READ_BLOCK(5)
    READ_BLOCK(6)
    READ_BLOCK(7)
    READ_BLOCK(8)
    READ_BLOCK(9)
    READ_BLOCK(10)
    READ_BLOCK(11)
    READ_BLOCK(12)
    READ_BLOCK(13)
    READ_BLOCK(14)
    READ_BLOCK(15)
    return word;
}

#endif
