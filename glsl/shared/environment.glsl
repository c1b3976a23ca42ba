// What rays see that hit nothing, and how its light is sampled: cells of equal solid angle, rows of height and columns
// of azimuth about +y, each with the share of the light that it has (Pharr & Humphreys 2004). Twin:
// src/oracle/environment.rs.
#ifndef ENVIRONMENT_GLSL
#define ENVIRONMENT_GLSL

#include "appearance.glsl"

// A direction towards the environment, a unit vector, and its density over solid angle.
struct SkySample {
    vec3 way;
    float density;
};

// Number `i` of the distribution.
float environment_number(uint i) {
    vec4 four = environment_part_at(i >> 2u).values;
    return four[i & 3u];
}

// Returns the cell that a number in [0, 1) falls in, of `count` cells whose cumulative shares begin at `first`.
uint cell_of(uint first, uint count, float u) {
    uint low = 0u;
    for (uint left = count; left > 1u;) {
        uint step = left >> 1u;
        low += environment_number(first + low + step) <= u ? step : 0u;
        left -= step;
    }
    return low;
}

// Returns the share of a cell, and where in it a number lies.
vec2 within_cell(uint first, uint cell, float u) {
    float begin = environment_number(first + cell);
    float share = environment_number(first + cell + 1u) - begin;
    float place = share > 0.0 ? (u - begin) / share : 0.5;
    return vec2(share, min(max(place, 0.0), 1.0));
}

// Where the columns of a row begin.
uint row_begin(const Header header, uint row) {
    return header.environment_rows + 1u + row * (header.environment_columns + 1u);
}

float cell_density(const Header header, float row_share, float share) {
    return row_share * share * (float(header.environment_rows) * float(header.environment_columns) * (0.25 / PI));
}

// A sample of the environment's light.
SkySample sampled_sky(const Header header, vec2 square) {
    uint row = cell_of(0u, header.environment_rows, square.y);
    vec2 high = within_cell(0u, row, square.y);
    uint begin = row_begin(header, row);
    uint column = cell_of(begin, header.environment_columns, square.x);
    vec2 beside = within_cell(begin, column, square.x);
    float below = (float(row) + high.y) / float(header.environment_rows);
    float turn = (float(column) + beside.y) / float(header.environment_columns);
    float across = sqrt(max(4.0 * below * (1.0 - below), 0.0));
    vec3 way = vec3(across * sine_turns(turn + 0.25), 1.0 - 2.0 * below, across * sine_turns(turn));
    return SkySample(way, cell_density(header, high.x, beside.x));
}

// The density with which `sampled_sky` returns a direction.
float sky_density(const Header header, vec3 direction) {
    vec3 way = direction * inversesqrt(dot3(direction, direction));
    float turn = atan2_accurate(way.z, way.x) * (0.5 / PI);
    turn = turn < 0.0 ? turn + 1.0 : turn;
    uint row = min(uint(max(0.5 - 0.5 * way.y, 0.0) * float(header.environment_rows)), header.environment_rows - 1u);
    uint column = min(uint(turn * float(header.environment_columns)), header.environment_columns - 1u);
    uint begin = row_begin(header, row);
    float row_share = environment_number(row + 1u) - environment_number(row);
    float share = environment_number(begin + column + 1u) - environment_number(begin + column);
    return cell_density(header, row_share, share);
}

#endif
