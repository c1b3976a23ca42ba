// Surface point -> texture coordinate, and how it changes over the footprint: every mapping has its
// analytic derivatives, so that no seam or pole reads as a jump. Planes have their own coordinates and
// triangles interpolate their vertices' uv (`surface`); the others map an entity, seen in a frame:
// `planar` and `solid` are affine; `cylindrical`: u = phi/2pi, v = height; `spherical`: u = theta/pi,
// v = phi/2pi, theta from +axis, phi from +x towards +z; `cube`: the direction, or the place on the
// cube's face. Scale, rotation, offset come last; where the host can fold them in it has, with whole
// tiles taken out. Twin: src/oracle/mapping.rs.
#ifndef MAPPING_GLSL
#define MAPPING_GLSL

#include "footprint.glsl"
#include "math.glsl"

// Whether changes are asked for: by filters, or by the tangents of a normal map.
const bool DERIVATIVES = FILTERED || BUMPED;

// What a map can look at: the entity that its kind projects, the shape's own coordinate, and the
// changes of both over the footprint.
struct Seen {
    vec3 entity;
    vec3 entity_x;
    vec3 entity_y;
    vec2 own;
    vec2 own_x;
    vec2 own_y;
};

// A texture coordinate (u, v, w), or a direction for a cube texture.
struct Coordinate {
    vec3 at;
    vec3 dx;
    vec3 dy;
};

// matrix · uv: scale and rotation. Most scenes neither rotate nor shear.
vec2 turned_uv(Map map, vec2 uv) {
    vec2 mapped;
    if (ROTATED_UV) {
        mapped = vec2(map.matrix.x * uv.x + map.matrix.y * uv.y, map.matrix.w * uv.y + map.matrix.z * uv.x);
    } else {
        mapped = vec2(map.matrix.x * uv.x, map.matrix.w * uv.y);
    }
    return mapped;
}

// matrix · uv + offset.
vec2 placed(Map map, vec2 uv) {
    vec2 mapped = turned_uv(map, uv) + map.offset.xy;
    return mapped;
}

// A coordinate of a map that ends with `placed`.
Coordinate placed_coordinate(Map map, vec2 uv, vec2 dx, vec2 dy) {
    Coordinate c = Coordinate(vec3(placed(map, uv), 0.0), vec3(0.0), vec3(0.0));
    if (DERIVATIVES) {
        c.dx = vec3(turned_uv(map, dx), 0.0);
        c.dy = vec3(turned_uv(map, dy), 0.0);
    }
    return c;
}

// The linear part of the frame.
vec3 in_frame(Map map, vec3 v) { return vec3(dot3(map.x.xyz, v), dot3(map.y.xyz, v), dot3(map.z.xyz, v)); }

// Which face of a cube a direction meets, and where on it, (s, t) in [-1, 1] (Vulkan 1.3, "Cube Map Face
// Selection"; ties go to z, then y). The third number is the length along the face's axis.
vec3 on_cube_face(vec3 d, out uint face) {
    vec3 a = abs(d);
    bool z = a.z >= a.x && a.z >= a.y;
    bool y = !z && a.y >= a.x;
    float major = z ? a.z : (y ? a.y : a.x);
    float along = z ? d.z : (y ? d.y : d.x);
    bool negative = along < 0.0;
    face = (z ? 4u : (y ? 2u : 0u)) + (negative ? 1u : 0u);
    float s = z ? (negative ? -d.x : d.x) : (y ? d.x : (negative ? d.z : -d.z));
    float t = y ? (negative ? -d.z : d.z) : -d.y;
    return vec3(s, t, major);
}

// The same two axes for a change of direction that stays on `face`.
vec3 along_cube_face(vec3 d, uint face) {
    bool negative = (face & 1u) != 0u;
    bool z = face >= 4u;
    bool y = !z && face >= 2u;
    float s = z ? (negative ? -d.x : d.x) : (y ? d.x : (negative ? d.z : -d.z));
    float t = y ? (negative ? -d.z : d.z) : -d.y;
    float along = z ? d.z : (y ? d.y : d.x);
    return vec3(s, t, negative ? -along : along);
}

// Place on a face in [0, 1]², from numerator and axis: (s / major + 1) / 2.
vec2 face_uv(vec3 stm) {
    vec2 uv = 0.5 * (stm.xy / stm.z) + 0.5;
    return uv;
}

// The same of any direction: the cube's centre has none, and NaN is no place.
vec2 within_face(vec3 stm) {
    vec2 uv = face_uv(stm);
    return vec2(uv.x >= 0.0 ? min(uv.x, 1.0) : 0.0, uv.y >= 0.0 ? min(uv.y, 1.0) : 0.0);
}

