// Texture coordinates of surface points, and their change over the footprint: every mapping has analytic
// derivatives, so that seams and poles are no discontinuities. Planes have coordinates of their own and
// triangles interpolate their vertices' uv (`surface`); the others map an entity in a frame: `planar` and
// `solid` are affine; `cylindrical`: u = phi/2pi, v = height; `spherical`: u = theta/pi, v = phi/2pi, theta
// from +axis, phi from +x towards +z; `cube`: the direction, or the position on the cube's face. Scale,
// rotation and offset come last; the host folds them in where it can, with whole tiles subtracted. Twin:
// src/oracle/mapping.rs.
#ifndef MAPPING_GLSL
#define MAPPING_GLSL

#include "footprint.glsl"
#include "math.glsl"

// True if changes are needed: by filters, or by the tangents of a normal map.
const bool DERIVATIVES = FILTERED || BUMPED;

// The inputs of a mapping: the entity that its kind projects, the shape's own coordinate, and the changes of
// both over the footprint.
struct MapInput {
    real3 entity;
    vec3 entity_x;
    vec3 entity_y;
    real2 own;
    vec2 own_x;
    vec2 own_y;
    bool gradients; // the changes are along unit vectors, not over a footprint
};

// A texture coordinate (u, v, w), or a direction for a cube texture, as the mapping computes it.
struct TexCoord {
    real3 at;
    vec3 dx;
    vec3 dy;
};

// As above in the precision of look-ups: whole tiles are subtracted if they change nothing.
struct Coordinate {
    vec3 at;
    vec3 dx;
    vec3 dy;
};

// Returns matrix · uv: scale and rotation. Most scenes neither rotate nor shear.
real2 turned_uv(const UvProjection map, real2 uv) {
    real2 mapped;
    if (ROTATED_UV) {
        mapped = real2(map.m00 * uv.x + map.m01 * uv.y, map.m11 * uv.y + map.m10 * uv.x);
    } else {
        mapped = real2(map.m00 * uv.x, map.m11 * uv.y);
    }
    return mapped;
}

// Returns matrix · uv + offset.
real2 placed(const UvProjection map, real2 uv) {
    // A product with zero changes nothing, so that maps that do not rotate round alike in either way.
    real2 mapped = map.offset;
    if (ROTATED_UV) mapped = fma(real2(map.m01, map.m10), uv.yx, mapped);
    return fma(real2(map.m00, map.m11), uv, mapped);
}

// Returns the coordinate of a mapping that ends with `placed`.
TexCoord placed_coordinate(const UvProjection map, real2 uv, vec2 dx, vec2 dy) {
    TexCoord c = TexCoord(real3(placed(map, uv), 0.0), vec3(0.0), vec3(0.0));
    if (DERIVATIVES) {
        c.dx = vec3(turned_uv(map, real2(dx)), 0.0);
        c.dy = vec3(turned_uv(map, real2(dy)), 0.0);
    }
    return c;
}

// Applies the linear part of the frame.
vec3 in_frame(const UvProjection map, vec3 v) {
    return vec3(dot3(vec3(map.x.xyz), v), dot3(vec3(map.y.xyz), v), dot3(vec3(map.z.xyz), v));
}

// Selects the face of a cube for a direction, and (s, t) in [-1, 1] on it (Vulkan 1.3, "Cube Map Face
// Selection"; ties go to z, then y). The third component is the length along the face's axis.
#define ON_CUBE_FACE(scalar, vector)                                                             \
    vector on_cube_face(vector d, out uint face) {                                               \
        vector a = abs(d);                                                                       \
        bool z = a.z >= a.x && a.z >= a.y;                                                       \
        bool y = !z && a.y >= a.x;                                                               \
        scalar major = z ? a.z : (y ? a.y : a.x);                                                \
        scalar along = z ? d.z : (y ? d.y : d.x);                                                \
        bool negative = along < 0.0;                                                             \
        face = (z ? 4u : (y ? 2u : 0u)) + (negative ? 1u : 0u);                                  \
        scalar s = z ? (negative ? -d.x : d.x) : (y ? d.x : (negative ? d.z : -d.z));            \
        scalar t = y ? (negative ? -d.z : d.z) : -d.y;                                           \
        return vector(s, t, major);                                                              \
    }

ON_CUBE_FACE(float, vec3)
#ifdef F64_MATH
ON_CUBE_FACE(double, dvec3)
#endif

// Returns the same two axes of a change of direction that stays on `face`.
vec3 along_cube_face(vec3 d, uint face) {
    bool negative = (face & 1u) != 0u;
    bool z = face >= 4u;
    bool y = !z && face >= 2u;
    float s = z ? (negative ? -d.x : d.x) : (y ? d.x : (negative ? d.z : -d.z));
    float t = y ? (negative ? -d.z : d.z) : -d.y;
    float along = z ? d.z : (y ? d.y : d.x);
    return vec3(s, t, negative ? -along : along);
}

// Returns the position on a face in [0, 1]² from numerator and axis: (s / major + 1) / 2.
#define FACE_UV(pair, vector)                                                                    \
    pair face_uv(vector stm) {                                                                   \
        pair uv = 0.5 * (stm.xy / stm.z) + 0.5;                                                  \
        return uv;                                                                               \
    }

