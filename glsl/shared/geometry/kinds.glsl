// The kinds of shapes, which src/schema/shapes.rs lists. Outside this folder nobody knows them: a shape is a number, and
// those of one kind follow each other. Twin: src/oracle/geometry/kinds.rs.
#ifndef KINDS_GLSL
#define KINDS_GLSL

#include "schema/shapes.glsl"

// Of one kind, where all kinds before it have been asked: a scene of one kind of shape needs no test. A kind that the
// scene lacks is ruled out by the constant, so that its code is not in the pipeline.
#define IS_NEXT(LIST, shape, first, count) \
    ((LIST) != 0u && (count) > 0u && ((first) + (count) == shapes || (shape) < (first) + (count)))
#define IS_WITHIN(LIST, shape, first, count) \
    ((LIST) != 0u && (count) > 0u && ((count) == shapes || ((shape) >= (first) && (shape) < (first) + (count))))

#define ADD_COUNT(Type, at, LIST, first, count, is_planar, is_polygonal, is_listed) + (count)

uint shape_count() {
    COUNT_SHAPES
    return shapes;
}

#endif
