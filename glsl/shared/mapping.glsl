// Surface point -> texture coordinate. Planes have their own coordinates and triangles interpolate
// their vertices' uv (`surface`); `planar` is affine in the position; `cylindrical`: u = phi/2pi,
// v = height; `spherical`: u = theta/pi, v = phi/2pi, theta from +axis, phi from +x towards +z. Scale,
// rotation, offset come last; where the host can fold them in it has, with whole tiles taken out.
#ifndef MAPPING_GLSL
#define MAPPING_GLSL

#include "math.glsl"

// matrix · uv + offset. Most scenes neither rotate nor shear.
vec2 placed(Map map, vec2 uv) {
    precise vec2 mapped;
    if (ROTATED_UV) {
        mapped = vec2((map.matrix.x * uv.x + map.matrix.y * uv.y) + map.offset.x,
                      (map.matrix.w * uv.y + map.matrix.z * uv.x) + map.offset.y);
    } else {
        mapped = vec2(map.matrix.x * uv.x + map.offset.x, map.matrix.w * uv.y + map.offset.y);
    }
    return mapped;
}

vec2 texture_coordinate(Map map, vec3 p, vec2 own_uv) {
    uint kind = map.link.x;
    if (MODE_IS(MAPPINGS, MAP_VERTEX_UV, kind)) return own_uv;
    if (MODE_IS(MAPPINGS, MAP_PLANE, kind)) return placed(map, own_uv);
    vec2 xy = vec2(affine(map.x, p), affine(map.y, p));
    if (MODE_IS(MAPPINGS, MAP_AFFINE, kind)) return xy;
    float z = affine(map.z, p);
    float turn = atan2_accurate(z, xy.x) * (0.5 / PI);
    turn = turn < 0.0 ? turn + 1.0 : turn;
    vec2 uv = vec2(turn, xy.y);
    if (MODE_IS(MAPPINGS, MAP_SPHERICAL, kind)) {
        precise float across = sqrt(xy.x * xy.x + z * z);
        uv = vec2(atan2_accurate(across, xy.y) * (1.0 / PI), turn);
    }
    return placed(map, uv);
}

#endif
