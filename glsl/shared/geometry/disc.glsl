// Discs. A disc is a unit circle in its own coordinates, which are quotients of affine functions of a place in a cone or
// a beam; beams know no outline of it and ask only whether it may lie in the way. Twin: src/oracle/geometry/disc.rs.
#ifndef DISC_GLSL
#define DISC_GLSL

#include "plane.glsl"
#include "sphere.glsl"

// Material and map.
uvec2 links_of(const Disc disc) { return uvec2(disc.material, disc.uv_projection); }

// Unit normal, and height over the eye.
vec4 plane_of(const Disc disc) { return vec4(disc.normal, disc.distance); }

// An own coordinate as an affine function.
vec4 own_row(const Disc disc, vec3 axis) { return vec4(axis, -dot3(axis, vec3(disc.center))); }

#ifndef SHAPES_IN_BEAMS
#include "hit.glsl"

// Kept when the own coordinates of the point lie within the unit circle.
real distance_to(const Disc disc, const Ray ray, bool from_eye, real most, bool any, inout real2 local) {
    real t = distance_to_plane(disc.normal, disc.distance, ray, from_eye);
    real3 p = from_eye ? t * ray.direction : ray.origin + t * ray.direction;
    real3 own = p - disc.center;
    local = real2(dot3(disc.axis_u, own), dot3(disc.axis_v, own));
    real squared = local.x * local.x + local.y * local.y;
    return squared <= 1.0 ? t : -1.0;
}

// Planar: the square around the disc is the texture. Polar: u = phi/2pi, v = distance from the centre over the radius.
// At the centre the angle has no gradient; near it a footprint counts as no nearer than CENTER radii.
Surface surface_of(const Disc disc, real3 point, real2 local) {
    const float CENTER = 1e-6;
    vec3 axis_u = vec3(disc.axis_u);
    vec3 axis_v = vec3(disc.axis_v);
    real2 uv = 0.5 * local + 0.5;
    vec3 own_u = 0.5 * axis_u;
    vec3 own_v = 0.5 * axis_v;
    if (disc.is_polar) {
        real turn = atan2_accurate(local.y, local.x) * (0.5 / REAL_PI);
        real across = sqrt(local.x * local.x + local.y * local.y);
        uv = real2(turn < 0.0 ? turn + 1.0 : turn, across);
        float outward = max(float(across), CENTER);
        vec2 unit = vec2(local) / outward;
        own_u = (unit.x * axis_v - unit.y * axis_u) / (2.0 * PI * outward);
        own_v = unit.x * axis_u + unit.y * axis_v;
    }
    return Surface(point, disc.normal, disc.normal, uv, own_u, own_v, FLAT, 0.0, false, links_of(disc), point,
                   largest_part(point), NO_ATTRIBUTES);
}

#endif

#ifdef SHAPES_IN_CONES
#include "../cone.glsl"

// A disc in the cone: the own coordinates of the place met at u are (x·(u, 1), y·(u, 1)) / w·(u, 1), so that its
// outline is a conic. Where that is about round or no end of it is near, it is the circle; where it is a strip across
// the cone, lines.
struct Conic {
    Circle circle;
    bool is_strip;
    bool has_lines;
    vec3 front; // positive where the plane lies before the cone
    vec3 w;
    vec3 across; // numerator of the own coordinate along which the strip is thin
    vec3 tangent; // of the outline at the point radially outwards of the axis
};

