// Cones (Amanatides 1984); their coverage by shapes is in geometry/cones.glsl. A cone is a bundle of straight
// rays, one for each point u of the unit disc: origin + w (x u.x + y u.y) + t (direction + s (x u.x + y
// u.y)), with w its radius at the origin and s its growth per unit of t. Lines in space are lines on the
// disc, so planes and triangles cut it exactly; a sphere is a circle, seen at its distance. Twin:
// src/oracle/cone.rs.
#ifndef CONE_GLSL
#define CONE_GLSL

#include "coverage.glsl"
#include "footprint.glsl"

// Radius of a disc of area 1, so that a cone has its pixel's area.
const float DISC_RADIUS = 0.56418958;

struct Cone {
    Ray ray;
    vec3 x; // unit, perpendicular to the ray
    vec3 y;
    float width; // radius at the origin
    float spread;
    vec4 floor; // row·(p, 1) is positive above the flat surface that the cone leaves; 0 if there is none
};

const bool FLOORS = BOUNCES || SHADOWS;
// Points that rise above a surface by a smaller relative amount are in its plane.
const float LEVEL = 4e-6;

// Returns a cone around a ray; for the camera's cone, `across` is the direction to the next pixel, otherwise
// 0.
Cone cone_of(const Ray ray, const RayDifferential beam, vec3 across) {
    vec3 unit = ray.direction * inversesqrt(dot3(ray.direction, ray.direction));
    vec3 x = across - dot3(across, unit) * unit;
    float squared = dot3(x, x);
    x = squared > 0.0 ? x * inversesqrt(squared) : any_tangent(unit);
    return Cone(ray, x, cross3(unit, x), DISC_RADIUS * beam.width, DISC_RADIUS * beam.spread, vec4(0.0));
}

// Returns true if the point is above the surface that the cone leaves: half of a disc around a point of a
// surface is below the surface, and would meet the shapes there.
bool rises_to(const Cone cone, vec3 point) {
    return !FLOORS || cone.floor == vec4(0.0) || dot3(cone.floor.xyz, point) + cone.floor.w > 0.0;
}

Ray ray_at(const Cone cone, vec2 u) {
    vec3 aside = u.x * cone.x + u.y * cone.y;
    vec3 origin = cone.ray.origin + cone.width * aside;
    vec3 direction = cone.ray.direction + cone.spread * aside;
    return Ray(origin, direction, 0.0);
}

// A plane in the cone: the ray at u meets it at t = (height - w tilt·u) / (facing + s tilt·u), both positive.
struct Flat {
    float height;
    float facing;
    vec2 tilt;
};

Flat flat_in(const Cone cone, vec3 normal, float height) {
    float above = height - dot3(normal, cone.ray.origin);
    float side = above < 0.0 ? -1.0 : 1.0;
    vec2 tilt = vec2(dot3(normal, cone.x), dot3(normal, cone.y));
    return Flat(side * above, side * dot3(normal, cone.ray.direction), side * tilt);
}

#endif
