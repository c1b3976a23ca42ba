// Direct lighting: the contribution of all lights by way of a material (`bsdf`): I cos/r² of a point light, E
// cos of a directional light; area lights are sampled at one point. Twin: src/oracle/light.rs.
#ifndef LIGHT_GLSL
#define LIGHT_GLSL

#include "bsdf/scattering.glsl"
#include "environment.glsl"
#include "sample_dimensions.glsl"
#include "rectangle.glsl"
#include "geometry/rays.glsl"

// Shadow rays end at this fraction of the distance to an area light, as shapes beyond it are the light
// itself.
const float BEFORE_LIGHT = 4095.0 / 4096.0;

// The vector to a point on a light, the ray parameter up to which shapes occlude it, and the irradiance there
// over the light's power and the cosine.
struct Aim {
    real3 way;
    float reach;
    float density;
};

// Samples the cone that the sphere subtends uniformly; from inside the sphere, all directions. With the
// radiance I / (pi R²) a direction represents the cone's solid angle 2 pi h, h = 1 - cos of its half angle.
Aim sphere_aim(const Light light, real3 point, vec2 square) {
    vec3 way = vec3(light.position - point);
    float radius = float(light.radius);
    float squared = max(dot3(way, way), 1e-30);
    float sine = radius * radius / squared; // squared
    bool outside = sine < 1.0;
    float both = 1.0 + sqrt(max(1.0 - sine, 0.0));
    vec3 local = on_cap(concentric_disc(square), outside ? sine / both : 2.0);
    float away = squared * (local.x * local.x + local.y * local.y);
    float half_chord = sqrt(max(radius * radius - away, 0.0));
    float reach = sqrt(squared) * local.z + (outside ? -half_chord : half_chord);
    float density = outside ? 2.0 / (squared * both) : 4.0 / (radius * radius);
    return Aim(around(way * inversesqrt(squared), local), reach * BEFORE_LIGHT, density);
}

// Samples the solid angle uniformly; if it is small, or the edges are not at right angles, the area, which is
// the length of the edges' cross product: cos / r² with cos' of the light.
Aim rectangle_aim(const Light light, real3 point, vec2 square) {
    vec2 p = square - 0.5;
    real3 to_middle = light.position - point;
    vec2 sides = vec2(light.length_u, light.length_v);
    if (sides.x > 0.0) {
        vec3 x = vec3(light.edge_u) / sides.x;
        vec3 y = vec3(light.edge_v) / sides.y;
        vec3 n = cross3(x, y);
        vec3 m = vec3(to_middle);
        float height = -dot3(m, n);
        vec4 seen = on_rectangle(vec2(dot3(m, x), dot3(m, y)), 0.5 * sides, max(height, 0.0), square);
        if (height > 0.0 && seen.w >= MIN_SOLID_ANGLE) {
            vec3 way = (seen.x * x + seen.y * y) + seen.z * n;
            return Aim(real3(way), BEFORE_LIGHT, seen.w * inversesqrt(dot3(way, way)));
        }
    }
    real3 way = to_middle + (p.x * light.edge_u + p.y * light.edge_v);
    float squared = float(dot3(way, way));
    float leaving = float(-dot3(way, cross3(light.edge_u, light.edge_v)));
    float density = leaving > 0.0 ? (leaving / squared) / squared : 0.0;
    return Aim(way, BEFORE_LIGHT, density);
}

// Samples the sun's cap uniformly.
Aim sun_aim(const Light light, vec2 square) {
    return Aim(around(vec3(light.direction), on_cap(concentric_disc(square), float(light.cap_height))), FAR, 1.0);
}

// The share of its intensity that a spot, or a point with a range, has at the end of `way` (KHR_lights_punctual).
float punctual_share(const Light light, vec3 way) {
    float share = 1.0;
    float squared = dot3(way, way);
    if (MODE_IS(LIGHT_KINDS, LIGHT_SPOT, light.kind)) {
        float cosine = -dot3(way, vec3(light.direction)) * inversesqrt(squared);
        float within = min(max(light.spot_slope * cosine + light.spot_offset, 0.0), 1.0);
        share = within * within;
    }
    float part = squared * (light.inverse_range * light.inverse_range);
    return share * max(1.0 - part * part, 0.0);
}

// Samples the environment's light.
Aim sky_aim(const Header header, vec2 square) {
    SkySample sky = sampled_sky(header, square);
    return Aim(real3(sky.way), FAR, sky.density > 0.0 ? 1.0 / sky.density : 0.0);
}

