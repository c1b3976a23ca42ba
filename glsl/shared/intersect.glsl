// Ray against planes, spheres and triangles: the nearest hit with t > 0, or whether anything lies
// between. Shapes are numbered planes first, then spheres, then triangles. Flat shapes never hit
// the ray that left them (`skip`); spheres rely on the offset origin. Twin: src/oracle/intersect.rs.
#ifndef INTERSECT_GLSL
#define INTERSECT_GLSL

#include "camera.glsl"
#include "math.glsl"
#include "tile_culling.glsl"

struct Hit {
    real t; // in units of the direction's length; FAR on a miss
    uint shape;
    real2 local; // a plane's own (u, v)
};

// Without bounces all rays but shadow rays are camera rays, and those of a perspective start at the
// eye, which is the coordinate origin, where there is no lens and nothing moves.
#ifndef ORIGIN_IS_EYE
#define ORIGIN_IS_EYE (!BOUNCES && !LENS && !TIMED && PROJECTIONS == (1u << PROJECTION_PERSPECTIVE))
#endif

// How far a shape has moved at the ray's time. Shapes are met, and textured, where they are at time 0, by rays
// that start as far back.
real3 moved_by(Header header, Ray ray, uint shape) {
    real3 shift = real3(0.0);
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
real plane_distance(Plane plane, Ray ray, bool from_eye, out real2 local) {
    real slope = dot3(plane.normal.xyz, ray.direction);
    real height = plane.normal.w;
    if (!from_eye) {
        real above = height - dot3(plane.normal.xyz, ray.origin);
        height = above;
    }
    real t = height / slope;
    real3 p = from_eye ? t * ray.direction : ray.origin + t * ray.direction;
    local = real2(dot3(plane.axis_u.xyz, p), dot3(plane.axis_v.xyz, p));
    if (BOUNDED_PLANES && plane.link.w != 0u) {
        real extent = REAL_BITS(plane.link.zw);
        real2 place = local + real2(plane.axis_u.w, plane.axis_v.w);
        t = abs(place.x) <= extent && abs(place.y) <= extent ? t : -1.0;
    }
    return t;
}

// Haines, Günther & Akenine-Möller 2019: the discriminant from the vector of closest approach, and
// of the two roots c/q and q/a the one that does not cancel.
real sphere_distance(Sphere sphere, Ray ray, bool from_eye) {
    real3 f = from_eye ? -sphere.ball.xyz : ray.origin - sphere.ball.xyz;
    real radius = sphere.ball.w;
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

// Edge functions as volumes d·(p × q): the two triangles at a shared edge compute the same value
// with opposite sign, so no ray passes between them. t from the geometric plane.
real triangle_distance(Triangle triangle, Ray ray, bool from_eye) {
    real3 a = from_eye ? triangle.a.xyz : triangle.a.xyz - ray.origin;
    real3 b = from_eye ? triangle.b.xyz : triangle.b.xyz - ray.origin;
    real3 c = from_eye ? triangle.c.xyz : triangle.c.xyz - ray.origin;
    real3 edges = real3(dot3(ray.direction, cross3(b, c)), dot3(ray.direction, cross3(c, a)),
                 dot3(ray.direction, cross3(a, b)));
    bool front = edges.x >= 0.0 && edges.y >= 0.0 && edges.z >= 0.0;
    bool back = edges.x <= 0.0 && edges.y <= 0.0 && edges.z <= 0.0;
    bool degenerate = edges == real3(0.0);
    real height = triangle.normal.w;
    if (!from_eye) {
        real above = height - dot3(triangle.normal.xyz, ray.origin);
        height = above;
    }
    real t = height / dot3(triangle.normal.xyz, ray.direction);
    return (front || back) && !degenerate ? t : -1.0;
}

// `list`: of the survey's cell in which a camera ray lies, else NO_LIST.
Hit nearest_hit(Header header, Ray ray, uint skip, uint list) {
    Hit hit = Hit(FAR, NO_SHAPE, real2(0.0));
    uint planes = COUNT(PLANES, header.counts.x);
    uint spheres = COUNT(SPHERES, header.counts.y);
    uint triangles = COUNT(TRIANGLES, header.counts.z);
    for (uint i = 0u; i < planes; i++) {
        real2 local;
        real t = plane_distance(plane_at(i), at_rest(header, ray, i), ORIGIN_IS_EYE, local);
        bool nearer = t > 0.0 && t < hit.t && i != skip;
        hit.t = nearer ? t : hit.t;
        hit.shape = nearer ? i : hit.shape;
        hit.local = nearer ? local : hit.local;
    }
    for (uint i = 0u; i < spheres; i++) {
        real t = sphere_distance(sphere_at(i), at_rest(header, ray, planes + i), ORIGIN_IS_EYE);
        bool nearer = t > 0.0 && t < hit.t;
        hit.t = nearer ? t : hit.t;
        hit.shape = nearer ? planes + i : hit.shape;
    }
    uint tested = triangles;
    if (TILE_CULLED) {
        if (list != NO_LIST) tested = survey[list];
    }
    for (uint k = 0u; k < tested; k++) {
        uint i = k;
        if (TILE_CULLED) {
            if (list != NO_LIST) i = survey[list + 2u + k];
        }
        real t = triangle_distance(triangle_at(i), at_rest(header, ray, planes + spheres + i), ORIGIN_IS_EYE);
        bool nearer = t > 0.0 && t < hit.t && planes + spheres + i != skip;
        hit.t = nearer ? t : hit.t;
        hit.shape = nearer ? planes + spheres + i : hit.shape;
    }
    return hit;
}

// True when a shape lies at 0 < t < t_max.
bool occluded(Header header, Ray ray, real t_max, uint skip) {
    bool blocked = false;
    uint planes = COUNT(PLANES, header.counts.x);
    uint spheres = COUNT(SPHERES, header.counts.y);
    uint triangles = COUNT(TRIANGLES, header.counts.z);
    for (uint i = 0u; i < planes; i++) {
        real2 local;
        real t = plane_distance(plane_at(i), at_rest(header, ray, i), false, local);
        blocked = blocked || (t > 0.0 && t < t_max && i != skip);
    }
    for (uint i = 0u; i < spheres; i++) {
        real t = sphere_distance(sphere_at(i), at_rest(header, ray, planes + i), false);
        blocked = blocked || (t > 0.0 && t < t_max);
    }
    for (uint i = 0u; i < triangles; i++) {
        real t = triangle_distance(triangle_at(i), at_rest(header, ray, planes + spheres + i), false);
        blocked = blocked || (t > 0.0 && t < t_max && planes + spheres + i != skip);
    }
    return blocked;
}

#ifdef DOUBLE
const double CLEARANCE = 1.4210854715202004e-14lf; // 2^-46
#else
const float CLEARANCE = 3.8146972656e-6; // 2^-18
#endif

// The start of a ray that leaves the surface at p along its unit geometric normal n: off it by far more than
// the rounding of p and of the next ray's tests, which are a few parts in 2^24 of `size` (in f64, of 2^53), the
// largest coordinate that p came from. As in Wächter & Binder 2019 the step grows with the numbers; alike at
// every scale, it has no least length.
real3 offset_origin(real3 p, real3 n, real size) {
    real3 moved = p + n * (CLEARANCE * size);
    return moved;
}

#endif
