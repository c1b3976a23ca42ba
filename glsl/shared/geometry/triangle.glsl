// Triangles, with uv and, if they are smooth, normals that are interpolated over them. Twin:
// src/oracle/geometry/triangle.rs.
#ifndef TRIANGLE_GLSL
#define TRIANGLE_GLSL

#include "../layout.glsl"

// Material and map.
uvec2 links_of(const Triangle triangle) { return uvec2(triangle.material, triangle.uv_projection); }

// Unit normal, and height over the eye.
vec4 plane_of(const Triangle triangle) { return vec4(triangle.normal, triangle.distance); }

#ifndef SHAPES_IN_BEAMS
#include "hit.glsl"

// Edge functions as volumes d·(p × q): the two triangles at a shared edge compute the same value
// with opposite sign, so no ray passes between them. t from the geometric plane.
real distance_to(const Triangle triangle, const Ray ray, bool from_eye, real most, bool any, inout real2 local) {
    real3 a = from_eye ? triangle.a : triangle.a - ray.origin;
    real3 b = from_eye ? triangle.b : triangle.b - ray.origin;
    real3 c = from_eye ? triangle.c : triangle.c - ray.origin;
    real3 edges = real3(dot3(ray.direction, cross3(b, c)), dot3(ray.direction, cross3(c, a)),
                 dot3(ray.direction, cross3(a, b)));
    bool front = edges.x >= 0.0 && edges.y >= 0.0 && edges.z >= 0.0;
    bool back = edges.x <= 0.0 && edges.y <= 0.0 && edges.z <= 0.0;
    bool degenerate = edges == real3(0.0);
    real height = triangle.distance;
    if (!from_eye) {
        real above = height - dot3(triangle.normal, ray.origin);
        height = above;
    }
    real t = height / dot3(triangle.normal, ray.direction);
    return (front || back) && !degenerate ? t : -1.0;
}

// Barycentric weights of a point of the triangle, from the vectors to its corners: a ray's edge functions err
// by its distance, these by the triangle's own size.
real3 weights(const Triangle triangle, real3 point) {
    real3 a = triangle.a - point;
    real3 b = triangle.b - point;
    real3 c = triangle.c - point;
    real3 n = triangle.normal;
    real3 areas = real3(dot3(n, cross3(b, c)), dot3(n, cross3(c, a)), dot3(n, cross3(a, b)));
    real scale = 1.0 / ((areas.x + areas.y) + areas.z);
    return areas * scale;
}

// Gradients of the weights: at right angles to the opposite side, 1 over the height.
void weight_gradients(const Triangle triangle, inout vec3 wa, inout vec3 wb, inout vec3 wc) {
    real3 n = triangle.normal;
    real3 ab = triangle.b - triangle.a;
    real3 bc = triangle.c - triangle.b;
    real3 ca = triangle.a - triangle.c;
    real twice_area = dot3(n, cross3(ab, bc));
    wa = vec3(cross3(n, bc) / twice_area);
    wb = vec3(cross3(n, ca) / twice_area);
    wc = vec3(cross3(n, ab) / twice_area);
}

Surface surface_of(const Triangle triangle, real3 point, real2 vertex_uv) {
    real3 w = weights(triangle, point);
    real2 uv = real2(dot3(w, real3(triangle.u_a, triangle.u_b, triangle.u_c)), dot3(w, triangle.v));
    real3 n = triangle.normal;
    real3 normal = n;
    mat3 shape_operator = FLAT;
    vec3 own_u = vec3(0.0);
    vec3 own_v = vec3(0.0);
    vec3 wa = vec3(0.0);
    vec3 wb = vec3(0.0);
    vec3 wc = vec3(0.0);
    if (FILTERED || BUMPED) {
        weight_gradients(triangle, wa, wb, wc);
        own_u = wa * float(triangle.u_a) + wb * float(triangle.u_b) + wc * float(triangle.u_c);
        own_v = wa * float(triangle.v.x) + wb * float(triangle.v.y) + wc * float(triangle.v.z);
    }
    if (SMOOTH_NORMALS && triangle.is_smooth) {
        real3 blend = (w.x * triangle.normal_a + w.y * triangle.normal_b) + w.z * triangle.normal_c;
        real squared = dot3(blend, blend);
        real length_scale = inverse_root(squared);
        real3 unit = blend * length_scale;
        normal = squared > 0.0 ? unit : normal;
        if (NEEDS_SHAPE_OPERATOR && squared > 0.0) {
            mat3 change = outerProduct(vec3(triangle.normal_a), wa) + outerProduct(vec3(triangle.normal_b), wb) +
                          outerProduct(vec3(triangle.normal_c), wc);
            // The normal keeps unit length: its change along itself vanishes.
            vec3 along = vec3(normal);
            shape_operator = (change - outerProduct(along, along * change)) * float(length_scale);
        }
    }
    float curvature = 0.5 * (shape_operator[0][0] + shape_operator[1][1] + shape_operator[2][2]);
    return Surface(point, n, normal, uv, own_u, own_v, shape_operator, curvature, false, links_of(triangle), point, largest_part(point),
                   NO_ATTRIBUTES);
}

#endif

