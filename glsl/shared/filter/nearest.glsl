// Filter `nearest`: the texel that contains a position. Twin: src/oracle/filter/nearest.rs.
#ifndef NEAREST_GLSL
#define NEAREST_GLSL

#include "cube.glsl"

#if SOURCE != SOURCE_NONE

// Returns the texel that contains a position. With `stays`, a position on the far edge of a cube's face
// belongs to the face that the direction selects; otherwise one beyond a corner is one of the three texels
// there, by `die` in [0, 1).
vec4 nearest(const Texture image, const Sampler how, uint slot, const Level level, vec3 place, uint face, float die, bool stays) {
    ivec3 texel = ivec3(floor(place));
    if (MODE_IS(TEXTURE_KINDS, TEXTURE_KIND_CUBE, image.kind)) {
        if (stays) texel = min(texel, ivec3(level.size.x - 1));
        bool corner = (texel.x < 0 || texel.x >= level.size.x) && (texel.y < 0 || texel.y >= level.size.x);
        if (corner && die < 2.0 / 3.0) {
            texel.x = die < 1.0 / 3.0 ? clamp(texel.x, 0, level.size.x - 1) : texel.x;
            texel.y = die < 1.0 / 3.0 ? texel.y : clamp(texel.y, 0, level.size.x - 1);
        } else if (corner) {
            texel.xy = clamp(texel.xy, ivec2(0), ivec2(level.size.x - 1));
        }
        return fetch_texel(image, slot, level, cube_texel(face, texel.xy, level.size.x));
    }
    if (!MODE_IS(TEXTURE_KINDS, TEXTURE_KIND_VOLUME, image.kind)) return flat_texel(image, how, slot, level, texel.xy);
    return fetch_or_border(image, how, slot, level,
                           ivec3(addressed_texel(ADDRESSES_U, how.address_u, texel.x, level.size.x),
                                 addressed_texel(ADDRESSES_V, how.address_v, texel.y, level.size.y),
                                 addressed_texel(ADDRESSES_W, how.address_w, texel.z, level.size.z)));
}

#endif

#endif
