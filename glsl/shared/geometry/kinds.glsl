// The kinds of shapes. Outside this folder nobody knows them: a shape is a number, and those of one kind follow each
// other. Twin: src/oracle/geometry/kinds.rs.
#ifndef KINDS_GLSL
#define KINDS_GLSL

#include "plane.glsl"
#include "sphere.glsl"
#include "triangle.glsl"

#define COUNT_SHAPES(header)                           \
    uint planes = COUNT(PLANES, (header).plane_count);          \
    uint spheres = COUNT(SPHERES, (header).sphere_count);       \
    uint triangles = COUNT(TRIANGLES, (header).triangle_count); \
    uint shapes = planes + spheres + triangles;

// Of each kind: record, element of the list, the constant with its length, number of the first and of all, whether it
// lies in a plane (a ray never meets again the one that it leaves), and whether lists of tiles hold it.
#define SHAPE_KINDS(DO)                           \
    DO(Plane, plane_at, PLANES, 0u, planes, true, false)  \
    DO(Sphere, sphere_at, SPHERES, planes, spheres, false, false) \
    DO(Triangle, triangle_at, TRIANGLES, planes + spheres, triangles, true, true)

// Those that lie in a plane within straight lines, and the others.
#define FLAT_KINDS(DO)            \
    DO(Plane, plane_at, PLANES, 0u, planes) \
    DO(Triangle, triangle_at, TRIANGLES, planes + spheres, triangles)
#define ROUND_KINDS(DO) DO(Sphere, sphere_at, SPHERES, planes, spheres)

// Of one kind, where all kinds before it have been asked: a scene of one kind of shape needs no test. A kind that the
// scene lacks is ruled out by the constant, so that its code is not in the pipeline.
#define IS_NEXT(LIST, shape, first, count) \
    ((LIST) != 0u && (count) > 0u && ((first) + (count) == shapes || (shape) < (first) + (count)))
#define IS_WITHIN(LIST, shape, first, count) \
    ((LIST) != 0u && (count) > 0u && ((count) == shapes || ((shape) >= (first) && (shape) < (first) + (count))))

// Some shape may have a normal that changes.
const bool CURVED_SHAPES = (SPHERES | TRIANGLES) != 0u;

#define ADD_COUNT(Type, at, LIST, first, count) + (count)

uint shape_count(const Header header) {
    COUNT_SHAPES(header)
    return shapes;
}

#endif
