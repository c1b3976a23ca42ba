// Ray -> radiance. Unlit: colour. Lambert: albedo/pi · I cos/r² (point) or albedo/pi · E cos
// (directional), hard shadows. Mirror: colour times what the mirrored ray sees, at most `max depth`
// times, then black. Every shape is two-sided: its normal is turned towards the incoming ray.
// Twin: src/oracle/shade.rs.
#ifndef SHADE_GLSL
#define SHADE_GLSL

#include "intersect.glsl"
#include "mapping.glsl"
#include "texture.glsl"

struct Surface {
    vec3 point;
    vec3 geometric_normal; // unit, towards the incoming ray
    vec3 normal;           // unit, for shading
    vec2 own_uv;           // the plane's coordinates or the vertices' interpolated uv
    uvec2 link;            // material, map
};

Surface plane_surface(Plane plane, vec3 point, vec2 uv) {
    return Surface(point, plane.normal.xyz, plane.normal.xyz, uv, plane.link.xy);
}

// The hit is put back on the sphere: the error of t does not reach the normal or the next ray.
Surface sphere_surface(Sphere sphere, vec3 point) {
    precise vec3 radial = point - sphere.ball.xyz;
    precise float scale = 1.0 / sqrt(dot3(radial, radial));
    precise vec3 normal = radial * scale;
    precise vec3 on_sphere = sphere.ball.xyz + sphere.ball.w * normal;
    return Surface(on_sphere, normal, normal, vec2(0.0), sphere.link.xy);
}

Surface triangle_surface(Triangle triangle, vec3 point, vec3 edges) {
    precise float scale = 1.0 / ((edges.x + edges.y) + edges.z);
    precise vec3 w = edges * scale;
    vec2 uv = vec2(dot3(w, vec3(triangle.a.w, triangle.b.w, triangle.c.w)), dot3(w, triangle.v.xyz));
    vec3 normal = triangle.normal.xyz;
    if (SMOOTH_NORMALS && triangle.v.w != 0.0) {
        precise vec3 blend = (w.x * triangle.normal_a.xyz + w.y * triangle.normal_b.xyz) + w.z * triangle.normal_c.xyz;
        float squared = dot3(blend, blend);
        precise float length_scale = 1.0 / sqrt(squared);
        precise vec3 unit = blend * length_scale;
        normal = squared > 0.0 ? unit : normal;
    }
    return Surface(point, triangle.normal.xyz, normal, uv, triangle.link.xy);
}

Surface hit_surface(Header header, Ray ray, Hit hit) {
    uint planes = COUNT(PLANES, header.counts.x);
    uint spheres = COUNT(SPHERES, header.counts.y);
    uint triangles = COUNT(TRIANGLES, header.counts.z);
    precise vec3 point = ORIGIN_IS_EYE ? hit.t * ray.direction : ray.origin + hit.t * ray.direction;
    Surface surface = Surface(point, vec3(0.0), vec3(0.0), vec2(0.0), uvec2(0u));
    // A scene of one kind of shape needs no test.
    if (planes > 0u && (spheres + triangles == 0u || hit.shape < planes)) {
        surface = plane_surface(plane_at(hit.shape), point, hit.local.xy);
    } else if (spheres > 0u && (triangles == 0u || hit.shape < planes + spheres)) {
        surface = sphere_surface(sphere_at(hit.shape - planes), point);
    } else if (triangles > 0u) {
        surface = triangle_surface(triangle_at(hit.shape - planes - spheres), point, hit.local);
    }
    bool away = dot3(surface.geometric_normal, ray.direction) > 0.0;
    surface.geometric_normal = away ? -surface.geometric_normal : surface.geometric_normal;
    surface.normal = away ? -surface.normal : surface.normal;
    return surface;
}

vec3 surface_color(Material material, Surface surface) {
    vec3 color = material.color.xyz;
#if SOURCE != SOURCE_NONE
    if (TEXTURED && (!UNTEXTURED || material.link.y != NO_TEXTURE)) {
        vec2 uv = texture_coordinate(map_at(surface.link.y), surface.point, surface.own_uv);
        precise vec3 product = color * look_up(texture_at(material.link.y),
                                               sampler_at(material.link.z), material.link.w, uv).xyz;
        color = product;
    }
#endif
    return color;
}

// Irradiance over pi from all lights: what an albedo of 1 sends on.
vec3 direct_light(Header header, Surface surface, uint shape) {
    vec3 sum = vec3(0.0);
    uint lights = COUNT(LIGHTS, header.key.y);
    vec3 start = SHADOWS ? offset_origin(surface.point, surface.geometric_normal) : surface.point;
    for (uint i = 0u; i < lights; i++) {
        Light light = light_at(i);
        bool point_light = MODE_IS(LIGHT_KINDS, LIGHT_POINT, light.link.x);
        precise vec3 way = point_light ? light.place.xyz - surface.point : light.place.xyz;
        float squared = dot3(way, way);
        float facing = dot3(surface.normal, way);
        // Point: cos/r² = n·l / r³ with the unnormalised l. Directional: l is a unit vector.
        precise float share = point_light ? facing / (squared * sqrt(squared)) : facing;
        bool lit = facing > 0.0 && dot3(surface.geometric_normal, way) > 0.0;
        if (lit) {
            if (SHADOWS) {
                precise vec3 to_light = point_light ? light.place.xyz - start : light.place.xyz;
                lit = !occluded(header, Ray(start, to_light), point_light ? 1.0 : FAR, shape);
            }
            precise vec3 more = sum + light.power.xyz * (share * (1.0 / PI));
            sum = lit ? more : sum;
        }
    }
    return sum;
}

// d - 2 (d·n) n, for unit n.
vec3 mirrored(vec3 direction, vec3 normal) {
    precise vec3 result = direction - (2.0 * dot3(direction, normal)) * normal;
    return result;
}

// A path between two hits: the ray, what it still carries, the shape that it leaves.
struct Path {
    Ray ray;
    vec3 throughput;
    uint skip;
    uint depth;
    bool goes_on; // false: the path has ended, the next one starts at the camera
};

Path camera_path(Ray ray) { return Path(ray, vec3(1.0), NO_SHAPE, 0u, true); }

// Follows the path to its next hit; what that adds to the sample is returned.
vec3 advance(Header header, inout Path path) {
    Hit hit = nearest_hit(header, path.ray, path.skip);
    vec3 seen = path.throughput * header.background.xyz;
    bool mirror = false;
    if (hit.shape != NO_SHAPE) {
        Surface surface = hit_surface(header, path.ray, hit);
        Material material = material_at(surface.link.x);
        path.throughput *= surface_color(material, surface);
        mirror = MODE_IS(MODELS, MODEL_MIRROR, material.link.x);
        vec3 light = vec3(mirror ? 0.0 : 1.0);
        if (MODE_IS(MODELS, MODEL_LAMBERT, material.link.x)) light = direct_light(header, surface, hit.shape);
        seen = path.throughput * light;
        path.ray = Ray(offset_origin(surface.point, surface.geometric_normal),
                       mirrored(path.ray.direction, surface.normal));
    }
    path.skip = hit.shape;
    path.goes_on = BOUNCES && mirror && path.depth < header.size.w;
    path.depth++;
    return seen;
}

#endif
