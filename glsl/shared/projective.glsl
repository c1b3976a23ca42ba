// Shapes as a pixel's rays see them: regions between lines of the picture, inverse depth that is affine there,
// and texture coordinates as quotients of affine functions, also after plane mirrors. Perspective:
// rays start at one point, the direction is affine in the place, inverse depth is 1 / t. Parallel: the
// origin is affine, inverse depth is -t. Twin: src/oracle/projective.rs.
#ifndef PROJECTIVE_GLSL
#define PROJECTIVE_GLSL

#include "layout.glsl"
#include "polygon.glsl"

const uint MAX_LINES = 6u;

// All rays of a pixel: with the columns' sum weighted by (x, y, 1), direction or origin.
struct PixelFrustum {
    mat3 rays;
    vec3 same; // the other of the two, the same for all
};

// What a convex shape covers: the places where all lines are positive.
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

bool is_parallel(Header header) { return MODE_IS(PROJECTIONS, PROJECTION_ORTHOGRAPHIC, header.size.z); }

// All rays of the pixels from the first to `more` columns and rows on, and of a margin around them.
PixelFrustum frame_over(Header header, uvec2 pixel, float more, float margin) {
    // The unit square stands for the pixel filter's box.
    float radius = uintBitsToFloat(header.pixel_filter.y) + margin;
    float wide = 2.0 * radius + more;
    vec2 corner = (vec2(pixel) - 0.5 * vec2(header.image.xy)) + (0.5 - radius);
    vec3 x = header.step_x.xyz;
    vec3 y = header.step_y.xyz;
    vec3 base = corner.x * x + corner.y * y;
    if (is_parallel(header)) return PixelFrustum(mat3(wide * x, wide * y, base), header.forward.xyz);
    return PixelFrustum(mat3(wide * x, wide * y, base + header.forward.xyz), vec3(0.0));
}

PixelFrustum pixel_frame(Header header, uvec2 pixel) { return frame_over(header, pixel, 0.0, 0.0); }

// n · (what differs from ray to ray).
vec3 form(PixelFrustum frame, vec3 n) { return vec3(dot3(frame.rays[0], n), dot3(frame.rays[1], n), dot3(frame.rays[2], n)); }

// The ray's direction, and its origin.
void ray_at(Header header, PixelFrustum frame, vec2 place, out vec3 direction, out vec3 origin) {
    vec3 own = (frame.rays[0] * place.x + frame.rays[1] * place.y) + frame.rays[2];
    bool parallel = is_parallel(header);
    direction = parallel ? frame.same : own;
    origin = parallel ? own : frame.same;
}

vec3 turned(vec3 v, vec3 n) { return v - (2.0 * dot3(n, v)) * n; }

// Behind the mirror with unit normal n and n·p = height.
PixelFrustum mirrored_frame(Header header, PixelFrustum frame, vec3 n, float height) {
    mat3 rays = mat3(turned(frame.rays[0], n), turned(frame.rays[1], n), turned(frame.rays[2], n));
    vec3 same = turned(frame.same, n);
    vec3 shift = (2.0 * height) * n;
    if (is_parallel(header)) rays[2] += shift;
    else same += shift;
    return PixelFrustum(rays, same);
}

// 1 / t or -t of the plane n·p = height, where it is in front positive or negative; zero where the rays
// never meet it.
vec3 inverse_depth(Header header, PixelFrustum frame, vec3 n, float height) {
    float across = dot3(n, frame.same);
    if (is_parallel(header)) return across == 0.0 ? vec3(0.0) : (form(frame, n) - vec3(0.0, 0.0, height)) / across;
    float before = height - across;
    return before == 0.0 ? vec3(0.0) : form(frame, n) / before;
}

// Positive where the place of that inverse depth lies in front.
vec3 in_front(Header header, vec3 near) { return is_parallel(header) ? -near : near; }

// What coordinates on a plane of this inverse depth are divided by.
vec3 below(Header header, vec3 near) { return is_parallel(header) ? vec3(0.0, 0.0, 1.0) : near; }

// row · (p, 1) times `below`, for the points p of the plane of that inverse_depth.
vec3 along(Header header, PixelFrustum frame, vec3 near, vec4 row) {
    float same = dot3(row.xyz, frame.same);
    vec3 own = form(frame, row.xyz);
    if (is_parallel(header)) return own - same * near + vec3(0.0, 0.0, row.w);
    return own + (same + row.w) * near;
}

