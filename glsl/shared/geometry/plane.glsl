// Planes, infinite or bounded by a parallelogram. Twin: src/oracle/geometry/plane.rs.
#ifndef PLANE_GLSL
#define PLANE_GLSL

#include "../layout.glsl"

// Material and map.
uvec2 links_of(const Plane plane) { return uvec2(plane.material, plane.uv_projection); }

// Unit normal, and height over the eye.
vec4 plane_of(const Plane plane) { return vec4(plane.normal, plane.distance); }

#ifndef SHAPES_IN_BEAMS
#include "hit.glsl"

// t = (h - n·o) / n·d for the plane n·p = h.
real distance_to_plane(real3 normal, real height, const Ray ray, bool from_eye) {
    real above = height;
    if (!from_eye) {
        above = height - dot3(normal, ray.origin);
    }
    return above / dot3(normal, ray.direction);
}

// Coordinates (u · p, v · p) of the ray's point p at t.
real2 in_plane(real3 u, real3 v, const Ray ray, bool from_eye, real t) {
    real2 local = t * real2(dot3(u, ray.direction), dot3(v, ray.direction));
    if (!from_eye) {
        local += real2(dot3(u, ray.origin), dot3(v, ray.origin));
    }
    return local;
}

// Kept when the point lies within the half extent on both axes.
real distance_to(const Plane plane, const Ray ray, bool from_eye, real most, bool any, inout real2 local) {
    real t = distance_to_plane(plane.normal, plane.distance, ray, from_eye);
    local = in_plane(plane.axis_u, plane.axis_v, ray, from_eye, t);
    if (BOUNDED_PLANES && plane.half_extent >= 0.0) {
        real extent = plane.half_extent;
        real2 place = local + real2(plane.eye_u, plane.eye_v);
        t = abs(place.x) <= extent && abs(place.y) <= extent ? t : -1.0;
    }
    return t;
}

Surface surface_of(const Plane plane, real3 point, real2 uv) {
    return Surface(point, plane.normal, plane.normal, uv, vec3(plane.axis_u), vec3(plane.axis_v), FLAT,
                   0.0, false, links_of(plane), point, largest_part(point), NO_ATTRIBUTES);
}

#endif

#ifdef SHAPES_IN_CONES
#include "../cone.glsl"

// Numerator of the own coordinate row·p + row.w of the place met at u, over facing + s tilt·u.
vec3 own_place(const Cone cone, Flat plane, vec4 row) {
    float start = dot3(row.xyz, cone.ray.origin) + row.w;
    float along = dot3(row.xyz, cone.ray.direction);
    vec2 aside = vec2(dot3(row.xyz, cone.x), dot3(row.xyz, cone.y));
    vec2 tilt = (start * cone.spread - along * cone.width) * plane.tilt;
    tilt += (cone.width * plane.facing + cone.spread * plane.height) * aside;
    return vec3(tilt, start * plane.facing + along * plane.height);
}

// The plane's own coordinate row·p + row.w lies within ±extent.
void cut_bounds(const Cone cone, Flat plane, vec4 row, float extent) {
    vec3 place = own_place(cone, plane, row);
    vec3 limit = extent * vec3(cone.spread * plane.tilt, plane.facing);
    cut_by(limit - place);
    cut_by(limit + place);
}

bool cut_by_shape(const Cone cone, const Plane plane) {
    Flat seen = flat_in(cone, plane.normal, plane.distance);
    cut_by(vec3(-cone.width * seen.tilt, seen.height));
    if (BOUNDED_PLANES && plane.half_extent >= 0.0) {
        // Together they leave nothing above the horizon.
        float extent = plane.half_extent;
        cut_bounds(cone, seen, vec4(plane.axis_u, plane.eye_u), extent);
        cut_bounds(cone, seen, vec4(plane.axis_v, plane.eye_v), extent);
    } else {
        cut_by(vec3(cone.spread * seen.tilt, seen.facing));
    }
    return true;
}

// A hit of a ray within the outline.
void complete(const Plane plane, const Ray ray, inout Hit hit) { distance_to(plane, ray, false, FAR, false, hit.local); }

vec4 tangent_plane(const Plane plane, const Cone cone, float t) { return plane_of(plane); }
#endif

#ifdef SHAPES_IN_BEAMS
#include "../projective.glsl"

bool has_smooth_normals(const Plane plane) { return false; }

// Adds the lines of its bounds.
void add_outline(const Header header, const PixelFrustum frame, vec3 near, const Plane record, inout ConvexRegion region) {
    if (BOUNDED_PLANES && record.half_extent >= 0.0) {
        vec3 extent = record.half_extent * below(header, near);
        vec3 u = along(header, frame, near, vec4(record.axis_u, record.eye_u));
        vec3 v = along(header, frame, near, vec4(record.axis_v, record.eye_v));
        region.lines[1] = extent - u;
        region.lines[2] = extent + u;
        region.lines[3] = extent - v;
        region.lines[4] = extent + v;
        region.count = 5u;
    }
}

// Texture coordinates by a map of its own coordinates, which count from the eye.
RationalMap own_coordinates(const Header header, const PixelFrustum frame, vec3 near, const Plane plane, const UvProjection map) {
    vec3 under = below(header, near);
    vec3 u = along(header, frame, near, vec4(plane.axis_u, 0.0));
    vec3 v = along(header, frame, near, vec4(plane.axis_v, 0.0));
    return RationalMap(map.m00 * u + map.m01 * v + map.offset.x * under,
                       map.m10 * u + map.m11 * v + map.offset.y * under, under);
}

// The lines of its bounds on another surface of this inverse depth, seen from the light. `rise`: of the light before
// the plane, or of a way's length towards it.
void add_shadow(const Header header, const PixelFrustum frame, vec3 near, const Light light, vec4 plane, float rise,
                inout ConvexRegion region, const Plane record) {
    vec3 n = plane.xyz;
    bool point_light = MODE_IS(LIGHT_KINDS, LIGHT_POINT, light.kind);
    vec3 place = point_light ? light.position : light.direction;
    float side = sign(rise);
    if (!BOUNDED_PLANES || record.half_extent < 0.0) return;
    // A place's distance below the light, in |rise|, or its own height.
    vec4 depth = point_light ? side * vec4(n, -dot3(n, place)) : vec4(0.0, 0.0, 0.0, abs(rise));
    vec3 extent = record.half_extent * along(header, frame, near, depth);
    for (uint k = 0u; k < 2u; k++) {
        vec4 row = k == 0u ? vec4(record.axis_u, record.eye_u) : vec4(record.axis_v, record.eye_v);
        float across = dot3(row.xyz, place);
        // u of light + (p - light) rise / (n·(p - light)), times the depth; u of p + way (height -
        // n·p) / rise, times |rise|.
        vec4 own = point_light ? (across + row.w) * depth + abs(rise) * vec4(row.xyz, -across)
                               : abs(rise) * row + (side * across) * vec4(-n, plane.w);
        vec3 across_axis = along(header, frame, near, own);
        region.lines[1u + 2u * k] = extent - across_axis;
        region.lines[2u + 2u * k] = extent + across_axis;
    }
    region.count = 5u;
}

// False where no ray of the polygon can meet the plane.
bool may_meet(const Header header, const PixelFrustum frame, uint polygon, const Plane plane) {
    ConvexRegion region = region_of_plane(header, frame, plane_of(plane));
    add_outline(header, frame, region.inverse_depth, plane, region);
    bool met = true;
    for (uint k = 0u; k < region.count; k++) met = met && range(polygon, region.lines[k]).y > 0.0;
    return met;
}
#endif

#endif