FACE_UV(vec2, vec3)
#ifdef F64_MATH
FACE_UV(dvec2, dvec3)
#endif

// As above for any direction: the cube's centre and NaN have a defined result too.
vec2 within_face(vec3 stm) {
    vec2 uv = face_uv(stm);
    return vec2(uv.x >= 0.0 ? min(uv.x, 1.0) : 0.0, uv.y >= 0.0 ? min(uv.y, 1.0) : 0.0);
}

// Returns the change of `face_uv`: the derivative of the quotient.
vec2 face_uv_change(vec3 stm, vec3 change) {
    vec2 uv = 0.5 * (change.xy * stm.z - stm.xy * change.z) / (stm.z * stm.z);
    return uv;
}

// Limits the change of an angle to one turn, as it grows without bound towards the pole.
float within_turn(float change, bool gradients) { return gradients ? change : clamp(change, -1.0, 1.0); }

float turn_change(vec3 local, vec3 change, float around, bool gradients) {
    float area = local.x * change.z - local.z * change.x;
    float turn = area / (max(around, 1e-30) * (2.0 * PI));
    return within_turn(turn, gradients);
}

// Returns (turn, height) and its change: phi/2pi and y.
TexCoord cylindrical(const UvProjection map, real3 local, vec3 x, vec3 y, bool gradients) {
    real turn = atan2_accurate(local.z, local.x) * (0.5 / REAL_PI);
    turn = turn < 0.0 ? turn + 1.0 : turn;
    vec2 dx = vec2(0.0);
    vec2 dy = vec2(0.0);
    if (DERIVATIVES) {
        vec3 p = vec3(local);
        float around = p.x * p.x + p.z * p.z;
        dx = vec2(turn_change(p, x, around, gradients), x.y);
        dy = vec2(turn_change(p, y, around, gradients), y.y);
    }
    return placed_coordinate(map, real2(turn, local.y), dx, dy);
}

// Returns the change of theta / pi: (y drho - rho dy) / (rho² + y²), where drho = (x dx + z dz) / rho.
float polar_change(vec3 local, vec3 change, float across, float squared, bool gradients) {
    float outward = (local.x * change.x + local.z * change.z) / max(across, 1e-30);
    return within_turn((local.y * outward - across * change.y) / (max(squared, 1e-30) * PI), gradients);
}

// Returns (theta/pi, phi/2pi) and its change.
TexCoord spherical(const UvProjection map, real3 local, vec3 x, vec3 y, bool gradients) {
    real turn = atan2_accurate(local.z, local.x) * (0.5 / REAL_PI);
    turn = turn < 0.0 ? turn + 1.0 : turn;
    real around = local.x * local.x + local.z * local.z;
    real across = sqrt(around);
    real2 uv = real2(atan2_accurate(across, local.y) * (1.0 / REAL_PI), turn);
    vec2 dx = vec2(0.0);
    vec2 dy = vec2(0.0);
    if (DERIVATIVES) {
        vec3 p = vec3(local);
        float squared = float(around + local.y * local.y);
        dx = vec2(polar_change(p, x, float(across), squared, gradients), turn_change(p, x, float(around), gradients));
        dy = vec2(polar_change(p, y, float(across), squared, gradients), turn_change(p, y, float(around), gradients));
    }
    return placed_coordinate(map, uv, dx, dy);
}

TexCoord texture_coordinate(const UvProjection map, const MapInput seen) {
    uint kind = map.kind;
    if (MODE_IS(MAPPINGS, MAP_VERTEX_UV, kind)) {
        return TexCoord(real3(seen.own, 0.0), vec3(seen.own_x, 0.0), vec3(seen.own_y, 0.0));
    }
    if (MODE_IS(MAPPINGS, MAP_PLANE, kind)) return placed_coordinate(map, seen.own, seen.own_x, seen.own_y);
    vec3 x = vec3(0.0);
    vec3 y = vec3(0.0);
    if (DERIVATIVES) {
        x = in_frame(map, seen.entity_x);
        y = in_frame(map, seen.entity_y);
    }
    real2 xy = real2(affine(map.x, seen.entity), affine(map.y, seen.entity));
    if (MODE_IS(MAPPINGS, MAP_AFFINE, kind)) {
        return TexCoord(real3(xy, 0.0), vec3(x.xy, 0.0), vec3(y.xy, 0.0));
    }
    real3 local = real3(xy, affine(map.z, seen.entity));
    if (MODE_IS(MAPPINGS, MAP_SOLID, kind) || MODE_IS(MAPPINGS, MAP_CUBE, kind)) return TexCoord(local, x, y);
    if (MODE_IS(MAPPINGS, MAP_BOX, kind)) {
        uint face;
        real3 stm = on_cube_face(local, face);
        vec2 dx = vec2(0.0);
        vec2 dy = vec2(0.0);
        if (DERIVATIVES) {
            dx = face_uv_change(vec3(stm), along_cube_face(x, face));
            dy = face_uv_change(vec3(stm), along_cube_face(y, face));
        }
        return placed_coordinate(map, face_uv(stm), dx, dy);
    }
    if (MODE_IS(MAPPINGS, MAP_CYLINDRICAL, kind)) return cylindrical(map, local, x, y, seen.gradients);
    return spherical(map, local, x, y, seen.gradients);
}

#endif
