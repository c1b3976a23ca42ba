// A cone and the shapes that it touches (Amanatides 1984). A cone is a bundle of straight rays, one for
// each place u of the unit disc: origin + w (x u.x + y u.y) + t (direction + s (x u.x + y u.y)), with w
// its radius at the origin, s the growth of it a unit of t. Lines of space are lines of the disc, so that
// planes and triangles cut it exactly; a sphere is a circle, seen at its distance. Twin: src/oracle/cone.rs.
#ifndef CONE_GLSL
#define CONE_GLSL

#include "coverage.glsl"
#include "footprint.glsl"
#include "intersect.glsl"

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
Cone cone_of(Ray ray, RayDifferential beam, vec3 across) {
    vec3 unit = ray.direction * inversesqrt(dot3(ray.direction, ray.direction));
    vec3 x = across - dot3(across, unit) * unit;
    float squared = dot3(x, x);
    x = squared > 0.0 ? x * inversesqrt(squared) : any_tangent(unit);
    return Cone(ray, x, cross3(unit, x), DISC_RADIUS * beam.width, DISC_RADIUS * beam.spread, vec4(0.0));
}

// The same cone, which leaves a shape.
Cone leaving(Header header, Cone cone, uint shape) {
    if (!FLOORS || shape == NO_SHAPE) return cone;
    uint planes = COUNT(PLANES, header.counts.x);
    uint spheres = COUNT(SPHERES, header.counts.y);
    uint triangles = COUNT(TRIANGLES, header.counts.z);
    vec3 up = vec3(0.0);
    if (planes > 0u && (spheres + triangles == 0u || shape < planes)) {
        up = plane_at(shape).normal.xyz;
    } else if (triangles > 0u && (spheres == 0u || shape >= planes + spheres)) {
        up = triangle_at(shape - planes - spheres).normal.xyz;
    } else {
        return cone;
    }
    Ray ray = cone.ray;
    if (dot3(up, ray.direction) < 0.0) up = -up;
    float level = LEVEL * max(abs(ray.origin.x), max(abs(ray.origin.y), abs(ray.origin.z)));
    cone.floor = vec4(up, -(dot3(up, ray.origin) + level));
    return cone;
}

// Half of a disc around a point of a surface lies behind the surface, and would meet what is there.
bool rises_to(Cone cone, vec3 point) {
    return !FLOORS || cone.floor == vec4(0.0) || dot3(cone.floor.xyz, point) + cone.floor.w > 0.0;
}

