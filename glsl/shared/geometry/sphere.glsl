// Spheres. Beams do not know their outline: they ask only whether one may lie in the way. Twin:
// src/oracle/geometry/sphere.rs.
#ifndef SPHERE_GLSL
#define SPHERE_GLSL

#include "../layout.glsl"

// Material and map.
uvec2 links_of(const Sphere sphere) { return uvec2(sphere.material, sphere.uv_projection); }

#ifndef SHAPES_IN_BEAMS
#include "hit.glsl"

// Haines, Günther & Akenine-Möller 2019: the discriminant from the vector of closest approach, and
// of the two roots c/q and q/a the one that does not cancel.
real distance_to(const Sphere sphere, const Ray ray, bool from_eye, real most, bool any, inout real2 local) {
    real3 f = from_eye ? -sphere.center : ray.origin - sphere.center;
    real radius = sphere.radius;
    real a = dot3(ray.direction, ray.direction);
    real b = -dot3(f, ray.direction);
    real3 closest = f + (b / a) * ray.direction;
    real discriminant = radius * radius - dot3(closest, closest);
    real c = dot3(f, f) - radius * radius;
    real root = sqrt(max(a * discriminant, 0.0));
    real q = b + (b < 0.0 ? -root : root);
    bool small_root = c > 0.0 || b < 0.0;
    real t = (small_root ? c : q) / (small_root ? q : a);
    return discriminant > 0.0 && (c <= 0.0 || b > 0.0) ? t : -1.0;
}

// The hit is put back on the sphere: the error of t does not reach the normal or the next ray.
Surface surface_of(const Sphere sphere, real3 point, real2 uv) {
    real3 radial = point - sphere.center;
    real scale = inverse_root(dot3(radial, radial));
    real3 normal = radial * scale;
    real3 on_sphere = sphere.center + sphere.radius * normal;
    float curvature = 1.0 / float(sphere.radius);
    real size = largest_part(sphere.center) + sphere.radius;
    return Surface(on_sphere, normal, normal, real2(0.0), vec3(0.0), vec3(0.0), mat3(curvature), curvature,
                   false, links_of(sphere), on_sphere, size, NO_ATTRIBUTES);
}

#endif

#ifdef SHAPES_IN_CONES
#include "../cone.glsl"

// A shape as a circle of the disc.
struct Circle {
    vec2 middle;
    float radius;
    float edge; // the radius less the middle's distance; 1 and more covers the disc
};

Circle circle_of(const Cone cone, const Sphere sphere) {
    vec3 f = cone.ray.origin - sphere.center;
    float radius = sphere.radius;
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

// False for a ball that no line stands for: smaller than the cone.
bool cut_by_shape(const Cone cone, const Sphere sphere) {
    Circle circle = circle_of(cone, sphere);
    cut_by(circle_line(circle.middle, circle.radius, circle.edge));
    return circle.radius >= 1.0;
}

Covered covered_by(const Cone cone, const Sphere sphere) {
    Circle circle = circle_of(cone, sphere);
    return ball_overlap(circle.middle, circle.radius, circle.edge);
}

bool touched(const Cone cone, const Sphere sphere) {
    Circle circle = circle_of(cone, sphere);
    vec2 apart = abs(circle.middle);
    bool reaches = max(apart.x, apart.y) < SQUARE * (1.0 + circle.radius);
    return circle.edge > -1.0 || (circle.radius < 1.0 && reaches);
}

// A hit of a ray within the outline; rounding may have put it just beside.
void complete(const Sphere sphere, const Ray ray, inout Hit hit) {
    hit.t = distance_to(sphere, ray, false, FAR, false, hit.local);
    float nearest = dot3(sphere.center - ray.origin, ray.direction) / dot3(ray.direction, ray.direction);
    hit.t = hit.t > 0.0 ? hit.t : nearest;
}

// The plane that touches it at t.
vec4 tangent_plane(const Sphere sphere, const Cone cone, float t) {
    vec3 out_of = (cone.ray.origin + t * cone.ray.direction) - sphere.center;
    vec3 normal = out_of * inversesqrt(dot3(out_of, out_of));
    float height = dot3(normal, sphere.center) + sphere.radius;
    return vec4(normal, height);
}
#endif

#ifdef SHAPES_IN_BEAMS
#include "../projective.glsl"

// False where no ray of the polygon can meet the sphere.
bool may_meet(const Header header, const PixelFrustum frame, uint polygon, const Sphere sphere) {
    vec3 way;
    vec3 origin;
    ray_at(header, frame, middle(polygon), way, origin);
    vec3 unit = way * inversesqrt(dot3(way, way));
    vec3 to = sphere.center - origin;
    float radius = sphere.radius;
    float ahead = dot3(to, unit);
    if (dot3(to, to) <= radius * radius) return true;
    if (ahead <= -radius) return false;
    // The tangent of the widest angle to a corner, or the farthest of the parallel rays.
    float wide = 0.0;
    bool parallel = is_parallel(header);
    for (uint k = 0u; k < counts[polygon]; k++) {
        vec3 w;
        vec3 o;
        ray_at(header, frame, corner(polygon, k), w, o);
        vec3 apart = parallel ? o - origin : cross3(w, unit);
        wide = max(wide, sqrt(dot3(apart, apart)) / (parallel ? 1.0 : dot3(w, unit)));
    }
    vec3 aside = to - ahead * unit;
    float reach = parallel ? radius + wide : radius * sqrt(1.0 + wide * wide) + max(ahead, 0.0) * wide;
    return sqrt(dot3(aside, aside)) <= 1.0001 * reach;
}

// False where no way from the fragment to the light can pass the sphere.
bool may_shade(const Header header, const PixelFrustum frame, vec3 near, uint polygon, const Light light, const Sphere sphere) {
    vec3 from = point_at(header, frame, near, middle(polygon));
    float wide = 0.0;
    for (uint k = 0u; k < counts[polygon]; k++) {
        vec3 apart = point_at(header, frame, near, corner(polygon, k)) - from;
        wide = max(wide, sqrt(dot3(apart, apart)));
    }
    bool point_light = MODE_IS(LIGHT_KINDS, LIGHT_POINT, light.kind);
    vec3 way = point_light ? light.position - from : light.direction;
    vec3 to = sphere.center - from;
    float ahead = max(dot3(to, way) / dot3(way, way), 0.0);
    vec3 aside = to - (point_light ? min(ahead, 1.0) : ahead) * way;
    // NaN counts as true.
    return !(sqrt(dot3(aside, aside)) > sphere.radius + wide);
}
#endif

#endif