// Returns what arrives along a ray up to t_max: all light, times what surfaces on the way let pass, and for light of the
// environment (`from_sky`) times its radiance there. One loop, as look-ups are most of the code; they have no footprint.
vec3 arriving_light(const Header header, Ray ray, real t_max, uint skip, bool from_sky, uvec2 random) {
    vec3 arrives = vec3(1.0);
    uint layers = TRANSPARENT && SHADOWS ? MAX_LAYERS : 0u;
    bool is_open = true; // the end of the way is not known yet
    for (uint layer = 0u; layer <= layers && is_open; layer++) {
        bool blocked = false;
        Surface surface = NOWHERE;
        surface.link = uvec2(header.environment_material, header.environment_projection);
        Hit hit = Hit(FAR, NO_SHAPE, real2(0.0));
        if (TRANSPARENT && SHADOWS) {
            meets_backs = true;
            hit = nearest_hit(ray, skip, ANYTHING);
            meets_backs = false;
            blocked = hit.shape != NO_SHAPE && hit.t < t_max;
            if (blocked) surface = hit_surface(ray, hit);
        }
        bool has_sky = LIT_BY_ENVIRONMENT && from_sky && ENVIRONMENT && header.environment_material != NO_MATERIAL;
        vec3 factor = LIT_BY_ENVIRONMENT && from_sky ? header.background : vec3(1.0);
        if (blocked || has_sky) {
            Material material = material_at(surface.link.x);
            vec4 texel = vec4(1.0);
#if SOURCE != SOURCE_NONE
            bool reads = !blocked || !MODE_IS(ALPHA_MODES, ALPHA_OPAQUE, material.alpha_mode);
            if (reads && material.texture_index != NO_TEXTURE) {
                UvProjection map = uv_projection_at(surface.link.y);
                TexCoord c = texture_coordinate(map, map_input(map, ray, at_uv_of(material, SECOND_UV_COLOR, surface), NO_FOOTPRINT));
                texel = sample_magnified(texture_at(material.texture_index), sampler_at(material.sampler_index), material.image_slot, c, random);
            }
#endif
            float alpha = material.opacity * texel.w;
            if (VERTEX_COLORS) alpha *= surface.attributes.color.w;
            factor = blocked ? vec3(1.0 - alpha_share(material, alpha)) : material.color * texel.xyz;
        }
        // Lanes whose way has ended keep what they have, even where the loop goes on for them as for others.
        vec3 product = arrives * factor;
        arrives = is_open ? product : arrives;
        is_open = is_open && blocked && arrives.x > 0.0;
        // The way that is left ends at the same point.
        t_max -= hit.t;
        ray.origin = offset_origin(surface.point, -surface.geometric_normal, surface.size);
        skip = hit.shape;
    }
    return is_open ? vec3(0.0) : arrives;
}

// `continues`: the path may go on, so that the environment is also sampled by the material.
Lit direct_light(const Header header, const Surface surface, float time, uint shape, const Bsdf bsdf, const Points points,
                 const SampleDimensions dimensions, float occlusion, bool continues, uvec2 random) {
    Lit sum = Lit(vec3(0.0), vec3(0.0), vec3(0.0));
    uint lights = COUNT(LIGHTS, lengths.lights);
    real3 start = surface.point;
    if (SHADOWS) start = offset_origin(surface.point, surface.geometric_normal, surface.size);
    for (uint i = 0u; i < lights; i++) {
        Light light = light_at(i);
        bool point_light = MODE_IS(LIGHT_KINDS, LIGHT_POINT, light.kind) || MODE_IS(LIGHT_KINDS, LIGHT_SPOT, light.kind);
        real3 way = point_light ? light.position - surface.point : light.direction;
        Aim aim = Aim(way, point_light ? 1.0 : FAR, 1.0);
        if (AREA_LIGHTS) {
            if (light.kind >= LIGHT_SPHERE) {
                vec2 square = chosen_light(points, dimensions, i);
                if (MODE_IS(LIGHT_KINDS, LIGHT_SPHERE, light.kind)) {
                    aim = sphere_aim(light, surface.point, square);
                } else if (MODE_IS(LIGHT_KINDS, LIGHT_RECTANGLE, light.kind)) {
                    aim = rectangle_aim(light, surface.point, square);
                } else if (MODE_IS(LIGHT_KINDS, LIGHT_ENVIRONMENT, light.kind)) {
                    aim = sky_aim(header, square);
                } else {
                    aim = sun_aim(light, square);
                }
                way = aim.way;
            }
        }
        float squared = float(dot3(way, way));
        float facing = float(dot3(surface.normal, way));
        // Point: cos/r² = n·l / r³ with the unnormalised l. Directional: l is a unit vector.
        float share = point_light ? (facing / squared) * inversesqrt(squared) : facing;
        if (AREA_LIGHTS) share *= aim.density;
        if (RANGED && point_light) share *= punctual_share(light, vec3(way));
        bool lit = facing > 0.0 && dot3(surface.geometric_normal, way) > 0.0;
        if (ROUGH_MIRRORS) {
            // Mirrors reflect what rays see.
            lit = lit && (MODE_IS(LIGHT_KINDS, LIGHT_ENVIRONMENT, light.kind) || !is_specular(bsdf.model));
        }
        if (lit) {
            if (SHADOWS) {
                real3 to_light = point_light ? light.position - start : way;
                if (HAS(LIGHT_KINDS, LIGHT_RECTANGLE)) {
                    // The vector to the same point from the origin of the shadow ray.
                    if (light.kind == LIGHT_RECTANGLE) to_light += surface.point - start;
                }
                if (!TRANSPARENT) lit = !occluded(Ray(start, to_light, time), aim.reach, shape, surface.geometric_normal);
                way = to_light;
            }
            vec3 power = light.power;
            vec3 lobes = evaluate(bsdf, vec3(aim.way));
            bool from_sky = MODE_IS(LIGHT_KINDS, LIGHT_ENVIRONMENT, light.kind);
            if (TRANSPARENT || LIT_BY_ENVIRONMENT) {
                power *= arriving_light(header, Ray(start, way, time), aim.reach, shape, from_sky, random);
            }
            if (LIT_BY_ENVIRONMENT) {
                if (from_sky) {
                    if (continues) lobes = balanced_lobes(bsdf, lobes, vec3(aim.way), 1.0 / max(aim.density, 1e-30));
                    lobes.x *= occlusion;
                }
            }
            vec3 more = power * (share * (1.0 / PI));
            vec3 first = sum.first + more * lobes.x;
            sum.first = lit ? first : sum.first;
            if (SECOND_LOBE) {
                vec3 second = sum.second + more * lobes.y;
                sum.second = lit ? second : sum.second;
            }
            if (THIRD_LOBE) {
                vec3 third = sum.third + more * lobes.z;
                sum.third = lit ? third : sum.third;
            }
        }
    }
    return sum;
}

#endif
