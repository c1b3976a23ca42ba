// A ray and all shapes: the nearest hit with t > 0, whether anything lies between, and the surface at a hit. One loop
// a kind; meshes have trees in place of it. Flat shapes never hit the ray that left
// them (`skip`); others rely on the offset origin. Twin: src/oracle/geometry/rays.rs.
#ifndef RAYS_GLSL
#define RAYS_GLSL

#include "../tile_culling.glsl"
#include "kinds.glsl"
#include "mesh_team_shades.glsl"

// Replaces the hit by the nearest triangle of a mesh, if that is nearer. `first`: the shape that is the first mesh.
void nearest_in_meshes(const Ray ray, const Candidates candidates, uint first, inout Hit hit) {
    real best = hit.t;
    FoundTriangle found = NO_TRIANGLE;
    bool is_complete = false;
    if (TILE_CULLED) {
        is_complete = candidates.list != NO_LIST && nearest_listed(ray, candidates, best, found);
        unfinished = unfinished || !is_complete;
    }
    if (!BY_LISTS) {
        if (!is_complete) search(0u, nowhere(ray), first, ray, ORIGIN_IS_EYE, false, best, found);
    }
    if (found.at != NO_SHAPE) hit = hit_of(found, first, best);
}

// True when a triangle of a mesh lies before `t_max`.
bool occluded_by_meshes(const Ray ray, uint first, real t_max) {
    real best = t_max;
    FoundTriangle found = NO_TRIANGLE;
    search(0u, nowhere(ray), first, ray, false, true, best, found);
    return found.at != NO_SHAPE;
}

// `candidates`: of a camera ray, by tile culling; else ANYTHING.
Hit nearest_hit(const Ray ray, uint skip, const Candidates candidates) {
    Hit hit = Hit(FAR, NO_SHAPE, real2(0.0));
    uint list = candidates.list;
    COUNT_SHAPES
#define NEAREST(Type, at, LIST, first, count, is_planar, is_polygonal, is_listed, is_concave)                                                  \
    if (LIST != 0u) {                                                                                        \
        uint tested = count;                                                                                 \
        if (is_listed && TILE_CULLED) {                                                                      \
            if (list != NO_LIST) tested = tile_lists[list];                                                  \
        }                                                                                                    \
        if (is_concave) nearest_in_meshes(ray, candidates, first, hit);                                      \
        else for (uint k = 0u; k < tested; k++) {                                                            \
            uint i = k;                                                                                      \
            bool is_own = true;                                                                              \
            if (is_listed && TILE_CULLED) {                                                                  \
                if (list != NO_LIST) {                                                                       \
                    /* Below zero is beyond all. */                                                          \
                    i = tile_lists[list + CELL_HEAD + k] - (first);                                          \
                    is_own = i < count;                                                                      \
                    i = is_own ? i : 0u;                                                                     \
                }                                                                                            \
            }                                                                                                \
            real2 local = hit.local;                                                                         \
            real t = distance_to(at(i), at_rest(ray, (first) + i), ORIGIN_IS_EYE, hit.t, false, local); \
            bool nearer = is_own && t > 0.0 && t < hit.t && !(is_planar && (first) + i == skip);               \
            hit.t = nearer ? t : hit.t;                                                                      \
            hit.shape = nearer ? (first) + i : hit.shape;                                                    \
            hit.local = nearer ? local : hit.local;                                                          \
        }                                                                                                    \
    }
    SHAPE_KINDS(NEAREST)
#undef NEAREST
    return hit;
}

// True when a shape lies at 0 < t < t_max, whichever is found first. `normal`: of the surface that the ray has left.
bool occluded(const Ray ray, real t_max, uint skip, real3 normal) {
    bool blocked = false;
    COUNT_SHAPES
#define OCCLUDES(Type, at, LIST, first, count, is_planar, is_polygonal, is_listed, is_concave)                                                 \
    if (is_concave && SHADES) {                                                                              \
        blocked = is_shaded(ray, t_max, seen_corner, normal);                                                \
    } else if (LIST != 0u) {                                                                                 \
        if (is_concave) blocked = blocked || occluded_by_meshes(ray, first, t_max);                          \
        else for (uint i = 0u; i < count; i++) {                                                             \
            real2 local;                                                                                     \
            real t = distance_to(at(i), at_rest(ray, (first) + i), false, t_max, true, local);               \
            blocked = blocked || (t > 0.0 && t < t_max && !(is_planar && (first) + i == skip));                \
        }                                                                                                    \
    }
    SHAPE_KINDS(OCCLUDES)
#undef OCCLUDES
    return blocked;
}

Surface hit_surface(const Ray moving, const Hit hit) {
    Ray ray = at_rest(moving, hit.shape);
    COUNT_SHAPES
    real3 point = ORIGIN_IS_EYE ? hit.t * ray.direction : ray.origin + hit.t * ray.direction;
    const real3 up = real3(0.0, 0.0, 1.0);
    Surface surface = Surface(point, up, up, real2(0.0), vec3(0.0), vec3(0.0), FLAT, 0.0, false, uvec2(0u), point, 0.0, NO_ATTRIBUTES);
#define SURFACE(Type, at, LIST, first, count, is_planar, is_polygonal, is_listed, is_concave)                                                  \
    if (IS_NEXT(LIST, hit.shape, first, count)) {                                                                  \
        surface = surface_of(at(hit.shape - (first)), point, hit.local);                                     \
    } else
    SHAPE_KINDS(SURFACE) {}
#undef SURFACE
    if (MOTIONS != 0u) surface.point += moved_by(moving, hit.shape);
    bool away = dot3(surface.geometric_normal, ray.direction) > 0.0;
    surface.inside = away;
    surface.geometric_normal = away ? -surface.geometric_normal : surface.geometric_normal;
    surface.normal = away ? -surface.normal : surface.normal;
    if (NEEDS_SHAPE_OPERATOR && CURVED_SHAPES) {
        surface.shape_operator = away ? -surface.shape_operator : surface.shape_operator;
        surface.curvature = away ? -surface.curvature : surface.curvature;
    }
    return surface;
}

#ifdef F64_MATH
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