// Barycentric weights of a triangle's corners times their sum, positive within it.
mat3 edge_forms(Header header, PixelFrustum frame, Triangle triangle) {
    bool parallel = is_parallel(header);
    vec3 way = frame.same;
    vec3 start = parallel ? vec3(0.0) : way;
    vec3 a = triangle.a.xyz - start;
    vec3 b = triangle.b.xyz - start;
    vec3 c = triangle.c.xyz - start;
    if (parallel) {
        float side = sign(dot3(way, cross3(b - a, c - a)));
        vec3 ea = form(frame, cross3(b - c, way)) + vec3(0.0, 0.0, dot3(way, cross3(b, c)));
        vec3 eb = form(frame, cross3(c - a, way)) + vec3(0.0, 0.0, dot3(way, cross3(c, a)));
        vec3 ec = form(frame, cross3(a - b, way)) + vec3(0.0, 0.0, dot3(way, cross3(a, b)));
        return mat3(side * ea, side * eb, side * ec);
    }
    float side = sign(dot3(a, cross3(b, c)));
    return mat3(side * form(frame, cross3(b, c)), side * form(frame, cross3(c, a)), side * form(frame, cross3(a, b)));
}

// Unit normal, and height of the plane in which a flat shape lies.
vec4 shape_plane(Header header, uint shape) {
    uint planes = COUNT(PLANES, header.counts.x);
    if (TRIANGLES == 0u || shape < planes) return plane_at(shape).normal;
    return triangle_at(shape - planes - COUNT(SPHERES, header.counts.y)).normal;
}

// Material and map.
uvec2 shape_links(Header header, uint shape) {
    uint planes = COUNT(PLANES, header.counts.x);
    if (TRIANGLES == 0u || shape < planes) return plane_at(shape).link.xy;
    return triangle_at(shape - planes - COUNT(SPHERES, header.counts.y)).link.xy;
}

vec3 nearness_of(Header header, PixelFrustum frame, uint shape) {
    vec4 plane = shape_plane(header, shape);
    return inverse_depth(header, frame, plane.xyz, plane.w);
}

// Planes first, then spheres, then triangles; spheres have no region.
ConvexRegion shape_region(Header header, PixelFrustum frame, uint shape) {
    uint planes = COUNT(PLANES, header.counts.x);
    uint before_triangles = planes + COUNT(SPHERES, header.counts.y);
    ConvexRegion region;
    region.count = 1u;
    vec3 near = nearness_of(header, frame, shape);
    region.inverse_depth = near;
    region.lines[0] = in_front(header, near);
    if (TRIANGLES == 0u || shape < planes) {
        Plane record = plane_at(shape);
        if (BOUNDED_PLANES && record.link.w != 0u) {
            vec3 extent = REAL_BITS(record.link.zw) * below(header, near);
            vec3 u = along(header, frame, near, record.axis_u);
            vec3 v = along(header, frame, near, record.axis_v);
            region.lines[1] = extent - u;
            region.lines[2] = extent + u;
            region.lines[3] = extent - v;
            region.lines[4] = extent + v;
            region.count = 5u;
        }
    } else {
        mat3 edges = edge_forms(header, frame, triangle_at(shape - before_triangles));
        region.lines[1] = edges[0];
        region.lines[2] = edges[1];
        region.lines[3] = edges[2];
        region.count = 4u;
    }
    return region;
}

// Texture coordinates on a flat shape, for maps that are affine there.
RationalMap coordinates(Header header, PixelFrustum frame, uint shape, UvProjection map, vec3 near) {
    uint planes = COUNT(PLANES, header.counts.x);
    vec3 under = below(header, near);
    if (MODE_IS(MAPPINGS, MAP_VERTEX_UV, map.link.x)) {
        Triangle triangle = triangle_at(shape - planes - COUNT(SPHERES, header.counts.y));
        mat3 e = edge_forms(header, frame, triangle);
        vec3 u = triangle.a.w * e[0] + triangle.b.w * e[1] + triangle.c.w * e[2];
        vec3 v = triangle.v.x * e[0] + triangle.v.y * e[1] + triangle.v.z * e[2];
        return RationalMap(u, v, e[0] + e[1] + e[2]);
    }
    if (MODE_IS(MAPPINGS, MAP_AFFINE, map.link.x)) {
        return RationalMap(along(header, frame, near, map.x), along(header, frame, near, map.y), under);
    }
    // Counted from the eye.
    Plane plane = plane_at(shape);
    vec3 u = along(header, frame, near, vec4(plane.axis_u.xyz, 0.0));
    vec3 v = along(header, frame, near, vec4(plane.axis_v.xyz, 0.0));
    return RationalMap(map.matrix.x * u + map.matrix.y * v + map.offset.x * under,
                    map.matrix.z * u + map.matrix.w * v + map.offset.y * under, under);
}

