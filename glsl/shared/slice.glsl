// The pixel of a thread: the film, and the part of it that one submission renders. Tiles of 64 × 64 pixels
// are visited in an order that spreads each slice over the picture, so that a slice's time predicts that of
// the next.
#ifndef SLICE_GLSL
#define SLICE_GLSL

#include "schema/blocks.glsl"
#include "layout.glsl"

layout(local_size_x_id = 0, local_size_y_id = 1, local_size_z = 1) in;

layout(std430, set = 0, binding = BINDING_OUTPUT) buffer Film { vec4 film[]; };

layout(push_constant) uniform Push { Slice slice; };

uint schedule() { return OPAQUE(slice.schedule); }
uint first_sample() { return OPAQUE(slice.first_sample); }
uint sample_count() { return OPAQUE(slice.sample_count); }

// Returns the tile of a place in tile order: place · stride modulo the number of tiles. CPU devices divide integers lane by
// lane, so it is a quotient in floats, which is off by one at most.
uint tile_at(uint place) {
    uint times = uint(float(place) * (float(slice.tile_stride) / float(slice.tiles)));
    int rest = int(place * slice.tile_stride - times * slice.tiles);
    rest += rest < 0 ? int(slice.tiles) : 0;
    rest -= rest >= int(slice.tiles) ? int(slice.tiles) : 0;
    return uint(rest);
}

// Returns the pixel of the film. Workgroups of a tile follow each other in x, tiles in y.
uvec2 film_pixel() {
    uint tile = tile_at(slice.first_tile + gl_WorkGroupID.y);
    // In the middle of a tile's share, which no rounding moves to another row.
    uint row = uint((float(tile) + 0.5) / float(slice.tiles_x));
    uvec2 origin = uvec2(tile - row * slice.tiles_x, row) * TILE;
    uint across = TILE / gl_WorkGroupSize.x;
    uvec2 group = uvec2(gl_WorkGroupID.x % across, gl_WorkGroupID.x / across);
    return origin + group * gl_WorkGroupSize.xy + gl_LocalInvocationID.xy;
}

// Returns false for pixels of tiles that are outside of the picture.
bool in_film(const Header header, uvec2 place) { return place.x < header.film_size.x && place.y < slice.band_height; }

// Returns the pixel of the whole picture, before any crop.
uvec2 picture_pixel(const Header header, uvec2 place) { return uvec2(place.x, place.y + slice.band_y) + header.crop; }

uint film_index(const Header header, uvec2 place) { return place.y * header.film_size.x + place.x; }

#endif
