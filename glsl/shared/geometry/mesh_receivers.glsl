// What a pixel sees of a mesh where a directional light may shine.
#ifndef MESH_RECEIVERS_GLSL
#define MESH_RECEIVERS_GLSL

#include "mesh_lists.glsl"
#include "mesh_shade_region.glsl"

ShadeRegion shade_region;

// Adds what the pixel sees of a triangle to the region.
void receive(const Held held, const PixelRays rays) {
    Receiver receiver = receiver_of(held.at != 0u, vec3(held.a), vec3(held.b), vec3(held.c));
    shade_region = joined(shade_region, region_of(receiver, rays.way, rays.x, rays.y));
}

// Sets up the region of what the pixel sees, of a little more rays than there are.
void receive_all(const Header header, uvec2 pixel, Candidates marked) {
    set_shade_frame(vec3(light_at(0u).direction));
    shade_region = EMPTY_REGION;
    PixelRays rays = pixel_rays(header, pixel);
    rays.x = (1.001 * header.filter_radius) * vec3(header.step_x);
    rays.y = (1.001 * header.filter_radius) * vec3(header.step_y);
    if (GROUPED || TEAMED) {
        while (any_left(marked)) receive(held_triangle(listed_texel(marked, first_of(marked))), rays);
    } else {
#define RECEIVE(k) if (k < HELD_TRIANGLES) receive(held_##k, rays);
        EACH_HELD(RECEIVE)
#undef RECEIVE
    }
    shade_region = widened(shade_region);
}

#endif
