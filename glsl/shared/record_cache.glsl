// The lists of the scene buffer as functions of an index: of records that each thread holds, or reads.
#ifndef RECORD_CACHE_GLSL
#define RECORD_CACHE_GLSL

// Lists of known, small length are read once, before any branch: some compilers (lavapipe's) read a
// buffer lane by lane inside control flow. An index that is not known at build time then selects
// among registers.
#define CACHED_LIST(Type, RECORD, held, hold, at, LENGTH, BEGIN, UNITS)                            \
    Type held[LENGTH == DYNAMIC || LENGTH == 0u ? 1u : LENGTH];                                  \
    void hold() {                                                                                \
        if (LENGTH == DYNAMIC) return;                                                           \
        for (uint i = 0u; i < LENGTH; i++) held[i] = RECORD(READ_HEAD, BEGIN + i * UNITS);       \
    }                                                                                            \
    Type at(uint index) {                                                                        \
        if (LENGTH == DYNAMIC) return RECORD(READ_SCENE, BEGIN + index * UNITS);                 \
        Type found = held[0];                                                                    \
        for (uint i = 1u; i < LENGTH; i++) {                                                     \
            if (i == index) found = held[i];                                                     \
        }                                                                                        \
        return found;                                                                            \
    }

CACHED_LIST(Plane, PLANE, cached_planes, preload_planes, plane_at, PLANES, PLANES_AT, PLANE_UNITS)
CACHED_LIST(Sphere, SPHERE, cached_spheres, preload_spheres, sphere_at, SPHERES, SPHERES_AT, SPHERE_UNITS)
CACHED_LIST(Triangle, TRIANGLE, cached_triangles, preload_triangles, triangle_at, TRIANGLES, TRIANGLES_AT, TRIANGLE_UNITS)
CACHED_LIST(Light, LIGHT, cached_lights, preload_lights, light_at, LIGHTS, LIGHTS_AT, LIGHT_UNITS)
CACHED_LIST(Material, MATERIAL, cached_materials, preload_materials, material_at, MATERIALS, MATERIALS_AT, MATERIAL_UNITS)
CACHED_LIST(UvProjection, MAP, cached_maps, preload_maps, map_at, MAPS, MAPS_AT, UVPROJECTION_UNITS)
CACHED_LIST(Texture, TEXTURE, cached_textures, preload_textures, texture_at, TEXTURES, TEXTURES_AT, TEXTURE_UNITS)
CACHED_LIST(Sampler, SAMPLER, cached_samplers, preload_samplers, sampler_at, SAMPLERS, SAMPLERS_AT, SAMPLER_UNITS)
CACHED_LIST(Procedural, PROCEDURAL, cached_procedurals, preload_procedurals, procedural_at, PROCEDURALS, PROCEDURALS_AT,
          PROCEDURAL_UNITS)
CACHED_LIST(Motion, MOTION, cached_motions, preload_motions, motion_at, MOTIONS, MOTIONS_AT, MOTION_UNITS)

void preload_records() {
    preload_planes();
    preload_spheres();
    preload_triangles();
    preload_lights();
    preload_materials();
    preload_maps();
    preload_textures();
    preload_samplers();
    preload_procedurals();
    preload_motions();
}

#endif
