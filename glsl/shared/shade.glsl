// Ray -> radiance. Unlit: colour. Lambert: albedo/pi · I cos/r² (point) or albedo/pi · E cos
// (directional), hard shadows. Mirror: colour times what the mirrored ray sees, at most `max depth`
// times, then black. Every shape is two-sided: its normal is turned towards the incoming ray.
#ifndef SHADE_GLSL
#define SHADE_GLSL

#include "intersect.glsl"
#include "mapping.glsl"
#include "texture.glsl"

struct Surface {
    vec3 point;
    vec3 geometric_normal; // unit, towards the incoming ray
    vec3 normal;           // unit, for shading
    vec2 vertex_uv;
    uvec2 link; // material, map
};

Surface plane_surface(Plane plane, vec3 point) {
    return Surface(point, plane.normal.xyz, plane.normal.xyz, vec2(0.0), plane.link.xy);
}

// The hit is put back on the sphere: the error of t does not reach the normal or the next ray.
Surface sphere_surface(Sphere sphere, vec3 point) {
    precise vec3 radial = point - sphere.ball.xyz;
    precise vec3 normal = radial / sqrt(dot3(radial, radial));
    precise vec3 on_sphere = sphere.ball.xyz + sphere.ball.w * normal;
    return Surface(on_sphere, normal, normal, vec2(0.0), sphere.link.xy);
}

Surface triangle_surface(Triangle triangle, vec3 point, vec2 weights) {
    precise vec3 w = vec3((1.0 - weights.x) - weights.y, weights);
    vec2 uv = vec2(dot3(w, vec3(triangle.a.w, triangle.b.w, triangle.c.w)), dot3(w, triangle.v.xyz));
    vec3 normal = triangle.normal.xyz;
    if (SMOOTH_NORMALS && triangle.v.w != 0.0) {
        precise vec3 blend = (w.x * triangle.normal_a.xyz + w.y * triangle.normal_b.xyz) + w.z * triangle.normal_c.xyz;
        float squared = dot3(blend, blend);
        precise vec3 unit = blend / sqrt(squared);
        normal = squared > 0.0 ? unit : normal;
    }
    return Surface(point, triangle.normal.xyz, normal, uv, triangle.link.xy);
}

Surface hit_surface(Header header, Ray ray, Hit hit, bool from_eye) {
    uint planes = COUNT(PLANES, header.counts.x);
    uint spheres = COUNT(SPHERES, header.counts.y);
    uint triangles = COUNT(TRIANGLES, header.counts.z);
    precise vec3 point = from_eye ? hit.t * ray.direction : ray.origin + hit.t * ray.direction;
    Surface surface = Surface(point, vec3(0.0), vec3(0.0), vec2(0.0), uvec2(0u));
    // A list of one needs no index, a scene of one kind no test.
    if (planes > 0u && (spheres + triangles == 0u || hit.shape < planes)) {
        surface = plane_surface(load_plane(INDEX(PLANES, hit.shape)), point);
    } else if (spheres > 0u && (triangles == 0u || hit.shape < planes + spheres)) {
        surface = sphere_surface(load_sphere(INDEX(SPHERES, hit.shape - planes)), point);
    } else if (triangles > 0u) {
        surface = triangle_surface(load_triangle(INDEX(TRIANGLES, hit.shape - planes - spheres)), point, hit.weights);
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
        vec2 uv = texture_coordinate(load_map(INDEX(MAPS, surface.link.y)), surface.point, surface.vertex_uv);
        precise vec3 product = color * look_up(load_texture(INDEX(TEXTURES, material.link.y)),
                                               load_sampler(INDEX(SAMPLERS, material.link.z)), material.link.w, uv).xyz;
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
        Light light = load_light(i);
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

vec3 radiance(Header header, Ray ray) {
    vec3 throughput = vec3(1.0);
    vec3 result = vec3(0.0);
    uint skip = NO_SHAPE;
    uint last = BOUNCES ? header.size.w : 0u;
    for (uint depth = 0u; depth <= last; depth++) {
        Hit hit = nearest_hit(header, ray, skip, ORIGIN_IS_EYE);
        if (hit.shape == NO_SHAPE) {
            result = throughput * header.background.xyz;
            break;
        }
        Surface surface = hit_surface(header, ray, hit, ORIGIN_IS_EYE);
        Material material = load_material(INDEX(MATERIALS, surface.link.x));
        vec3 color = surface_color(material, surface);
        if (MODE_IS(MODELS, MODEL_UNLIT, material.link.x)) {
            result = throughput * color;
            break;
        }
        if (MODE_IS(MODELS, MODEL_LAMBERT, material.link.x)) {
            result = throughput * color * direct_light(header, surface, hit.shape);
            break;
        }
        throughput *= color;
        ray = Ray(offset_origin(surface.point, surface.geometric_normal), mirrored(ray.direction, surface.normal));
        skip = hit.shape;
    }
    return result;
}

#endif
