// The four texels of a bilinear look-up, read at once from level 0: of an image by one gather for each channel, of a texel
// buffer from words in which each texel has its neighbours (src/pack/texel_quads.rs).
#ifndef TEXEL_QUAD_GLSL
#define TEXEL_QUAD_GLSL

#include "texture.glsl"

#if SOURCE != SOURCE_NONE
// Four texels: at a position, to its right, below it, and below that.
struct Quad {
    vec4 at;
    vec4 right;
    vec4 below;
    vec4 across;
};
#if HAS_IMAGES
#define GATHERED(channel)                                                                        \
    vec4 gathered_##channel(uint slot, vec2 corner) {                                            \
        SLOT_SWITCH(SLOTS, GATHER_##channel)                                                     \
    }
#define GATHER_0(i) textureGather(SLOT(i), corner, 0)
#define GATHER_1(i) textureGather(SLOT(i), corner, 1)
#define GATHER_2(i) textureGather(SLOT(i), corner, 2)
#define GATHER_3(i) textureGather(SLOT(i), corner, 3)
GATHERED(0)
GATHERED(1)
GATHERED(2)
GATHERED(3)

// Returns four texels of level 0 from `first` on, which is `low` as integers. The image repeats, whatever the address mode.
Quad texel_quad(const Texture image, const Sampler how, uint slot, vec2 low, ivec2 first) {
    vec2 size = vec2(image.size.xy);
    vec2 at = low;
    if (MODE_IS(ADDRESSES_U, ADDRESS_CLAMP_TO_EDGE, how.address_u)) at.x = clamp(low.x, 0.0, size.x - 1.0);
    if (MODE_IS(ADDRESSES_V, ADDRESS_CLAMP_TO_EDGE, how.address_v)) at.y = clamp(low.y, 0.0, size.y - 1.0);
    // Of the corner that the four have in common: the device's arithmetic does not move it by half a texel.
    vec2 texel = 1.0 / size;
    vec2 corner = fma(at, texel, texel);
    vec4 r = gathered_0(slot, corner);
    vec4 g = r;
    vec4 b = r;
    vec4 a = vec4(1.0);
    if (TEXEL_FORMATS != (1u << TEXEL_FORMAT_GREY8)) {
        g = gathered_1(slot, corner);
        b = gathered_2(slot, corner);
        a = gathered_3(slot, corner);
    }
    return Quad(decoded(image, vec4(r.w, g.w, b.w, a.w)), decoded(image, vec4(r.z, g.z, b.z, a.z)),
                decoded(image, vec4(r.x, g.x, b.x, a.x)), decoded(image, vec4(r.y, g.y, b.y, a.y)));
}
#elif HAS_TEXELS
// Each grey texel of 8 bits has a word with its neighbours; each of four channels has four words.
Quad texel_quad(const Texture image, const Sampler how, uint slot, vec2 low, ivec2 first) {
    ivec2 at = ivec2(addressed_texel(ADDRESSES_U, how.address_u, first.x, int(image.size.x)),
                     addressed_texel(ADDRESSES_V, how.address_v, first.y, int(image.size.y)));
    bool srgb = MODE_IS(COLOR_SPACES, COLOR_SPACE_SRGB, image.color_space);
    uint texel = uint(at.y * int(image.size.x) + at.x);
    if (TEXEL_FORMATS == (1u << TEXEL_FORMAT_GREY8)) {
        uvec4 codes = codes_of(texel_word(4u * image.first_word + texel));
        vec4 light = unorm8(vec4(codes));
        if (srgb) light = vec4(decode_srgb8(codes.x), decode_srgb8(codes.y), decode_srgb8(codes.z), decode_srgb8(codes.w));
        return Quad(vec4(light.xxx, 1.0), vec4(light.yyy, 1.0), vec4(light.zzz, 1.0), vec4(light.www, 1.0));
    }
    uvec4 four = texelFetch(texels[0], int(image.first_word + texel));
    return Quad(rgba8(four.x, srgb), rgba8(four.y, srgb), rgba8(four.z, srgb), rgba8(four.w, srgb));
}
#endif
#endif

#endif
