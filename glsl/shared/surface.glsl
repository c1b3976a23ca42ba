// Hit -> what shading and mapping need to know of the place: point, normals, the shape's own texture
// coordinate with its gradients, and how the normal bends. Every shape is two-sided: its normal is
// turned towards the incoming ray. Twin: src/oracle/surface.rs.
#ifndef SURFACE_GLSL
#define SURFACE_GLSL

#include "intersect.glsl"

struct Surface {
    vec3 point;
    vec3 geometric_normal; // unit, towards the incoming ray
    vec3 normal;           // unit, for shading
    vec2 own_uv;           // the plane's coordinates or the vertices' interpolated uv
    vec3 own_u;            // gradients of the two along the surface
    vec3 own_v;
    mat3 bend;             // change of the normal a unit of way along the surface
    float curvature;       // its mean; positive where the shape bulges towards the ray
    bool inside;           // the ray comes from behind the shape's own normal
    uvec2 link;            // material, map
    vec3 at_rest;          // the point where the shape does not move
};

const mat3 FLAT = mat3(0.0);

Surface plane_surface(Plane plane, vec3 point, vec2 uv) {
    return Surface(point, plane.normal.xyz, plane.normal.xyz, uv, plane.axis_u.xyz, plane.axis_v.xyz, FLAT, 0.0,
                   false, plane.link.xy, point);
}

// The hit is put back on the sphere: the error of t does not reach the normal or the next ray.
Surface sphere_surface(Sphere sphere, vec3 point) {
    vec3 radial = point - sphere.ball.xyz;
    float scale = inversesqrt(dot3(radial, radial));
    vec3 normal = radial * scale;
    vec3 on_sphere = sphere.ball.xyz + sphere.ball.w * normal;
    float curvature = 1.0 / sphere.ball.w;
    return Surface(on_sphere, normal, normal, vec2(0.0), vec3(0.0), vec3(0.0), mat3(curvature), curvature,
                   false, sphere.link.xy, on_sphere);
}

Surface triangle_surface(Triangle triangle, vec3 point, vec3 edges) {
    float scale = 1.0 / ((edges.x + edges.y) + edges.z);
    vec3 w = edges * scale;
    vec2 uv = vec2(dot3(w, vec3(triangle.a.w, triangle.b.w, triangle.c.w)), dot3(w, triangle.v.xyz));
    vec3 n = triangle.normal.xyz;
    vec3 normal = n;
    mat3 bend = FLAT;
    vec3 own_u = vec3(0.0);
    vec3 own_v = vec3(0.0);
    vec3 wa = vec3(0.0);
    vec3 wb = vec3(0.0);
    vec3 wc = vec3(0.0);
    if (FILTERED || BUMPED) {
        // Gradients of the weights: at right angles to the opposite side, 1 over the height.
        vec3 ab = triangle.b.xyz - triangle.a.xyz;
        vec3 bc = triangle.c.xyz - triangle.b.xyz;
        vec3 ca = triangle.a.xyz - triangle.c.xyz;
        float twice_area = dot3(n, cross3(ab, bc));
        wa = cross3(n, bc) / twice_area;
        wb = cross3(n, ca) / twice_area;
        wc = cross3(n, ab) / twice_area;
        own_u = wa * triangle.a.w + wb * triangle.b.w + wc * triangle.c.w;
        own_v = wa * triangle.v.x + wb * triangle.v.y + wc * triangle.v.z;
    }
    if (SMOOTH_NORMALS && triangle.v.w != 0.0) {
        vec3 blend = (w.x * triangle.normal_a.xyz + w.y * triangle.normal_b.xyz) + w.z * triangle.normal_c.xyz;
        float squared = dot3(blend, blend);
        float length_scale = inversesqrt(squared);
        vec3 unit = blend * length_scale;
        normal = squared > 0.0 ? unit : normal;
        if (FILTERED && squared > 0.0) {
            mat3 change = outerProduct(triangle.normal_a.xyz, wa) + outerProduct(triangle.normal_b.xyz, wb) +
                          outerProduct(triangle.normal_c.xyz, wc);
            // Of unit length: what is along the normal itself is lost.
            bend = (change - outerProduct(normal, normal * change)) * length_scale;
        }
    }
    float curvature = 0.5 * (bend[0][0] + bend[1][1] + bend[2][2]);
    return Surface(point, n, normal, uv, own_u, own_v, bend, curvature, false, triangle.link.xy, point);
}

Surface hit_surface(Header header, Ray moving, Hit hit) {
    Ray ray = at_rest(header, moving, hit.shape);
    uint planes = COUNT(PLANES, header.counts.x);
    uint spheres = COUNT(SPHERES, header.counts.y);
    uint triangles = COUNT(TRIANGLES, header.counts.z);
    vec3 point = ORIGIN_IS_EYE ? hit.t * ray.direction : ray.origin + hit.t * ray.direction;
    Surface surface = Surface(point, vec3(0.0, 0.0, 1.0), vec3(0.0, 0.0, 1.0), vec2(0.0), vec3(0.0), vec3(0.0), FLAT,
                              0.0, false, uvec2(0u), point);
    // A scene of one kind of shape needs no test.
    if (planes > 0u && (spheres + triangles == 0u || hit.shape < planes)) {
        surface = plane_surface(plane_at(hit.shape), point, hit.local.xy);
    } else if (spheres > 0u && (triangles == 0u || hit.shape < planes + spheres)) {
        surface = sphere_surface(sphere_at(hit.shape - planes), point);
    } else if (triangles > 0u) {
        surface = triangle_surface(triangle_at(hit.shape - planes - spheres), point, hit.local);
    }
    if (MOTIONS != 0u) surface.point += moved_by(header, moving, hit.shape);
    bool away = dot3(surface.geometric_normal, ray.direction) > 0.0;
    surface.inside = away;
    surface.geometric_normal = away ? -surface.geometric_normal : surface.geometric_normal;
    surface.normal = away ? -surface.normal : surface.normal;
    if (FILTERED && SPHERES + TRIANGLES != 0u) {
        surface.bend = away ? -surface.bend : surface.bend;
        surface.curvature = away ? -surface.curvature : surface.curvature;
    }
    return surface;
}

#endif
