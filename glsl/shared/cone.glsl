// A cone (Amanatides 1984); the shapes that it touches: geometry/cones.glsl. A cone is a bundle of straight rays, one for
// each place u of the unit disc: origin + w (x u.x + y u.y) + t (direction + s (x u.x + y u.y)), with w
// its radius at the origin, s the growth of it a unit of t. Lines of space are lines of the disc, so that
// planes and triangles cut it exactly; a sphere is a circle, seen at its distance. Twin: src/oracle/cone.rs.
#ifndef CONE_GLSL
#define CONE_GLSL

#include "coverage.glsl"
#include "footprint.glsl"

// Radius of a disc of area 1: a cone has its pixel's area.
const float DISC_RADIUS = 0.56418958;

struct Cone {
    Ray ray;
    vec3 x; // unit, at right angles to the ray
    vec3 y;
    float width; // radius at the origin
    float spread;
    vec4 floor; // row·(p, 1) is positive above the flat surface that the cone leaves; 0 where it leaves none
};

const bool FLOORS = BOUNCES || SHADOWS;
// What rises above a surface by less, relatively, lies in its plane.
const float LEVEL = 4e-6;

// Around a ray; of the camera's, `across` is the way to the next pixel, else 0.
Cone cone_of(const Ray ray, const RayDifferential beam, vec3 across) {
    vec3 unit = ray.direction * inversesqrt(dot3(ray.direction, ray.direction));
    vec3 x = across - dot3(across, unit) * unit;
    float squared = dot3(x, x);
    x = squared > 0.0 ? x * inversesqrt(squared) : any_tangent(unit);
    return Cone(ray, x, cross3(unit, x), DISC_RADIUS * beam.width, DISC_RADIUS * beam.spread, vec4(0.0));
}

// Half of a disc around a point of a surface lies behind the surface, and would meet what is there.
bool rises_to(const Cone cone, vec3 point) {
    return !FLOORS || cone.floor == vec4(0.0) || dot3(cone.floor.xyz, point) + cone.floor.w > 0.0;
}

Ray ray_at(const Cone cone, vec2 u) {
    vec3 aside = u.x * cone.x + u.y * cone.y;
    vec3 origin = cone.ray.origin + cone.width * aside;
    vec3 direction = cone.ray.direction + cone.spread * aside;
    return Ray(origin, direction, 0.0);
}

// A plane in the cone: the ray at u meets it at t = (height - w tilt·u) / (facing + s tilt·u), both
// positive where it is met.
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
