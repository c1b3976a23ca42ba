// Ray against planes, spheres and triangles: the nearest hit with t > 0, or whether anything lies
// between. Shapes are numbered planes first, then spheres, then triangles. Flat shapes never hit
// the ray that left them (`skip`); spheres rely on the offset origin. Twin: src/oracle/intersect.rs.
#ifndef INTERSECT_GLSL
#define INTERSECT_GLSL

#include "camera.glsl"
#include "math.glsl"
#include "survey.glsl"

struct Hit {
    float t; // in units of the direction's length; FAR on a miss
    uint shape;
    // A triangle's edge functions (barycentric weights times their sum), or a plane's own (u, v).
    vec3 local;
};

// Without bounces all rays but shadow rays are camera rays, and those of a perspective start at the
// eye, which is the coordinate origin, where there is no lens and nothing moves.
#ifndef ORIGIN_IS_EYE
#define ORIGIN_IS_EYE (!BOUNCES && !LENS && !TIMED && PROJECTIONS == (1u << PROJECTION_PERSPECTIVE))
#endif

// How far a shape has moved at the ray's time. Shapes are met, and textured, where they are at time 0, by rays
// that start as far back.
vec3 moved_by(Header header, Ray ray, uint shape) {
    vec3 shift = vec3(0.0);
    if (MOTIONS != 0u) {
        if (header.chances.y != 0u) shift = ray.time * motion_at(shape).shift.xyz;
    }
    return shift;
}

Ray at_rest(Header header, Ray ray, uint shape) {
    if (MOTIONS != 0u) ray.origin -= moved_by(header, ray, shape);
    return ray;
}

// t = (n·o' - n·o) / n·d, kept when the point lies within the half extent on both axes.
float plane_distance(Plane plane, Ray ray, bool from_eye, out vec3 local) {
    float slope = dot3(plane.normal.xyz, ray.direction);
    float height = plane.normal.w;
    if (!from_eye) {
        float above = height - dot3(plane.normal.xyz, ray.origin);
        height = above;
    }
    float t = height / slope;
    vec3 p = from_eye ? t * ray.direction : ray.origin + t * ray.direction;
    local = vec3(dot3(plane.axis_u.xyz, p), dot3(plane.axis_v.xyz, p), 0.0);
    if (BOUNDED_PLANES && plane.link.w != 0u) {
        float extent = uintBitsToFloat(plane.link.z);
        vec2 place = local.xy + vec2(plane.axis_u.w, plane.axis_v.w);
        t = abs(place.x) <= extent && abs(place.y) <= extent ? t : -1.0;
    }
    return t;
}

// Haines, Günther & Akenine-Möller 2019: the discriminant from the vector of closest approach, and
// of the two roots c/q and q/a the one that does not cancel.
float sphere_distance(Sphere sphere, Ray ray, bool from_eye) {
    vec3 f = from_eye ? -sphere.ball.xyz : ray.origin - sphere.ball.xyz;
    float radius = sphere.ball.w;
    float a = dot3(ray.direction, ray.direction);
    float b = -dot3(f, ray.direction);
    vec3 closest = f + (b / a) * ray.direction;
    float discriminant = radius * radius - dot3(closest, closest);
    float c = dot3(f, f) - radius * radius;
    float root = sqrt(max(a * discriminant, 0.0));
    float q = b + (b < 0.0 ? -root : root);
    bool small_root = c > 0.0 || b < 0.0;
    float t = (small_root ? c : q) / (small_root ? q : a);
    return discriminant > 0.0 && (c <= 0.0 || b > 0.0) ? t : -1.0;
}

// Edge functions as volumes d·(p × q): the two triangles at a shared edge compute the same value
// with opposite sign, so no ray passes between them. t from the geometric plane.
float triangle_distance(Triangle triangle, Ray ray, bool from_eye, out vec3 edges) {
    vec3 a = from_eye ? triangle.a.xyz : triangle.a.xyz - ray.origin;
    vec3 b = from_eye ? triangle.b.xyz : triangle.b.xyz - ray.origin;
    vec3 c = from_eye ? triangle.c.xyz : triangle.c.xyz - ray.origin;
    edges = vec3(dot3(ray.direction, cross3(b, c)), dot3(ray.direction, cross3(c, a)),
                 dot3(ray.direction, cross3(a, b)));
    bool front = edges.x >= 0.0 && edges.y >= 0.0 && edges.z >= 0.0;
    bool back = edges.x <= 0.0 && edges.y <= 0.0 && edges.z <= 0.0;
    bool degenerate = edges == vec3(0.0);
    float height = triangle.normal.w;
    if (!from_eye) {
        float above = height - dot3(triangle.normal.xyz, ray.origin);
        height = above;
    }
    float t = height / dot3(triangle.normal.xyz, ray.direction);
    return (front || back) && !degenerate ? t : -1.0;
}

