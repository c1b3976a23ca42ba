// The width of a ray: the extent of a sample's share of the pixel, at its origin and along it, on the surface
// that it hits, and after reflection or refraction. Differentials (Igehy 1999) have two vectors each of
// origin and direction; a cone (Amanatides 1984; Akenine-Möller et al. 2021) a width and a spread. Both give
// two vectors on the surface, full widths, which are the input of filters. Twin: src/oracle/footprint.rs.
#ifndef FOOTPRINT_GLSL
#define FOOTPRINT_GLSL

#include "camera.glsl"
#include "diagnostics.glsl"
#include "math.glsl"

const bool FILTERED = FOOTPRINTS != (1u << FOOTPRINT_NONE);
const bool CONES = HAS(FOOTPRINTS, FOOTPRINT_CONE);
const bool DIFFERENTIALS = HAS(FOOTPRINTS, FOOTPRINT_DIFFERENTIALS);

struct RayDifferential {
    vec3 origin_x; // change of the ray's origin over the share of the pixel, to the right and down
    vec3 origin_y;
    vec3 direction_x;
    vec3 direction_y;
    float width;  // width of the cone at the origin
    float spread; // growth of the width per unit of t; negative if it converges
};

// The footprint of a ray differential on a surface: changes of the point and of the direction.
struct Footprint {
    vec3 point_x;
    vec3 point_y;
    vec3 direction_x;
    vec3 direction_y;
};

const Footprint NO_FOOTPRINT = Footprint(vec3(0.0), vec3(0.0), vec3(0.0), vec3(0.0));

bool uses_cones(const Header header) { return MODE_IS(FOOTPRINTS, FOOTPRINT_CONE, header.footprint); }

// Returns the camera's ray differential. `share` is the side of the part of a pixel that one sample
// represents: that of a box with the pixel filter's variance over √samples.
RayDifferential camera_differential(const Header header, const Ray ray) {
    RayDifferential beam = RayDifferential(vec3(0.0), vec3(0.0), vec3(0.0), vec3(0.0), 0.0, 0.0);
    if (!FILTERED || MODE_IS(FOOTPRINTS, FOOTPRINT_NONE, header.footprint)) return beam;
    bool orthographic = MODE_IS(PROJECTIONS, PROJECTION_ORTHOGRAPHIC, header.projection);
    float share = float(header.sample_side);
    if (DIFFERENTIALS) {
        vec3 x = vec3(header.step_x) * share;
        vec3 y = vec3(header.step_y) * share;
        beam.origin_x = orthographic ? x : vec3(0.0);
        beam.origin_y = orthographic ? y : vec3(0.0);
        beam.direction_x = orthographic ? vec3(0.0) : x;
        beam.direction_y = orthographic ? vec3(0.0) : y;
    }
    if (CONES) {
        float side = float(header.pixel_side) * share; // side of the pixel's share at t = 1
        // A pixel off the axis is foreshortened by the cosine in one direction: the cone has the square root
        // of that, and so the same cross-section.
        beam.width = orthographic ? side : 0.0;
        beam.spread = orthographic ? 0.0 : side * inversesqrt(sqrt(float(dot3(ray.direction, ray.direction))));
    }
    return beam;
}

// Transforms v from the frame around +z to one around the unit vector n.
vec3 around(vec3 n, vec3 v) {
    vec3 tangent = any_tangent(n);
    vec3 bitangent = cross3(n, tangent);
    vec3 turned = (v.x * tangent + v.y * bitangent) + v.z * n;
    return turned;
}

// Grazing footprints are truncated at this value of 1 / cos.
const float MAX_STRETCH = 65536.0;

// Returns the footprint around the point origin + t direction with unit normal n.
Footprint footprint_at(const Header header, const RayDifferential beam, const Ray ray, real distance, real3 normal) {
    Footprint print = NO_FOOTPRINT;
    if (!FILTERED) return print;
    vec3 n = vec3(normal);
    vec3 direction = vec3(ray.direction);
    float t = float(distance);
    float facing = float(dot3(normal, ray.direction));
    float squared = dot3(direction, direction);
    float least = sqrt(squared) / MAX_STRETCH;
    count_diagnostic(DIAGNOSTIC_GRAZING, abs(facing) < least);
    facing = abs(facing) < least ? (facing < 0.0 ? -least : least) : facing;
    if (DIFFERENTIALS && (!CONES || !uses_cones(header))) {
        vec3 x = beam.origin_x + t * beam.direction_x;
        vec3 y = beam.origin_y + t * beam.direction_y;
        vec3 on_x = x - (dot3(n, x) / facing) * direction;
        vec3 on_y = y - (dot3(n, y) / facing) * direction;
        return Footprint(on_x, on_y, beam.direction_x, beam.direction_y);
    }
    if (CONES) {
        float width = abs(beam.width + beam.spread * t);
        float scale = inversesqrt(squared);
        vec3 d = direction * scale;
        vec3 across = cross3(n, d); // its length is the sine of the angle of incidence
        float sine = sqrt(dot3(across, across));
        // At normal incidence all directions across are equivalent.
        vec3 minor = sine > 1e-4 ? across / sine : any_tangent(n);
        vec3 major = cross3(minor, n);
        vec3 turned = cross3(d, minor);
        float stretch = sqrt(squared) / abs(facing);
        print.point_x = minor * width;
        print.point_y = major * (width * stretch);
        print.direction_x = minor * beam.spread;
        print.direction_y = turned * beam.spread;
    }
    return print;
}