Conic conic_of(const Cone cone, const Disc disc) {
    Flat seen = flat_in(cone, disc.normal, disc.distance);
    vec3 x = own_place(cone, seen, own_row(disc, disc.axis_u));
    vec3 y = own_place(cone, seen, own_row(disc, disc.axis_v));
    vec3 w = vec3(cone.spread * seen.tilt, seen.facing);
    vec3 front = vec3(-cone.width * seen.tilt, seen.height);
    // The centre, and squares of the inverse semi-axes times the denominator there.
    float area = x.x * y.y - x.y * y.x;
    float divisor = area == 0.0 ? 1e-30 : area;
    vec2 middle = vec2(x.y * y.z - y.y * x.z, y.x * x.z - x.x * y.z) / divisor;
    float under = dot2(w.xy, middle) + w.z;
    float a = dot2(x.xy, x.xy);
    float b = dot2(x.xy, y.xy);
    float c = dot2(y.xy, y.xy);
    float mean = 0.5 * (a + c);
    float apart = sqrt(0.25 * (a - c) * (a - c) + b * b);
    vec2 thin = a >= c ? vec2(mean + apart - c, b) : vec2(b, mean + apart - a);
    float squared = dot2(thin, thin);
    thin = squared > 0.0 ? thin * inversesqrt(squared) : vec2(1.0, 0.0);
    // The longer semi-axis is at least 1 and twice the shorter one, which is at most 2.
    bool is_long = mean - apart <= under * under && 5.0 * apart >= 3.0 * mean && 4.0 * (mean + apart) >= under * under;
    bool is_strip = !(under > 0.0) || is_long;
    float distance = sqrt(x.z * x.z + y.z * y.z);
    vec2 outward = distance > 0.0 ? vec2(x.z, y.z) / (w.z < 0.0 ? -distance : distance) : vec2(1.0, 0.0);
    vec3 tangent = w - outward.x * x - outward.y * y;
    float radius = under * inversesqrt(abs(divisor));
    float edge = radius - sqrt(dot2(middle, middle));
    if (radius >= 2.0) {
        float scale = inversesqrt(max(dot2(tangent.xy, tangent.xy), 1e-30));
        edge = tangent.z * scale;
        middle = (radius - edge) * scale * tangent.xy;
    }
    return Conic(Circle(middle, radius, edge), is_strip, is_strip || radius >= 1.0, front, w, thin.x * x + thin.y * y,
                 tangent);
}

// Cuts the disc of the cone by the lines of a strip, or by a line that leaves about as much as the circle.
void cut_by_conic(const Conic conic) {
    if (!conic.is_strip) {
        cut_by(circle_line(conic.circle.middle, conic.circle.radius, conic.circle.edge));
        return;
    }
    cut_by(conic.front);
    cut_by(conic.w);
    cut_by(conic.w - conic.across);
    cut_by(conic.w + conic.across);
    cut_by(conic.tangent);
}

// False for a disc that no line stands for: smaller than the cone.
bool cut_by_shape(const Cone cone, const Disc disc) {
    Conic conic = conic_of(cone, disc);
    cut_by_conic(conic);
    return conic.has_lines;
}

Covered covered_by(const Cone cone, const Disc disc) {
    Conic conic = conic_of(cone, disc);
    if (!conic.is_strip) return ball_overlap(conic.circle.middle, conic.circle.radius, conic.circle.edge);
    whole_disc();
    cut_by_conic(conic);
    return cut_disc();
}

// True if the cone may touch the square around the disc.
bool touched(const Cone cone, const Disc disc) {
    Flat seen = flat_in(cone, disc.normal, disc.distance);
    whole_disc();
    cut_by(vec3(-cone.width * seen.tilt, seen.height));
    cut_bounds(cone, seen, own_row(disc, disc.axis_u), 1.0);
    cut_bounds(cone, seen, own_row(disc, disc.axis_v), 1.0);
    return !cut_away;
}

// A hit of a ray within the outline; rounding may have put it just beside.
void complete(const Disc disc, const Ray ray, inout Hit hit) { distance_to(disc, ray, false, FAR, false, hit.local); }

vec4 tangent_plane(const Disc disc, const Cone cone, float t) { return plane_of(disc); }
#endif

#ifdef SHAPES_IN_BEAMS
#include "../projective.glsl"

// False where no ray of the polygon can meet the square around the disc.
bool may_meet(const Header header, const PixelFrustum frame, uint polygon, const Disc disc) {
    ConvexRegion region = region_of_plane(header, frame, plane_of(disc));
    vec3 under = below(header, region.inverse_depth);
    vec3 u = along(header, frame, region.inverse_depth, own_row(disc, disc.axis_u));
    vec3 v = along(header, frame, region.inverse_depth, own_row(disc, disc.axis_v));
    bool met = range(polygon, under - u).y > 0.0 && range(polygon, under + u).y > 0.0 &&
               range(polygon, under - v).y > 0.0 && range(polygon, under + v).y > 0.0;
    for (uint k = 0u; k < region.count; k++) met = met && range(polygon, region.lines[k]).y > 0.0;
    return met;
}

// False where no way from the fragment to the light can pass the sphere around the disc.
bool may_shade(const Header header, const PixelFrustum frame, vec3 near, uint polygon, const Light light, const Disc disc) {
    return may_shade(header, frame, near, polygon, light, Sphere(disc.center, disc.radius, 0u, 0u));
}
#endif

#endif
