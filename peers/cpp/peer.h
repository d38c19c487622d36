// The functions that a peer in C++ offers to Rust. Each peer has its own prefix P, such as embree.
//
// Positions are x, y, z of each vertex; triangles are three indices each. All coordinates are in one space. Unless
// another result is described, a query returns 1 if it found a result, 0 if not, and UNSUPPORTED if the library has no
// such query. No function throws.
#pragma once

#include <cstdint>

constexpr int UNSUPPORTED = -1;

#define DECLARE_PEER(P)                                                                                               \
    extern "C" {                                                                                                      \
    void *P##_new(const float *positions, uint32_t vertices, const uint32_t *triangles, uint32_t triangle_count);     \
    void P##_free(void *peer);                                                                                        \
    /* Sets new positions of the same vertices, and refits. */                                                        \
    void P##_update(void *peer, const float *positions);                                                              \
    /* The first triangle along a ray of unit direction, from either side. */                                         \
    int P##_cast_ray(void *peer, const float *origin, const float *direction, float max_distance, float *distance,    \
                     uint32_t *triangle);                                                                             \
    /* Number of triangles that touch a sphere, or UNSUPPORTED. */                                                    \
    int64_t P##_overlap_sphere(void *peer, const float *center, float radius);                                        \
    /* The point of the mesh closest to a point, if within a distance. */                                             \
    int P##_closest_point(void *peer, const float *point, float max_distance, float *nearest);                        \
    /* The share of its motion, 0 to 1, that a sphere makes before it touches. */                                     \
    int P##_cast_sphere(void *peer, const float *center, float radius, const float *motion, float *time);             \
    /* Bytes that the library holds and malloc does not count. */                                                     \
    uint64_t P##_hidden_bytes(void *peer);                                                                            \
    }
