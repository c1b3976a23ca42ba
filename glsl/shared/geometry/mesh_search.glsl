// The way of a ray through the trees of meshes: the tree over all meshes begins at texel 0, or is that of the only mesh. A
// mesh that moves, or has a matrix of its own as it shares its triangles, is a leaf: boxes below it are tested in its
// space, triangles in that of the scene, as everywhere else. Twin: src/oracle/geometry/mesh_search.rs.
#ifndef MESH_SEARCH_GLSL
#define MESH_SEARCH_GLSL

#include "mesh_tests.glsl"

// Some mesh is a leaf of the tree over all.
const bool PLACED_MESHES = PLACEMENTS != 0u || MOTIONS != 0u;

const real4 ROW_X = real4(1.0, 0.0, 0.0, 0.0);
const real4 ROW_Y = real4(0.0, 1.0, 0.0, 0.0);
const real4 ROW_Z = real4(0.0, 0.0, 1.0, 0.0);
const Placement UNPLACED = Placement(ROW_X, ROW_Y, ROW_Z, ROW_X, ROW_Y, ROW_Z);

bool is_placed(const Mesh mesh) { return PLACEMENTS != 0u && mesh.placement != NO_PLACEMENT; }

Placement placement_of(const Mesh mesh) {
    Placement placement = UNPLACED;
    if (PLACEMENTS != 0u) {
        if (mesh.placement != NO_PLACEMENT) placement = placement_at(mesh.placement);
    }
    return placement;
}

real3 placed_vector(const Placement placement, real3 v) {
    if (PLACEMENTS == 0u) return v;
    return real3(dot3(placement.x.xyz, v), dot3(placement.y.xyz, v), dot3(placement.z.xyz, v));
}

real3 placed_point(const Placement placement, real3 p) {
    if (PLACEMENTS == 0u) return p;
    return placed_vector(placement, p) + real3(placement.x.w, placement.y.w, placement.z.w);
}

// By the inverse transpose.
real3 placed_normal(const Mesh mesh, const Placement placement, real3 n) {
    if (!is_placed(mesh)) return n;
    real3 m = (n.x * placement.to_mesh_x.xyz + n.y * placement.to_mesh_y.xyz) + n.z * placement.to_mesh_z.xyz;
    return m * inverse_root(dot3(m, m));
}

Ray ray_in_mesh(const Placement placement, Ray ray) {
    if (PLACEMENTS == 0u) return ray;
    real3 p = ray.origin;
    real3 d = ray.direction;
    ray.origin = real3(dot3(placement.to_mesh_x.xyz, p) + placement.to_mesh_x.w, dot3(placement.to_mesh_y.xyz, p) + placement.to_mesh_y.w,
                       dot3(placement.to_mesh_z.xyz, p) + placement.to_mesh_z.w);
    ray.direction = real3(dot3(placement.to_mesh_x.xyz, d), dot3(placement.to_mesh_y.xyz, d), dot3(placement.to_mesh_z.xyz, d));
    return ray;
}

// As distance_in of mesh_tests.glsl, of a triangle in a mesh's space, by a ray for which the mesh is at rest.
real distance_in_placed(uint at, const Placement placement, const Ray ray, bool any) {
    uvec4 first = mesh_texel(at);
    real3 a = placed_point(placement, real3(point_in(first))) - ray.origin;
    real3 b = placed_point(placement, real3(point_in(mesh_texel(at + 1u)))) - ray.origin;
    real3 c = placed_point(placement, real3(point_in(mesh_texel(at + 2u)))) - ray.origin;
    return distance_between(a, b, c, ray.direction, !any && !meets_backs && first.w != 0u);
}

// A triangle of a mesh.
struct FoundTriangle {
    uint mesh;
    uint at; // the texel of its corners; NO_SHAPE for none
};

const FoundTriangle NO_TRIANGLE = FoundTriangle(NO_SHAPE, NO_SHAPE);

// The mesh within which a search is, if that is a leaf of the tree over all: what places it, the ray for which it is at
// rest, and how much boxes grow, more where corners are moved.
struct Within {
    uint mesh; // NO_SHAPE for none
    Placement placement;
    Ray ray;
    real margin;
};

// Of 2^-15 in f64 too: the matrix and its inverse may be rounded to f32 each for itself.
const real PLACED_MARGIN = 3.0517578125e-5;

Within nowhere(const Ray ray) { return Within(NO_SHAPE, UNPLACED, ray, MARGIN); }