Ray ray_at(Cone cone, vec2 u) {
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

Flat flat_in(Cone cone, vec3 normal, float height) {
    float above = height - dot3(normal, cone.ray.origin);
    float side = above < 0.0 ? -1.0 : 1.0;
    vec2 tilt = vec2(dot3(normal, cone.x), dot3(normal, cone.y));
    return Flat(side * above, side * dot3(normal, cone.ray.direction), side * tilt);
}

// The plane's own coordinate row·p + row.w lies within ±extent.
void cut_bounds(Cone cone, Flat plane, vec4 row, float extent) {
    float start = dot3(row.xyz, cone.ray.origin) + row.w;
    float along = dot3(row.xyz, cone.ray.direction);
    vec2 aside = vec2(dot3(row.xyz, cone.x), dot3(row.xyz, cone.y));
    vec2 tilt = (start * cone.spread - along * cone.width) * plane.tilt;
    tilt += (cone.width * plane.facing + cone.spread * plane.height) * aside;
    vec3 place = vec3(tilt, start * plane.facing + along * plane.height);
    vec3 limit = extent * vec3(cone.spread * plane.tilt, plane.facing);
    cut_by(limit - place);
    cut_by(limit + place);
}

void cut_plane(Cone cone, Plane plane) {
    Flat seen = flat_in(cone, plane.normal.xyz, plane.normal.w);
    cut_by(vec3(-cone.width * seen.tilt, seen.height));
    if (BOUNDED_PLANES && plane.link.w != 0u) {
        // Together they leave nothing above the horizon.
        float extent = REAL_BITS(plane.link.zw);
        cut_bounds(cone, seen, plane.axis_u, extent);
        cut_bounds(cone, seen, plane.axis_v, extent);
    } else {
        cut_by(vec3(cone.spread * seen.tilt, seen.facing));
    }
}

// A point as a place of the disc, homogeneous.
vec3 in_disc(Cone cone, vec3 point) {
    vec3 p = point - cone.ray.origin;
    float t = dot3(cone.ray.direction, p) / dot3(cone.ray.direction, cone.ray.direction);
    return vec3(dot3(cone.x, p), dot3(cone.y, p), cone.width + cone.spread * t);
}

// Two triangles at a shared edge get the same line with opposite sign.
void cut_triangle(Cone cone, Triangle triangle) {
    vec3 a = in_disc(cone, triangle.a.xyz);
    vec3 b = in_disc(cone, triangle.b.xyz);
    vec3 c = in_disc(cone, triangle.c.xyz);
    float height = triangle.normal.w - dot3(triangle.normal.xyz, cone.ray.origin);
    float side = height < 0.0 ? -1.0 : 1.0;
    vec2 tilt = vec2(dot3(triangle.normal.xyz, cone.x), dot3(triangle.normal.xyz, cone.y));
    cut_by(vec3((-side * cone.width) * tilt, side * height));
    cut_by(side * cross3(a, b));
    cut_by(side * cross3(b, c));
    cut_by(side * cross3(c, a));
}

// A sphere as a circle of the disc.
struct Circle {
    vec2 middle;
    float radius;
    float edge; // the radius less the middle's distance; 1 and more covers the disc
};

Circle circle_of(Cone cone, Sphere sphere) {
    vec3 f = cone.ray.origin - sphere.ball.xyz;
    float radius = sphere.ball.w;
    float t = -dot3(f, cone.ray.direction) / dot3(cone.ray.direction, cone.ray.direction);
    // From the inside it is all around, from behind nowhere.
    if (dot3(f, f) <= radius * radius) return Circle(vec2(0.0), 1e6, 1e6);
    if (!(t > 0.0)) return Circle(vec2(0.0), 1.0, -2.0);
    vec3 closest = f + t * cone.ray.direction;
    float reach = cone.width + cone.spread * t;
    float scale = 1.0 / (reach < 0.0 ? min(reach, -1e-20) : max(reach, 1e-20));
    vec2 middle = vec2(dot3(cone.x, closest), dot3(cone.y, closest)) * -scale;
    float apart = sqrt(dot3(closest, closest));
    return Circle(middle, radius * abs(scale), (radius - apart) * abs(scale));
}

// Cuts the disc to what the shape covers; false for a ball that no line stands for: smaller than the cone.
bool cut_shape(Header header, Cone cone, uint shape) {
    uint planes = COUNT(PLANES, header.counts.x);
    uint spheres = COUNT(SPHERES, header.counts.y);
    uint triangles = COUNT(TRIANGLES, header.counts.z);
    if (planes > 0u && (spheres + triangles == 0u || shape < planes)) {
        cut_plane(cone, plane_at(shape));
    } else if (spheres > 0u && (triangles == 0u || shape < planes + spheres)) {
        Circle circle = circle_of(cone, sphere_at(shape - planes));
        cut_by(circle_line(circle.middle, circle.radius, circle.edge));
        return circle.radius >= 1.0;
    } else if (triangles > 0u) {
        cut_triangle(cone, triangle_at(shape - planes - spheres));
    }
    return true;
}

// What the shape covers.
Covered covered_by(Header header, Cone cone, uint shape) {
    uint planes = COUNT(PLANES, header.counts.x);
    uint spheres = COUNT(SPHERES, header.counts.y);
    uint triangles = COUNT(TRIANGLES, header.counts.z);
    if (spheres > 0u && shape >= planes && shape < planes + spheres) {
        Circle circle = circle_of(cone, sphere_at(shape - planes));
        return ball_overlap(circle.middle, circle.radius, circle.edge);
    }
    if (planes + triangles == 0u) return NOTHING;
    whole_disc();
    cut_shape(header, cone, shape);
    return cut_disc();
}

// Where a ray within the shape's outline meets it; rounding may have put it just beside.
Hit meet(Header header, Ray ray, uint shape) {
    uint planes = COUNT(PLANES, header.counts.x);
    uint spheres = COUNT(SPHERES, header.counts.y);
    uint triangles = COUNT(TRIANGLES, header.counts.z);
    Hit hit = Hit(-1.0, shape, vec2(0.0));
    vec4 plane = vec4(0.0);
    if (planes > 0u && (spheres + triangles == 0u || shape < planes)) {
        Plane found = plane_at(shape);
        plane = found.normal;
        plane_distance(found, ray, false, hit.local);
    } else if (spheres > 0u && (triangles == 0u || shape < planes + spheres)) {
        Sphere sphere = sphere_at(shape - planes);
        hit.t = sphere_distance(sphere, ray, false);
        float nearest = dot3(sphere.ball.xyz - ray.origin, ray.direction) / dot3(ray.direction, ray.direction);
        hit.t = hit.t > 0.0 ? hit.t : nearest;
        return hit;
    } else if (triangles > 0u) {
        plane = triangle_at(shape - planes - spheres).normal;
    }
    float above = plane.w - dot3(plane.xyz, ray.origin);
    hit.t = above / dot3(plane.xyz, ray.direction);
    return hit;
}

#endif
