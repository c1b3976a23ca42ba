// The kinds of shapes, which src/schema/shapes.rs lists. Outside this folder nobody knows them: a shape is a number, and
// those of one kind follow each other. Twin: src/oracle/geometry/kinds.rs.
#ifndef KINDS_GLSL
#define KINDS_GLSL

#include "schema/shapes.glsl"

// True if the shape is of this kind, given that it is of none before it: a scene of one kind of shape needs no test. The
// constant rules out a kind that the scene lacks, so that the pipeline does not contain its code.
#define IS_NEXT(LIST, shape, first, count) \
    ((LIST) != 0u && (count) > 0u && ((first) + (count) == shapes || (shape) < (first) + (count)))
#define IS_WITHIN(LIST, shape, first, count) \
    ((LIST) != 0u && (count) > 0u && ((count) == shapes || ((shape) >= (first) && (shape) < (first) + (count))))

#define ADD_COUNT(Type, at, LIST, first, count, is_planar, is_polygonal, is_listed, is_concave) + (count)

// Places in a cell's list.
const uint LIST_ROOM = CONCAVE_SHAPES ? MAX_LISTED_WITH_MESHES : MAX_LISTED;
// Words of a cell in a scene with meshes: where its room for more begins, where its shades begin, and bits of its parts.
const uint CELL_MORE = CELL_HEAD + LIST_ROOM;
const uint CELL_SHADES = CELL_MORE + 1u;
const uint CELL_MASKS = CELL_MORE + 2u;
// Of a cell of which nothing is lit: no shades begin there.
const uint NO_SHADES = 0u;

uint shape_count() {
    COUNT_SHAPES
    return shapes;
}

#endif