// Its change: the quotient's derivative.
vec2 face_uv_change(vec3 stm, vec3 change) {
    vec2 uv = 0.5 * (change.xy * stm.z - stm.xy * change.z) / (stm.z * stm.z);
    return uv;
}

// Angles change without bound towards the pole; a footprint never covers more than one turn.
float turn_change(vec3 local, vec3 change, float around) {
    float area = local.x * change.z - local.z * change.x;
    float turn = area / (max(around, 1e-30) * (2.0 * PI));
    return clamp(turn, -1.0, 1.0);
}

// (turn, height) and its change: phi/2pi and y.
Coordinate cylindrical(Map map, vec3 local, vec3 x, vec3 y) {
    float turn = atan2_accurate(local.z, local.x) * (0.5 / PI);
    turn = turn < 0.0 ? turn + 1.0 : turn;
    vec2 dx = vec2(0.0);
    vec2 dy = vec2(0.0);
    if (DERIVATIVES) {
        float around = local.x * local.x + local.z * local.z;
        dx = vec2(turn_change(local, x, around), x.y);
        dy = vec2(turn_change(local, y, around), y.y);
    }
    return placed_coordinate(map, vec2(turn, local.y), dx, dy);
}

// theta / pi changes by (y drho - rho dy) / (rho² + y²), where drho = (x dx + z dz) / rho.
float polar_change(vec3 local, vec3 change, float across, float squared) {
    float outward = (local.x * change.x + local.z * change.z) / max(across, 1e-30);
    return clamp((local.y * outward - across * change.y) / (max(squared, 1e-30) * PI), -1.0, 1.0);
}

// (theta/pi, phi/2pi) and its change.
Coordinate spherical(Map map, vec3 local, vec3 x, vec3 y) {
    float turn = atan2_accurate(local.z, local.x) * (0.5 / PI);
    turn = turn < 0.0 ? turn + 1.0 : turn;
    float around = local.x * local.x + local.z * local.z;
    float across = sqrt(around);
    vec2 uv = vec2(atan2_accurate(across, local.y) * (1.0 / PI), turn);
    vec2 dx = vec2(0.0);
    vec2 dy = vec2(0.0);
    if (DERIVATIVES) {
        float squared = around + local.y * local.y;
        dx = vec2(polar_change(local, x, across, squared), turn_change(local, x, around));
        dy = vec2(polar_change(local, y, across, squared), turn_change(local, y, around));
    }
    return placed_coordinate(map, uv, dx, dy);
}

Coordinate texture_coordinate(Map map, Seen seen) {
    uint kind = map.link.x;
    if (MODE_IS(MAPPINGS, MAP_VERTEX_UV, kind)) {
        return Coordinate(vec3(seen.own, 0.0), vec3(seen.own_x, 0.0), vec3(seen.own_y, 0.0));
    }
    if (MODE_IS(MAPPINGS, MAP_PLANE, kind)) return placed_coordinate(map, seen.own, seen.own_x, seen.own_y);
    vec3 x = vec3(0.0);
    vec3 y = vec3(0.0);
    if (DERIVATIVES) {
        x = in_frame(map, seen.entity_x);
        y = in_frame(map, seen.entity_y);
    }
    vec2 xy = vec2(affine(map.x, seen.entity), affine(map.y, seen.entity));
    if (MODE_IS(MAPPINGS, MAP_AFFINE, kind)) {
        return Coordinate(vec3(xy, 0.0), vec3(x.xy, 0.0), vec3(y.xy, 0.0));
    }
    vec3 local = vec3(xy, affine(map.z, seen.entity));
    if (MODE_IS(MAPPINGS, MAP_SOLID, kind) || MODE_IS(MAPPINGS, MAP_CUBE, kind)) return Coordinate(local, x, y);
    if (MODE_IS(MAPPINGS, MAP_BOX, kind)) {
        uint face;
        vec3 stm = on_cube_face(local, face);
        vec2 dx = vec2(0.0);
        vec2 dy = vec2(0.0);
        if (DERIVATIVES) {
            dx = face_uv_change(stm, along_cube_face(x, face));
            dy = face_uv_change(stm, along_cube_face(y, face));
        }
        return placed_coordinate(map, face_uv(stm), dx, dy);
    }
    if (MODE_IS(MAPPINGS, MAP_CYLINDRICAL, kind)) return cylindrical(map, local, x, y);
    return spherical(map, local, x, y);
}

#endif