// `list`: of the survey's cell in which a camera ray lies, else NO_LIST.
Hit nearest_hit(Header header, Ray ray, uint skip, uint list) {
    Hit hit = Hit(FAR, NO_SHAPE, vec3(0.0));
    uint planes = COUNT(PLANES, header.counts.x);
    uint spheres = COUNT(SPHERES, header.counts.y);
    uint triangles = COUNT(TRIANGLES, header.counts.z);
    for (uint i = 0u; i < planes; i++) {
        vec3 local;
        float t = plane_distance(plane_at(i), at_rest(header, ray, i), ORIGIN_IS_EYE, local);
        bool nearer = t > 0.0 && t < hit.t && i != skip;
        hit.t = nearer ? t : hit.t;
        hit.shape = nearer ? i : hit.shape;
        hit.local = nearer ? local : hit.local;
    }
    for (uint i = 0u; i < spheres; i++) {
        float t = sphere_distance(sphere_at(i), at_rest(header, ray, planes + i), ORIGIN_IS_EYE);
        bool nearer = t > 0.0 && t < hit.t;
        hit.t = nearer ? t : hit.t;
        hit.shape = nearer ? planes + i : hit.shape;
    }
    uint tested = triangles;
    if (SURVEYED) {
        if (list != NO_LIST) tested = survey[list];
    }
    for (uint k = 0u; k < tested; k++) {
        uint i = k;
        if (SURVEYED) {
            if (list != NO_LIST) i = survey[list + 2u + k];
        }
        vec3 edges;
        float t = triangle_distance(triangle_at(i), at_rest(header, ray, planes + spheres + i), ORIGIN_IS_EYE, edges);
        bool nearer = t > 0.0 && t < hit.t && planes + spheres + i != skip;
        hit.t = nearer ? t : hit.t;
        hit.shape = nearer ? planes + spheres + i : hit.shape;
        hit.local = nearer ? edges : hit.local;
    }
    return hit;
}

// True when a shape lies at 0 < t < t_max.
bool occluded(Header header, Ray ray, float t_max, uint skip) {
    bool blocked = false;
    uint planes = COUNT(PLANES, header.counts.x);
    uint spheres = COUNT(SPHERES, header.counts.y);
    uint triangles = COUNT(TRIANGLES, header.counts.z);
    for (uint i = 0u; i < planes; i++) {
        vec3 local;
        float t = plane_distance(plane_at(i), at_rest(header, ray, i), false, local);
        blocked = blocked || (t > 0.0 && t < t_max && i != skip);
    }
    for (uint i = 0u; i < spheres; i++) {
        float t = sphere_distance(sphere_at(i), at_rest(header, ray, planes + i), false);
        blocked = blocked || (t > 0.0 && t < t_max);
    }
    for (uint i = 0u; i < triangles; i++) {
        vec3 edges;
        float t = triangle_distance(triangle_at(i), at_rest(header, ray, planes + spheres + i), false, edges);
        blocked = blocked || (t > 0.0 && t < t_max && planes + spheres + i != skip);
    }
    return blocked;
}

// Wächter & Binder 2019, "A Fast and Robust Method for Avoiding Self-Intersection": the point moved
// along the geometric normal by a number of ulps, by a fixed step near the coordinate origin.
vec3 offset_origin(vec3 p, vec3 n) {
    ivec3 ulps = ivec3(256.0 * n);
    ivec3 bits = floatBitsToInt(p);
    vec3 moved = intBitsToFloat(ivec3(p.x < 0.0 ? bits.x - ulps.x : bits.x + ulps.x,
                                      p.y < 0.0 ? bits.y - ulps.y : bits.y + ulps.y,
                                      p.z < 0.0 ? bits.z - ulps.z : bits.z + ulps.z));
    vec3 near = p + n * (1.0 / 65536.0);
    return mix(moved, near, lessThan(abs(p), vec3(1.0 / 32.0)));
}

#endif