// Where, on the plane of this inverse depth, a flat shape keeps a light away.
ConvexRegion shadow_region(Header header, PixelFrustum frame, vec3 near, uint shape, Light light) {
    uint planes = COUNT(PLANES, header.counts.x);
    vec3 place = light.place.xyz;
    bool point_light = MODE_IS(LIGHT_KINDS, LIGHT_POINT, light.link.x);
    vec4 plane = shape_plane(header, shape);
    vec3 n = plane.xyz;
    // Of the light before the shape's plane, or of a way's length towards it.
    float rise = point_light ? plane.w - dot3(n, place) : dot3(n, place);
    float side = sign(rise);
    ConvexRegion region;
    region.count = 1u;
    region.inverse_depth = near;
    // Beyond the plane, seen from the light.
    region.lines[0] = along(header, frame, near, (point_light ? side : -side) * vec4(n, -plane.w));
    if (TRIANGLES == 0u || shape < planes) {
        Plane record = plane_at(shape);
        if (!BOUNDED_PLANES || record.link.w == 0u) return region;
        // A place's distance below the light, in |rise|, or its own height.
        vec4 depth = point_light ? side * vec4(n, -dot3(n, place)) : vec4(0.0, 0.0, 0.0, abs(rise));
        vec3 extent = REAL_BITS(record.link.zw) * along(header, frame, near, depth);
        for (uint k = 0u; k < 2u; k++) {
            vec4 row = k == 0u ? record.axis_u : record.axis_v;
            float across = dot3(row.xyz, place);
            // u of light + (p - light) rise / (n·(p - light)), times the depth; u of p + way (height -
            // n·p) / rise, times |rise|.
            vec4 own = point_light ? (across + row.w) * depth + abs(rise) * vec4(row.xyz, -across)
                                   : abs(rise) * row + (side * across) * vec4(-n, plane.w);
            vec3 across_axis = along(header, frame, near, own);
            region.lines[1u + 2u * k] = extent - across_axis;
            region.lines[2u + 2u * k] = extent + across_axis;
        }
        region.count = 5u;
        return region;
    }
    Triangle triangle = triangle_at(shape - planes - COUNT(SPHERES, header.counts.y));
    vec3 start = point_light ? place : vec3(0.0);
    mat3 corners = mat3(triangle.a.xyz - start, triangle.b.xyz - start, triangle.c.xyz - start);
    vec3 doubled = cross3(corners[1] - corners[0], corners[2] - corners[0]);
    float turn = sign(point_light ? dot3(corners[0], cross3(corners[1], corners[2])) : dot3(place, doubled));
    for (uint k = 0u; k < 3u; k++) {
        vec3 p = corners[(k + 1u) % 3u];
        vec3 q = corners[(k + 2u) % 3u];
        vec3 m = point_light ? cross3(p, q) : cross3(p - q, place);
        float constant = point_light ? -dot3(m, place) : dot3(place, cross3(p, q));
        region.lines[1u + k] = along(header, frame, near, turn * vec4(m, constant));
    }
    region.count = 4u;
    return region;
}

// False where no ray of the polygon can meet the sphere.
bool may_meet_sphere(Header header, PixelFrustum frame, uint polygon, Sphere sphere) {
    vec3 way;
    vec3 origin;
    ray_at(header, frame, middle(polygon), way, origin);
    vec3 unit = way * inversesqrt(dot3(way, way));
    vec3 to = sphere.ball.xyz - origin;
    float radius = sphere.ball.w;
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

// The point of the plane of that inverse depth which a place shows.
vec3 point_at(Header header, PixelFrustum frame, vec3 near, vec2 place) {
    vec3 way;
    vec3 origin;
    ray_at(header, frame, place, way, origin);
    float value = at(near, place);
    return origin + way * (is_parallel(header) ? -value : 1.0 / value);
}

#endif
