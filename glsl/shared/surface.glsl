// Hit -> what shading and mapping need to know of the place: point, normals, the shape's own texture
// coordinate with its gradients, and how the normal bends. Every shape is two-sided: its normal is
// turned towards the incoming ray. Twin: src/oracle/surface.rs.
#ifndef SURFACE_GLSL
#define SURFACE_GLSL

#include "intersect.glsl"

struct Surface {
    real3 point;
    real3 geometric_normal; // unit, towards the incoming ray
    real3 normal;          // unit, for shading
    real2 own_uv;          // the plane's coordinates or the vertices' interpolated uv
    vec3 own_u;            // gradients of the two along the surface
    vec3 own_v;
    mat3 shape_operator;             // change of the normal a unit of way along the surface
    float curvature;       // its mean; positive where the shape bulges towards the ray
    bool inside;           // the ray comes from behind the shape's own normal
    uvec2 link;            // material, map
    real3 at_rest;         // the point where the shape does not move
    real size;             // of the largest coordinate that the point came from
};

const mat3 FLAT = mat3(0.0);

// Whether anything asks for the change of normals: footprints that leave a mirror, or bump maps that are mapped by directions.
const bool BY_DIRECTION = (ENTITIES & ((1u << ENTITY_NORMAL) | (1u << ENTITY_REFLECTION))) != 0u;
const bool CURVED_BUMP = BUMPED && BY_DIRECTION;
const bool NEEDS_SHAPE_OPERATOR = FILTERED || CURVED_BUMP;

real largest_part(real3 v) { return max(max(abs(v.x), abs(v.y)), abs(v.z)); }

Surface plane_surface(Plane plane, real3 point, real2 uv) {
    return Surface(point, plane.normal.xyz, plane.normal.xyz, uv, vec3(plane.axis_u.xyz), vec3(plane.axis_v.xyz), FLAT,
                   0.0, false, plane.link.xy, point, largest_part(point));
}

// The hit is put back on the sphere: the error of t does not reach the normal or the next ray.
Surface sphere_surface(Sphere sphere, real3 point) {
    real3 radial = point - sphere.ball.xyz;
    real scale = inverse_root(dot3(radial, radial));
    real3 normal = radial * scale;
    real3 on_sphere = sphere.ball.xyz + sphere.ball.w * normal;
    float curvature = 1.0 / float(sphere.ball.w);
    real size = largest_part(sphere.ball.xyz) + sphere.ball.w;
    return Surface(on_sphere, normal, normal, real2(0.0), vec3(0.0), vec3(0.0), mat3(curvature), curvature,
                   false, sphere.link.xy, on_sphere, size);
}

// Barycentric weights of a point of the triangle, from the vectors to its corners: a ray's edge functions err
// by its distance, these by the triangle's own size.
real3 weights(Triangle triangle, real3 point) {
    real3 a = triangle.a.xyz - point;
    real3 b = triangle.b.xyz - point;
    real3 c = triangle.c.xyz - point;
    real3 n = triangle.normal.xyz;
    real3 areas = real3(dot3(n, cross3(b, c)), dot3(n, cross3(c, a)), dot3(n, cross3(a, b)));
    real scale = 1.0 / ((areas.x + areas.y) + areas.z);
    return areas * scale;
}

Surface triangle_surface(Triangle triangle, real3 point) {
    real3 w = weights(triangle, point);
    real2 uv = real2(dot3(w, real3(triangle.a.w, triangle.b.w, triangle.c.w)), dot3(w, triangle.v.xyz));
    real3 n = triangle.normal.xyz;
    real3 normal = n;
    mat3 shape_operator = FLAT;
    vec3 own_u = vec3(0.0);
    vec3 own_v = vec3(0.0);
    vec3 wa = vec3(0.0);
    vec3 wb = vec3(0.0);
    vec3 wc = vec3(0.0);
    if (FILTERED || BUMPED) {
        // Gradients of the weights: at right angles to the opposite side, 1 over the height.
        real3 ab = triangle.b.xyz - triangle.a.xyz;
        real3 bc = triangle.c.xyz - triangle.b.xyz;
        real3 ca = triangle.a.xyz - triangle.c.xyz;
        real twice_area = dot3(n, cross3(ab, bc));
        wa = vec3(cross3(n, bc) / twice_area);
        wb = vec3(cross3(n, ca) / twice_area);
        wc = vec3(cross3(n, ab) / twice_area);
        own_u = wa * float(triangle.a.w) + wb * float(triangle.b.w) + wc * float(triangle.c.w);
        own_v = wa * float(triangle.v.x) + wb * float(triangle.v.y) + wc * float(triangle.v.z);
    }
    if (SMOOTH_NORMALS && triangle.v.w != 0.0) {
        real3 blend = (w.x * triangle.normal_a.xyz + w.y * triangle.normal_b.xyz) + w.z * triangle.normal_c.xyz;
        real squared = dot3(blend, blend);
        real length_scale = inverse_root(squared);
        real3 unit = blend * length_scale;
        normal = squared > 0.0 ? unit : normal;
        if (NEEDS_SHAPE_OPERATOR && squared > 0.0) {
            mat3 change = outerProduct(vec3(triangle.normal_a.xyz), wa) + outerProduct(vec3(triangle.normal_b.xyz), wb) +
                          outerProduct(vec3(triangle.normal_c.xyz), wc);
            // Of unit length: what is along the normal itself is lost.
            vec3 along = vec3(normal);
            shape_operator = (change - outerProduct(along, along * change)) * float(length_scale);
        }
    }
    float curvature = 0.5 * (shape_operator[0][0] + shape_operator[1][1] + shape_operator[2][2]);
    return Surface(point, n, normal, uv, own_u, own_v, shape_operator, curvature, false, triangle.link.xy, point, largest_part(point));
}

Surface hit_surface(Header header, Ray moving, Hit hit) {
    Ray ray = at_rest(header, moving, hit.shape);
    uint planes = COUNT(PLANES, header.counts.x);
    uint spheres = COUNT(SPHERES, header.counts.y);
    uint triangles = COUNT(TRIANGLES, header.counts.z);
    real3 point = ORIGIN_IS_EYE ? hit.t * ray.direction : ray.origin + hit.t * ray.direction;
    const real3 up = real3(0.0, 0.0, 1.0);
    Surface surface = Surface(point, up, up, real2(0.0), vec3(0.0), vec3(0.0), FLAT, 0.0, false, uvec2(0u), point, 0.0);
    // A scene of one kind of shape needs no test.
    if (planes > 0u && (spheres + triangles == 0u || hit.shape < planes)) {
        surface = plane_surface(plane_at(hit.shape), point, hit.local);
    } else if (spheres > 0u && (triangles == 0u || hit.shape < planes + spheres)) {
        surface = sphere_surface(sphere_at(hit.shape - planes), point);
    } else if (triangles > 0u) {
        surface = triangle_surface(triangle_at(hit.shape - planes - spheres), point);
    }
    if (MOTIONS != 0u) surface.point += moved_by(header, moving, hit.shape);
    bool away = dot3(surface.geometric_normal, ray.direction) > 0.0;
    surface.inside = away;
    surface.geometric_normal = away ? -surface.geometric_normal : surface.geometric_normal;
    surface.normal = away ? -surface.normal : surface.normal;
    if (NEEDS_SHAPE_OPERATOR && SPHERES + TRIANGLES != 0u) {
        surface.shape_operator = away ? -surface.shape_operator : surface.shape_operator;
        surface.curvature = away ? -surface.curvature : surface.curvature;
    }
    return surface;
}

#endif
