// Shapes as beams see them: of flat ones the plane, the region, texture coordinates and shadows; of others, and of all
// for tile culling, whether they may lie in the way. Twin: src/oracle/geometry/beams.rs.
#ifndef BEAMS_GLSL
#define BEAMS_GLSL

#include "kinds.glsl"

// True if a shape has a region; beams do not know the outline of others.
bool has_region(uint shape) {
    COUNT_SHAPES
    bool is_round = false;
#define ROUND(Type, at, LIST, first, count, is_planar, is_polygonal, is_listed, is_concave) is_round = is_round || IS_WITHIN(LIST, shape, first, count);
    ROUND_KINDS(ROUND)
#undef ROUND
    return !is_round;
}

// Unit normal, and height of the plane in which a flat shape lies.
vec4 shape_plane(uint shape) {
    COUNT_SHAPES
    vec4 plane = vec4(0.0);
#define PLANE_OF(Type, at, LIST, first, count, is_planar, is_polygonal, is_listed, is_concave) if (IS_NEXT(LIST, shape, first, count)) plane = plane_of(at(shape - (first))); else
    POLYGONAL_KINDS(PLANE_OF) {}
#undef PLANE_OF
    return plane;
}

// Material and map.
uvec2 shape_links(uint shape) {
    COUNT_SHAPES
    uvec2 link = uvec2(0u);
#define LINK(Type, at, LIST, first, count, is_planar, is_polygonal, is_listed, is_concave) if (IS_NEXT(LIST, shape, first, count)) link = links_of(at(shape - (first))); else
    POLYGONAL_KINDS(LINK) {}
#undef LINK
    return link;
}

bool is_smooth(uint shape) {
    COUNT_SHAPES
    bool smooth_normals = false;
#define SMOOTH(Type, at, LIST, first, count, is_planar, is_polygonal, is_listed, is_concave) \
    if (IS_NEXT(LIST, shape, first, count)) smooth_normals = has_smooth_normals(at(shape - (first))); else
    POLYGONAL_KINDS(SMOOTH) {}
#undef SMOOTH
    return smooth_normals;
}

vec3 nearness_of(const Header header, const PixelFrustum frame, uint shape) {
    vec4 plane = shape_plane(shape);
    return inverse_depth(header, frame, plane.xyz, plane.w);
}

ConvexRegion shape_region(const Header header, const PixelFrustum frame, uint shape) {
    COUNT_SHAPES
    ConvexRegion region = region_of_plane(header, frame, shape_plane(shape));
#define OUTLINE(Type, at, LIST, first, count, is_planar, is_polygonal, is_listed, is_concave) \
    if (IS_NEXT(LIST, shape, first, count)) add_outline(header, frame, region.inverse_depth, at(shape - (first)), region); else
    POLYGONAL_KINDS(OUTLINE) {}
#undef OUTLINE
    return region;
}

// Texture coordinates on a flat shape, for maps that are affine there.
RationalMap coordinates(const Header header, const PixelFrustum frame, uint shape, const UvProjection map, vec3 near) {
    if (MODE_IS(MAPPINGS, MAP_AFFINE, map.kind)) {
        return RationalMap(along(header, frame, near, map.x), along(header, frame, near, map.y), below(header, near));
    }
    COUNT_SHAPES
    RationalMap own = RationalMap(near, near, near);
#define OWN(Type, at, LIST, first, count, is_planar, is_polygonal, is_listed, is_concave) \
    if (IS_NEXT(LIST, shape, first, count)) own = own_coordinates(header, frame, near, at(shape - (first)), map); else
    POLYGONAL_KINDS(OWN) {}
#undef OWN
    return own;
}

// Where, on the plane of this inverse depth, a flat shape keeps a light away.
ConvexRegion shadow_region(const Header header, const PixelFrustum frame, vec3 near, uint shape, const Light light) {
    COUNT_SHAPES
    bool point_light = MODE_IS(LIGHT_KINDS, LIGHT_POINT, light.kind);
    vec3 place = point_light ? light.position : light.direction;
    vec4 plane = shape_plane(shape);
    vec3 n = plane.xyz;
    // Height of the light over the shape's plane, or of a unit step towards it.
    float rise = point_light ? plane.w - dot3(n, place) : dot3(n, place);
    float side = sign(rise);
    ConvexRegion region;
    region.count = 1u;
    region.inverse_depth = near;
    // Beyond the plane, seen from the light.
    region.lines[0] = along(header, frame, near, (point_light ? side : -side) * vec4(n, -plane.w));
#define SHADOW(Type, at, LIST, first, count, is_planar, is_polygonal, is_listed, is_concave)                                                       \
    if (IS_NEXT(LIST, shape, first, count)) {                                                      \
        add_shadow(header, frame, near, light, plane, rise, region, at(shape - (first)));    \
    } else
    POLYGONAL_KINDS(SHADOW) {}
#undef SHADOW
    return region;
}

// False where no ray of the polygon can meet the shape, which has no region.
bool may_meet(const Header header, const PixelFrustum frame, uint polygon, uint shape) {
    COUNT_SHAPES
#define MEETS(Type, at, LIST, first, count, is_planar, is_polygonal, is_listed, is_concave) \
    if (IS_WITHIN(LIST, shape, first, count)) return may_meet(header, frame, polygon, at(shape - (first)));
    ROUND_KINDS(MEETS)
#undef MEETS
    return false;
}

// False where no way from the polygon on a surface of this inverse depth to the light can pass the shape, which has no
// region.
bool may_shade(const Header header, const PixelFrustum frame, vec3 near, uint polygon, const Light light, uint shape) {
    COUNT_SHAPES
#define SHADES(Type, at, LIST, first, count, is_planar, is_polygonal, is_listed, is_concave) \
    if (IS_WITHIN(LIST, shape, first, count)) return may_shade(header, frame, near, polygon, light, at(shape - (first)));
    ROUND_KINDS(SHADES)
#undef SHADES
    return false;
}

#endif
