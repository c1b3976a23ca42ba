// Model `metallic-roughness` (glTF 2.0, Appendix B): facets that follow GGX over a diffuse body, whose reflectance is
// Schlick's between that head-on and that at grazing angles. What facets lose to other facets comes back by the factor
// 1 + F0 (1 - E) / E (Turquin 2019), and the body has what the facets do not reflect, so that a white surface returns all
// light. Where light passes the body, that is part of what the diffuse lobe would have (KHR_materials_transmission). E and
// the part of it that Schlick's term has are tables of cosine and roughness. Twin:
// src/oracle/bsdf/metallic_roughness.rs.
#ifndef METALLIC_ROUGHNESS_GLSL
#define METALLIC_ROUGHNESS_GLSL

#include "facets.glsl"

// Below, highlights of points would be narrower than f32 resolves.
const float LEAST_ROUGHNESS = 0.03;

// What facets reflect of light from a direction: all of it at a reflectance of 1, and the part of Schlick's term.
vec2 facet_share(float cosine, float roughness) {
    float side = float(FACET_TABLE_SIDE - 1u);
    float x = sqrt(cosine) * side;
    float y = roughness * side;
    uint column = min(uint(x), FACET_TABLE_SIDE - 2u);
    uint row = min(uint(y), FACET_TABLE_SIDE - 2u);
    uint at = row * FACET_TABLE_SIDE + column;
    // Two entries a record.
    vec4 here = facet_part_at(at >> 1u).values;
    vec4 next = facet_part_at((at + 1u) >> 1u).values;
    vec4 below = facet_part_at((at + FACET_TABLE_SIDE) >> 1u).values;
    vec4 last = facet_part_at((at + FACET_TABLE_SIDE + 1u) >> 1u).values;
    bool odd = (at & 1u) != 0u;
    vec2 upper = odd ? here.zw : here.xy;
    vec2 lower = odd ? below.zw : below.xy;
    upper += (x - float(column)) * ((odd ? next.xy : next.zw) - upper);
    lower += (x - float(column)) * ((odd ? last.xy : last.zw) - lower);
    return upper + (y - float(row)) * (lower - upper);
}

// A material of this model, as seen from one side. Both reflectances hold what comes back between facets.
struct MetallicRoughness {
    vec3 diffuse;  // albedo of the body
    vec3 head_on;  // reflectance of facets that are seen head-on
    vec3 grazing;  // and at grazing angles
    float alpha;
    float bounced;    // share of a sample's bounces that facets have
    vec3 transmitted; // share of light that passes the body
    vec2 passing;     // share of a sample's rays that do: without those of the diffuse lobe, and with them
};

// Rec. 709 luminance.
float luminance(vec3 color) {
    return dot3(color, vec3(0.2126, 0.7152, 0.0722));
}

// `dielectric`: reflectance of the body's surface that is seen head-on; `edge`: at grazing angles; `transmission`: share of
// what enters the body that passes it.
MetallicRoughness metallic_roughness(vec3 color, float metallic, float roughness, vec3 dielectric, float edge, float transmission,
                                     float cosine) {
    float rough = max(min(roughness, 1.0), LEAST_ROUGHNESS);
    vec2 share = facet_share(max(min(cosine, 1.0), 0.0), rough);
    float lost = (1.0 - share.x) / share.x;
    vec3 body_gain = vec3(1.0) + dielectric * lost;
    vec3 metal_gain = vec3(1.0) + color * lost;
    vec3 body = (dielectric * (share.x - share.y) + vec3(edge * share.y)) * body_gain;
    vec3 diffuse = color * (1.0 - metallic) * max(vec3(1.0) - body, vec3(0.0));
    vec3 head_on = dielectric * body_gain;
    head_on += metallic * (color * metal_gain - head_on);
    vec3 grazing = edge * body_gain;
    grazing += metallic * (metal_gain - grazing);
    float bounced = luminance(head_on * (share.x - share.y) + grazing * share.y);
    vec3 transmitted = vec3(0.0);
    vec2 passing = vec2(0.0);
    if (TRANSMISSIVE) {
        transmitted = diffuse * transmission;
        diffuse -= transmitted;
        float passed = luminance(transmitted);
        if (passed > 0.0) passing = vec2(passed) / (vec2(bounced + passed) + vec2(0.0, luminance(diffuse)));
    }
    float all = bounced + luminance(diffuse);
    return MetallicRoughness(diffuse, head_on, grazing, rough * rough, all > 0.0 ? bounced / all : 1.0, transmitted, passing);
}

// Density of facets around the half vector, over pi (Walter et al. 2007), by the cross product: near the normal a cosine
// says nothing of the angle.
float facet_density(vec3 n, vec3 half_way, float alpha) {
    vec3 across = cross3(n, half_way);
    float cosine = dot3(n, half_way);
    float root = alpha / (dot3(across, across) + alpha * alpha * cosine * cosine);
    return cosine > 0.0 ? root * root : 0.0;
}

// (1 - cos)^5.
float schlick(float cosine) {
    float rest = max(1.0 - cosine, 0.0);
    float squared = rest * rest;
    return squared * squared * rest;
}

// The lobes of facets over 1/pi: that of the reflectance head-on, and that of the one at grazing angles.
vec2 facet_lobes(vec3 n, vec3 direction, vec3 way, float alpha) {
    vec3 view = direction * -inversesqrt(dot3(direction, direction));
    vec3 light = way * inversesqrt(dot3(way, way));
    vec3 sum = view + light;
    vec3 half_way = sum * inversesqrt(max(dot3(sum, sum), 1e-30));
    float seen = max(dot3(n, view), 1e-4);
    float lit = max(dot3(n, light), 0.0);
    float masked = lit * smith(seen, alpha) + seen * smith(lit, alpha);
    float lobe = 0.5 * facet_density(n, half_way, alpha) / max(masked, 1e-30);
    float rise = schlick(dot3(view, half_way));
    return vec2(lobe * (1.0 - rise), lobe * rise);
}

// Density over solid angle with which `visible_normal` mirrors a view that way.
float mirrored_density(vec3 n, vec3 direction, vec3 way, float alpha) {
    vec3 view = direction * -inversesqrt(dot3(direction, direction));
    vec3 light = way * inversesqrt(dot3(way, way));
    vec3 sum = view + light;
    vec3 half_way = sum * inversesqrt(max(dot3(sum, sum), 1e-30));
    float seen = max(dot3(n, view), 1e-4);
    return facet_density(n, half_way, alpha) * (0.5 / PI) / (seen + smith(seen, alpha));
}

#endif
