// Shading normals that differ from the geometric one, by interpolation or by a bump map: a reflected ray may
// then enter the surface, a refracted one may not. Such rays are raised to the horizon, and the normal
// becomes the one that reflects them there (Keller et al. 2017, "The Iray Light Transport Simulation and
// Rendering System"), as far above it as in Cycles (`ensure_valid_specular_reflection`). Twin:
// src/oracle/shading_normal.rs.
#ifndef SHADING_NORMAL_GLSL
#define SHADING_NORMAL_GLSL

#include "bsdf/mirror.glsl"
#include "geometry/hit.glsl"

const bool LEANING = SMOOTH_NORMALS || BUMPED;

// Returns the least cosine with the geometric normal. `flat_cosine` is that of a surface whose normals
// coincide, whose rays stay unchanged.
real least_cosine(real flat_cosine) { return min(0.9 * flat_cosine, 0.01); }

// Rotates the unit vector `way` towards the unit vector g until their cosine is `least`.
real3 raised(real3 way, real3 g, real least) {
    real cosine = dot3(way, g);
    if (cosine >= least) return way;
    real3 along = way - cosine * g;
    real squared = dot3(along, along);
    real3 result = (sqrt(1.0 - least * least) * inverse_root(squared)) * along + least * g;
    return squared > 0.0 ? result : g;
}

// Flips the shading normal towards the ray, and moves it towards the geometric one until it reflects the ray
// to the surface's own side.
void consistent_normal(real3 direction, inout Surface surface) {
    if (!LEANING) return;
    real3 view = -inverse_root(dot3(direction, direction)) * direction;
    if (dot3(view, surface.normal) < 0.0) {
        surface.normal = -surface.normal;
        surface.shape_operator = -surface.shape_operator;
        surface.curvature = -surface.curvature;
    }
    real least = least_cosine(dot3(view, surface.geometric_normal));
    real3 way = mirrored(-view, surface.normal);
    if (dot3(way, surface.geometric_normal) >= least) return;
    real3 both = view + raised(way, surface.geometric_normal, least);
    surface.normal = both * inverse_root(dot3(both, both));
}

// Returns the direction of a ray that leaves on the side of n and g, the shading and the geometric normal, or
// by a facet around n: a direction that is above n alone is raised above g.
real3 on_its_side(real3 direction, real3 way, real3 n, real3 g) {
    real size = sqrt(dot3(way, way));
    real3 unit = way / size;
    real cosine = min(dot3(unit, n), abs(dot3(direction, g)) * inverse_root(dot3(direction, direction)));
    real least = least_cosine(cosine);
    bool stays = dot3(unit, g) >= least || cosine <= 0.0;
    real3 other = raised(unit, g, least) * size;
    return stays ? way : other;
}

#endif
