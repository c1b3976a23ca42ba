// Flat surfaces in a pixel's projection: regions bounded by lines, inverse depth that is affine, and texture
// coordinates as quotients of affine functions, also after reflection in plane mirrors; the shapes are in
// geometry/beams.glsl. Perspective: rays start at one point, the direction is affine in the position, inverse
// depth is 1 / t. Parallel: the origin is affine, inverse depth is -t. Twin: src/oracle/projective.rs.
#ifndef PROJECTIVE_GLSL
#define PROJECTIVE_GLSL

#include "layout.glsl"
#include "polygon.glsl"

const uint MAX_LINES = 6u;

// All rays of a pixel: the sum of the columns weighted by (x, y, 1) is the direction or the origin.
struct PixelFrustum {
    mat3 rays;
    vec3 same; // the other of the two, the same for all rays
};

// The projection of a convex shape: the positions where all lines are positive.
struct ConvexRegion {
    uint count;
    vec3 lines[MAX_LINES];
    vec3 inverse_depth;
};

// (u, v) = (u, v) / below.
struct RationalMap {
    vec3 u;
    vec3 v;
    vec3 below;
};

bool is_parallel(const Header header) { return MODE_IS(PROJECTIONS, PROJECTION_ORTHOGRAPHIC, header.projection); }

// Returns the rays of the pixels from the first one to `more` columns and rows on, with a margin around them.
PixelFrustum frame_over(const Header header, uvec2 pixel, float more, float margin) {
    // The unit square represents the pixel filter's box.
    float radius = header.filter_radius + margin;
    float wide = 2.0 * radius + more;
    vec2 corner = (vec2(pixel) - 0.5 * vec2(header.image_size)) + (0.5 - radius);
    vec3 x = header.step_x;
    vec3 y = header.step_y;
    vec3 base = corner.x * x + corner.y * y;
    if (is_parallel(header)) return PixelFrustum(mat3(wide * x, wide * y, base), header.forward);
    return PixelFrustum(mat3(wide * x, wide * y, base + header.forward), vec3(0.0));
}

PixelFrustum pixel_frame(const Header header, uvec2 pixel) { return frame_over(header, pixel, 0.0, 0.0); }

// Returns n · (the part that differs from ray to ray).
vec3 form(const PixelFrustum frame, vec3 n) { return vec3(dot3(frame.rays[0], n), dot3(frame.rays[1], n), dot3(frame.rays[2], n)); }

// Returns the ray's direction, and its origin.
void ray_at(const Header header, const PixelFrustum frame, vec2 place, out vec3 direction, out vec3 origin) {
    vec3 own = (frame.rays[0] * place.x + frame.rays[1] * place.y) + frame.rays[2];
    bool parallel = is_parallel(header);
    direction = parallel ? frame.same : own;
    origin = parallel ? own : frame.same;
}

vec3 turned(vec3 v, vec3 n) { return v - (2.0 * dot3(n, v)) * n; }

// Reflects the frustum in the mirror with unit normal n and n·p = height.
PixelFrustum mirrored_frame(const Header header, const PixelFrustum frame, vec3 n, float height) {
    mat3 rays = mat3(turned(frame.rays[0], n), turned(frame.rays[1], n), turned(frame.rays[2], n));
    vec3 same = turned(frame.same, n);
    vec3 shift = (2.0 * height) * n;
    if (is_parallel(header)) rays[2] += shift;
    else same += shift;
    return PixelFrustum(rays, same);
}

// Returns the inverse depth 1 / t or -t of the plane n·p = height, positive or negative in front; zero if the
// rays never meet it.
vec3 inverse_depth(const Header header, const PixelFrustum frame, vec3 n, float height) {
    float across = dot3(n, frame.same);
    if (is_parallel(header)) return across == 0.0 ? vec3(0.0) : (form(frame, n) - vec3(0.0, 0.0, height)) / across;
    float before = height - across;
    return before == 0.0 ? vec3(0.0) : form(frame, n) / before;
}

// Returns a function that is positive where a point of that inverse depth is in front.
vec3 in_front(const Header header, vec3 near) { return is_parallel(header) ? -near : near; }

// Returns the denominator of coordinates on a plane of this inverse depth.
vec3 below(const Header header, vec3 near) { return is_parallel(header) ? vec3(0.0, 0.0, 1.0) : near; }

// Returns row · (p, 1) times `below`, for the points p of the plane of that inverse depth.
vec3 along(const Header header, const PixelFrustum frame, vec3 near, vec4 row) {
    float same = dot3(row.xyz, frame.same);
    vec3 own = form(frame, row.xyz);
    if (is_parallel(header)) return own - same * near + vec3(0.0, 0.0, row.w);
    return own + (same + row.w) * near;
}

// Returns the region in which a plane is in front.
ConvexRegion region_of_plane(const Header header, const PixelFrustum frame, vec4 plane) {
    ConvexRegion region;
    region.count = 1u;
    vec3 near = inverse_depth(header, frame, plane.xyz, plane.w);
    region.inverse_depth = near;
    region.lines[0] = in_front(header, near);
    return region;
}

// Returns the point of the plane of that inverse depth at a position in the picture.
vec3 point_at(const Header header, const PixelFrustum frame, vec3 near, vec2 place) {
    vec3 way;
    vec3 origin;
    ray_at(header, frame, place, way, origin);
    float value = at(near, place);
    return origin + way * (is_parallel(header) ? -value : 1.0 / value);
}

#endif