#ifdef SHAPES_IN_CONES
#include "../cone.glsl"

// A point as a place of the disc, homogeneous.
vec3 in_disc(const Cone cone, vec3 point) {
    vec3 p = point - cone.ray.origin;
    float t = dot3(cone.ray.direction, p) / dot3(cone.ray.direction, cone.ray.direction);
    return vec3(dot3(cone.x, p), dot3(cone.y, p), cone.width + cone.spread * t);
}

// Two triangles at a shared edge get the same line with opposite sign.
bool cut_by_shape(const Cone cone, const Triangle triangle) {
    vec3 a = in_disc(cone, triangle.a);
    vec3 b = in_disc(cone, triangle.b);
    vec3 c = in_disc(cone, triangle.c);
    float height = triangle.distance - dot3(triangle.normal, cone.ray.origin);
    float side = height < 0.0 ? -1.0 : 1.0;
    vec2 tilt = vec2(dot3(triangle.normal, cone.x), dot3(triangle.normal, cone.y));
    cut_by(vec3((-side * cone.width) * tilt, side * height));
    cut_by(side * cross3(a, b));
    cut_by(side * cross3(b, c));
    cut_by(side * cross3(c, a));
    return true;
}

// A hit of a ray within the outline.
void complete(const Triangle triangle, const Ray ray, inout Hit hit) {}

vec4 tangent_plane(const Triangle triangle, const Cone cone, float t) { return plane_of(triangle); }
#endif

#ifdef SHAPES_IN_BEAMS
#include "../projective.glsl"

bool has_smooth_normals(const Triangle triangle) { return SMOOTH_NORMALS && triangle.is_smooth; }

// Barycentric weights of a triangle's corners times their sum, positive within it.
mat3 edge_forms(const Header header, const PixelFrustum frame, const Triangle triangle) {
    bool parallel = is_parallel(header);
    vec3 way = frame.same;
    vec3 start = parallel ? vec3(0.0) : way;
    vec3 a = triangle.a - start;
    vec3 b = triangle.b - start;
    vec3 c = triangle.c - start;
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

// Adds the lines of its edges.
void add_outline(const Header header, const PixelFrustum frame, vec3 near, const Triangle triangle, inout ConvexRegion region) {
    mat3 edges = edge_forms(header, frame, triangle);
    region.lines[1] = edges[0];
    region.lines[2] = edges[1];
    region.lines[3] = edges[2];
    region.count = 4u;
}

// Texture coordinates, interpolated between the corners.
RationalMap own_coordinates(const Header header, const PixelFrustum frame, vec3 near, const Triangle triangle, const UvProjection map) {
    mat3 e = edge_forms(header, frame, triangle);
    vec3 u = triangle.u_a * e[0] + triangle.u_b * e[1] + triangle.u_c * e[2];
    vec3 v = triangle.v.x * e[0] + triangle.v.y * e[1] + triangle.v.z * e[2];
    return RationalMap(u, v, e[0] + e[1] + e[2]);
}

// The lines of its edges on another surface of this inverse depth, seen from the light.
void add_shadow(const Header header, const PixelFrustum frame, vec3 near, const Light light, vec4 plane, float rise,
                inout ConvexRegion region, const Triangle triangle) {
    bool point_light = MODE_IS(LIGHT_KINDS, LIGHT_POINT, light.kind);
    vec3 place = point_light ? light.position : light.direction;
    vec3 start = point_light ? place : vec3(0.0);
    mat3 corners = mat3(triangle.a - start, triangle.b - start, triangle.c - start);
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
}

// Error of edge functions in f32, relative to the lengths of their vectors: 32 ulps.
const float ROUNDING = 4e-6;

// A ray meets a triangle where all three edge functions have one sign. These are affine in the
// ray's place, so that their corners' extremes bound them.
bool may_meet(const Header header, const PixelFrustum frame, uint polygon, const Triangle triangle) {
    vec3 ahead = vec3(dot3(triangle.a, header.forward), dot3(triangle.b, header.forward),
                      dot3(triangle.c, header.forward));
    if (max(max(ahead.x, ahead.y), ahead.z) <= 0.0) return false;
    vec3 least = vec3(3e38);
    vec3 most = vec3(-3e38);
    for (uint k = 0u; k < counts[polygon]; k++) {
        vec3 way;
        vec3 origin;
        ray_at(header, frame, corner(polygon, k), way, origin);
        vec3 a = triangle.a - origin;
        vec3 b = triangle.b - origin;
        vec3 c = triangle.c - origin;
        vec3 edges = vec3(dot3(way, cross3(b, c)), dot3(way, cross3(c, a)), dot3(way, cross3(a, b)));
        vec3 squares = vec3(dot3(a, a), dot3(b, b), dot3(c, c));
        vec3 slack = ROUNDING * sqrt(dot3(way, way)) * sqrt(squares.yzx) * sqrt(squares.zxy);
        least = min(least, edges - slack);
        most = max(most, edges + slack);
    }
    bool front = most.x >= 0.0 && most.y >= 0.0 && most.z >= 0.0;
    bool back = least.x <= 0.0 && least.y <= 0.0 && least.z <= 0.0;
    return front || back;
}
#endif

#endif