// The nearest triangle up to `best`, or for `any` just one, below the node at a texel: of those at the same t that of the
// lowest mesh, in it the first in the tree's order. `found`: the triangle at `best`, if that is one.
void search(uint node, Within inside, uint first, const Ray ray, bool from_eye, bool any, inout real best, inout FoundTriangle found) {
    Ray own = ray;
    bool from_origin = from_eye;
    if (PLACED_MESHES) {
        if (inside.mesh != NO_SHAPE) own = ray_in_mesh(inside.placement, inside.ray);
        from_origin = false;
    }
    Slabs slabs = slabs_of(own, from_origin);
    // Children that wait, the nearest on top, and where the ray enters them.
    uint waiting[TREE_STACK];
    real entries[TREE_STACK];
    uint height = 0u;
    // Those from here on are below a leaf of the tree over all.
    uint ground = 0u;
    uint reference = node;
    uint count = 0u;
    while (true) {
        if (PLACED_MESHES) {
            if (count == TREE_MESH) {
                Mesh mesh = mesh_at(reference);
                inside = Within(reference, placement_of(mesh), at_rest(ray, first + reference), PLACED_MARGIN);
                slabs = slabs_of(ray_in_mesh(inside.placement, inside.ray), false);
                ground = height;
                reference = mesh.nodes;
                count = 0u;
            }
        }
        if (count == 0u) {
            uint children[TREE_WIDTH];
            real enters[TREE_WIDTH];
            for (uint k = 0u; k < TREE_WIDTH; k++) {
                uvec4 least = mesh_texel(reference + 2u * k);
                uvec4 greatest = mesh_texel(reference + 2u * k + 1u);
                children[k] = least.w | (greatest.w << TREE_COUNT_SHIFT);
                real margin = MARGIN;
                if (PLACED_MESHES) margin = inside.margin;
                enters[k] = entry(slabs, point_in(least), point_in(greatest), margin, best * slabs.longest);
            }
            SORT_CHILDREN(real, enters, children)
            for (uint k = 0u; k < TREE_WIDTH; k++) {
                if (enters[k] >= 0.0) {
                    waiting[height] = children[k];
                    entries[height] = enters[k];
                    height++;
                }
            }
        } else {
            for (uint k = 0u; k < count; k++) {
                uint at = reference + 3u * k;
                real t;
                bool precedes = at < found.at;
                uint mesh = NO_SHAPE;
                if (PLACED_MESHES) {
                    t = distance_in_placed(at, inside.placement, inside.ray, any);
                    mesh = inside.mesh != NO_SHAPE ? inside.mesh : mesh_texel(at + 1u).w;
                    precedes = mesh < found.mesh || (mesh == found.mesh && precedes);
                } else {
                    t = distance_in(at, ray, from_eye, any);
                }
                bool nearer = t > 0.0 && (t < best || (t == best && found.at != NO_SHAPE && precedes));
                best = nearer ? t : best;
                found.at = nearer ? at : found.at;
                if (PLACED_MESHES) found.mesh = nearer ? mesh : found.mesh;
            }
            if (any && found.at != NO_SHAPE) break;
        }
        // Equal distances are entered as well, for the first of equal triangles.
        while (height > ground && entries[height - 1u] > best * slabs.longest) height--;
        if (PLACED_MESHES) {
            if (height == ground && ground != 0u) {
                ground = 0u;
                inside = nowhere(ray);
                slabs = slabs_of(ray, false);
                while (height > 0u && entries[height - 1u] > best * slabs.longest) height--;
            }
        }
        if (height == 0u) break;
        height--;
        reference = waiting[height] & ((1u << TREE_COUNT_SHIFT) - 1u);
        count = waiting[height] >> TREE_COUNT_SHIFT;
    }
}

// Material and map of a triangle are those of its mesh, whose shape follows `first`.
Hit hit_of(const FoundTriangle found, uint first, real t) {
    uint mesh = PLACED_MESHES ? found.mesh : mesh_texel(found.at + 1u).w;
    return Hit(t, first + mesh, real2(real(mesh_texel(found.at + 2u).w), 0.0));
}

// The nearest triangle of this mesh before `most`, or for `any` just one. Its number is the local coordinate.
real distance_to(const Mesh mesh, const Ray ray, bool from_eye, real most, bool any, inout real2 local) {
    real best = most;
    FoundTriangle found = NO_TRIANGLE;
    Within inside = nowhere(ray);
    if (is_placed(mesh)) inside = Within(0u, placement_of(mesh), ray, PLACED_MARGIN);
    search(mesh.nodes, inside, 0u, ray, from_eye, any, best, found);
    if (found.at == NO_SHAPE) return -1.0;
    local = hit_of(found, 0u, best).local;
    return best;
}

#endif
