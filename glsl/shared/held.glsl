// The lists of the scene buffer as functions of an index: of records that each thread holds, or reads.
#ifndef HELD_GLSL
#define HELD_GLSL

// Lists of known, small length are read once, before any branch: some compilers (lavapipe's) read a
// buffer lane by lane inside control flow. An index that is not known at build time then selects
// among registers.
#define HELD_LIST(Type, RECORD, held, hold, at, LENGTH, BEGIN, UNITS)                            \
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

HELD_LIST(Plane, PLANE, held_planes, hold_planes, plane_at, PLANES, PLANES_AT, PLANE_UNITS)
HELD_LIST(Sphere, SPHERE, held_spheres, hold_spheres, sphere_at, SPHERES, SPHERES_AT, SPHERE_UNITS)
HELD_LIST(Triangle, TRIANGLE, held_triangles, hold_triangles, triangle_at, TRIANGLES, TRIANGLES_AT, TRIANGLE_UNITS)
HELD_LIST(Light, LIGHT, held_lights, hold_lights, light_at, LIGHTS, LIGHTS_AT, LIGHT_UNITS)
HELD_LIST(Material, MATERIAL, held_materials, hold_materials, material_at, MATERIALS, MATERIALS_AT, MATERIAL_UNITS)
HELD_LIST(Map, MAP, held_maps, hold_maps, map_at, MAPS, MAPS_AT, MAP_UNITS)
HELD_LIST(Texture, TEXTURE, held_textures, hold_textures, texture_at, TEXTURES, TEXTURES_AT, TEXTURE_UNITS)
HELD_LIST(Sampler, SAMPLER, held_samplers, hold_samplers, sampler_at, SAMPLERS, SAMPLERS_AT, SAMPLER_UNITS)
HELD_LIST(Procedural, PROCEDURAL, held_procedurals, hold_procedurals, procedural_at, PROCEDURALS, PROCEDURALS_AT,
          PROCEDURAL_UNITS)
HELD_LIST(Motion, MOTION, held_motions, hold_motions, motion_at, MOTIONS, MOTIONS_AT, MOTION_UNITS)

void hold_scene() {
    hold_planes();
    hold_spheres();
    hold_triangles();
    hold_lights();
    hold_materials();
    hold_maps();
    hold_textures();
    hold_samplers();
    hold_procedurals();
    hold_motions();
}

#endif