// Returns the footprint of a ray that escapes the scene: only the change of its direction matters.
Footprint endless_footprint(const Header header, const RayDifferential beam, const Ray ray) {
    if (!FILTERED) return NO_FOOTPRINT;
    if (DIFFERENTIALS && (!CONES || !uses_cones(header))) {
        return Footprint(vec3(0.0), vec3(0.0), beam.direction_x, beam.direction_y);
    }
    vec3 direction = vec3(ray.direction);
    vec3 d = direction * inversesqrt(dot3(direction, direction));
    vec3 side = any_tangent(d);
    return Footprint(vec3(0.0), vec3(0.0), side * beam.spread, cross3(d, side) * beam.spread);
}

// Returns the change of the mirrored direction d - 2 (d·n) n, given the change of the normal.
vec3 mirrored_change(vec3 direction, vec3 n, vec3 change, vec3 normal_change) {
    float d = dot3(direction, n);
    float d_change = dot3(change, n) + dot3(direction, normal_change);
    vec3 result = change - 2.0 * (d * normal_change + d_change * n);
    return result;
}

// Returns shape_operator · v, summed in a fixed order.
vec3 normal_change(mat3 shape_operator, vec3 v) {
    vec3 change = (shape_operator[0] * v.x + shape_operator[1] * v.y) + shape_operator[2] * v.z;
    return change;
}

// Returns the ray differential after reflection. `shape_operator` is the change of the unit normal per unit
// of distance along the surface; a cone uses its mean, the curvature.
RayDifferential reflected_differential(const RayDifferential beam, const Ray ray, real distance, const Footprint print, real3 normal, mat3 shape_operator,
                   float curvature) {
    if (!FILTERED) return beam;
    vec3 n = vec3(normal);
    vec3 direction = vec3(ray.direction);
    float t = float(distance);
    RayDifferential next = beam;
    if (DIFFERENTIALS) {
        next.origin_x = print.point_x;
        next.origin_y = print.point_y;
        next.direction_x = mirrored_change(direction, n, print.direction_x, normal_change(shape_operator, print.point_x));
        next.direction_y = mirrored_change(direction, n, print.direction_y, normal_change(shape_operator, print.point_y));
    }
    if (CONES) {
        float width = beam.width + beam.spread * t;
        float spread = beam.spread + 2.0 * curvature * width * sqrt(dot3(direction, direction));
        next.width = width;
        next.spread = spread;
    }
    return next;
}

// Returns the change of the refracted direction r d - (r d·n + k) n with k² = d² - r² (d² - (d·n)²).
vec3 refracted_change(vec3 direction, vec3 n, float ratio, vec3 change, vec3 normal_change) {
    float along = dot3(direction, n);
    float along_change = dot3(change, n) + dot3(direction, normal_change);
    float rr = ratio * ratio;
    float squared = dot3(direction, direction);
    float k = sqrt(max(squared - rr * (squared - along * along), 1e-6 * squared));
    float k_change = ((1.0 - rr) * dot3(direction, change) + rr * along * along_change) / k;
    vec3 result = ratio * change - (ratio * along + k) * normal_change - (ratio * along_change + k_change) * n;
    return result;
}

// Returns the ray differential after refraction. A cone's width preserves the area of the refracted ellipse.
RayDifferential refracted_differential(const RayDifferential beam, const Ray ray, real distance, const Footprint print, real3 normal, mat3 shape_operator,
                    float curvature, float ratio) {
    if (!FILTERED) return beam;
    vec3 n = vec3(normal);
    vec3 direction = vec3(ray.direction);
    float t = float(distance);
    RayDifferential next = beam;
    if (DIFFERENTIALS) {
        next.origin_x = print.point_x;
        next.origin_y = print.point_y;
        next.direction_x = refracted_change(direction, n, ratio, print.direction_x, normal_change(shape_operator, print.point_x));
        next.direction_y = refracted_change(direction, n, ratio, print.direction_y, normal_change(shape_operator, print.point_y));
    }
    if (CONES) {
        float size = sqrt(dot3(direction, direction));
        float before = min(abs(dot3(direction, n)) / size, 1.0);
        float behind = sqrt(max(1.0 - ratio * ratio * (1.0 - before * before), 1e-6));
        float squeeze = sqrt(behind / max(before, 1e-6));
        float width = (beam.width + beam.spread * t) * squeeze;
        float spread = beam.spread * (ratio / squeeze) + (ratio * before - behind) * curvature * width * size;
        next.width = width;
        next.spread = spread;
    }
    return next;
}

#endif
