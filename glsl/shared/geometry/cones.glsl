// A cone and a shape: what it cuts out of the disc, how much that is, where a ray within meets it, and how deep it
// lies. Twin: src/oracle/geometry/cones.rs.
#ifndef CONES_GLSL
#define CONES_GLSL

#include "kinds.glsl"

// The cone with the floor of the shape that it leaves.
Cone leaving(Cone cone, uint shape) {
    if (!FLOORS || shape == NO_SHAPE) return cone;
    COUNT_SHAPES
    vec3 up = vec3(0.0);
#define UP(Type, at, LIST, first, count, is_planar, is_polygonal, is_listed, is_concave) if (IS_WITHIN(LIST, shape, first, count)) up = plane_of(at(shape - (first))).xyz; else
    PLANAR_KINDS(UP) return cone;
#undef UP
    Ray ray = cone.ray;
    if (dot3(up, ray.direction) < 0.0) up = -up;
    float level = LEVEL * max(abs(ray.origin.x), max(abs(ray.origin.y), abs(ray.origin.z)));
    cone.floor = vec4(up, -(dot3(up, ray.origin) + level));
    return cone;
}

// True if a ray that leaves the shape outwards may meet it again.
bool is_concave(uint shape) {
    COUNT_SHAPES
    bool found = false;
#define CONCAVE(Type, at, LIST, first, count, is_planar, is_polygonal, is_listed, is_concave) found = found || IS_WITHIN(LIST, shape, first, count);
    CONCAVE_KINDS(CONCAVE)
#undef CONCAVE
    return found;
}

// The shape that a ray must not meet again at once. From inside a ball its other side is met; a concave shape may be met
// again anywhere.
uint left_shape(uint shape, bool within) {
    COUNT_SHAPES
    bool meets_again = false;
#define SOLID(Type, at, LIST, first, count, is_planar, is_polygonal, is_listed, is_concave) \
    meets_again = meets_again || ((is_concave || within) && shape >= (first) && shape < (first) + (count));
    SOLID_KINDS(SOLID)
#undef SOLID
    return meets_again ? NO_SHAPE : shape;
}

// Cuts the disc to what the shape covers; false for one that no lines stand for.
bool cut_shape(const Cone cone, uint shape) {
    COUNT_SHAPES
    bool has_lines = true;
#define CUT(Type, at, LIST, first, count, is_planar, is_polygonal, is_listed, is_concave) \
    if (IS_NEXT(LIST, shape, first, count)) has_lines = cut_by_shape(cone, at(shape - (first))); else
    SHAPE_KINDS(CUT) {}
#undef CUT
    return has_lines;
}

// The part of the disc that the shape covers.
Covered covered_by(const Cone cone, uint shape) {
    COUNT_SHAPES
#define COVERED(Type, at, LIST, first, count, is_planar, is_polygonal, is_listed, is_concave) \
    if (IS_WITHIN(LIST, shape, first, count)) return covered_by(cone, at(shape - (first)));
    ROUND_KINDS(COVERED)
#undef COVERED
    if (0u POLYGONAL_KINDS(ADD_COUNT) == 0u) return NOTHING;
    whole_disc();
    cut_shape(cone, shape);
    return cut_disc();
}

// True if the cone may touch the shape.
bool touched(const Cone cone, uint shape) {
    COUNT_SHAPES
#define TOUCHED(Type, at, LIST, first, count, is_planar, is_polygonal, is_listed, is_concave) \
    if (IS_WITHIN(LIST, shape, first, count)) return touched(cone, at(shape - (first)));
    ROUND_KINDS(TOUCHED)
#undef TOUCHED
    whole_disc();
    cut_shape(cone, shape);
    return !cut_away;
}

// Where a ray within the shape's outline meets it; rounding may have put it just beside.
Hit meet(const Ray ray, uint shape) {
    COUNT_SHAPES
    Hit hit = Hit(-1.0, shape, vec2(0.0));
    vec4 plane = vec4(0.0);
#define SOLID(Type, at, LIST, first, count, is_planar, is_polygonal, is_listed, is_concave)            \
    if (IS_WITHIN(LIST, shape, first, count)) {        \
        complete(at(shape - (first)), ray, hit); \
        return hit;                              \
    }
    SOLID_KINDS(SOLID)
#undef SOLID
#define PLANAR(Type, at, LIST, first, count, is_planar, is_polygonal, is_listed, is_concave)       \
    if (IS_WITHIN(LIST, shape, first, count)) {    \
        Type found = at(shape - (first));    \
        plane = plane_of(found);             \
        complete(found, ray, hit);           \
    } else
    PLANAR_KINDS(PLANAR) {}
#undef PLANAR
    float above = plane.w - dot3(plane.xyz, ray.origin);
    hit.t = above / dot3(plane.xyz, ray.direction);
    return hit;
}

// The depth of a shape over the disc: by its own plane, or a ball's tangent plane; at a ball's outline by its distance
// alone.
Flat depth_of(const Cone cone, uint shape, float t, float area) {
    COUNT_SHAPES
    vec4 plane = vec4(0.0);
    bool ends = false;
#define DEPTH(Type, at, LIST, first, count, is_planar, is_polygonal, is_listed, is_concave)          \
    if (IS_NEXT(LIST, shape, first, count)) {                            \
        plane = tangent_plane(at(shape - (first)), cone, t);       \
        ends = !is_planar && area < 1.0;                             \
    } else
    SHAPE_KINDS(DEPTH) {}
#undef DEPTH
    Flat depth = flat_in(cone, plane.xyz, plane.w);
    if (ends) depth = Flat(t, 1.0, vec2(0.0));
    return depth;
}

#endif
