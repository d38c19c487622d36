// FCL 0.7: a BVHModel of boxes, refitted from the leaves up.
//
// The boxes are axis-aligned. FCL's oriented volumes take tens of times as long to refit, and two kinds of them are
// wrong afterwards: FCL computes the union of two rectangle swept spheres with the third axis of one of them instead of
// the union's own axis, so that the union does not contain them. After a refit from the leaves up, RSS misses triangles
// that the sphere touches, and RSS and OBBRSS miss the closest point.
//
// For boxes, `fcl::collide` copies the whole model at every call, and `fcl::distance` has no implementation. So this
// file calls the traversals below these two functions directly, in the same way.
#include "peer.h"

#include <limits>
#include <memory>
#include <vector>

// Before BVH_model.h, which needs its declarations.
#include <fcl/math/bv/utility.h>

#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/geometry/shape/sphere.h>
#include <fcl/geometry/shape/utility.h>
#include <fcl/narrowphase/detail/gjk_solver_libccd.h>
#include <fcl/narrowphase/detail/traversal/collision/mesh_shape_collision_traversal_node.h>
#include <fcl/narrowphase/detail/traversal/collision_node.h>
#include <fcl/narrowphase/detail/traversal/distance/mesh_shape_distance_traversal_node.h>

DECLARE_PEER(fcl)

namespace
{

using Box = fcl::AABBf;
using Solver = fcl::detail::GJKSolver_libccd<float>;

struct Fcl
{
    fcl::BVHModel<Box> model;
    // The solver has closed forms for a sphere and a triangle.
    Solver solver;
    fcl::CollisionResultf touched;
};

fcl::Vector3f vector(const float *v) { return {v[0], v[1], v[2]}; }

fcl::Transform3f at(const float *v)
{
    fcl::Transform3f transform = fcl::Transform3f::Identity();
    transform.translation() = vector(v);
    return transform;
}

std::unique_ptr<Fcl> make(const float *positions, uint32_t vertices, const uint32_t *triangles,
                          uint32_t triangle_count)
{
    std::vector<fcl::Vector3f> points(vertices);
    for (size_t k = 0; k < vertices; k++)
        points[k] = vector(positions + 3 * k);
    std::vector<fcl::Triangle> corners(triangle_count);
    for (size_t k = 0; k < triangle_count; k++)
        corners[k].set(triangles[3 * k], triangles[3 * k + 1], triangles[3 * k + 2]);
    auto peer = std::make_unique<Fcl>();
    peer->model.beginModel(static_cast<int>(triangle_count), static_cast<int>(vertices));
    peer->model.addSubModel(points, corners);
    if (peer->model.endModel() != fcl::BVH_OK)
        return nullptr;
    return peer;
}

int64_t overlap(Fcl &peer, const float *center, float radius)
{
    const fcl::Spheref sphere(radius);
    const fcl::CollisionRequestf request(std::numeric_limits<size_t>::max());
    peer.touched.clear();
    fcl::detail::MeshShapeCollisionTraversalNode<Box, fcl::Spheref, Solver> node;
    fcl::Transform3f model_at = fcl::Transform3f::Identity();
    if (!fcl::detail::initialize(node, peer.model, model_at, sphere, at(center), &peer.solver, request, peer.touched))
        return 0;
    fcl::detail::collide(&node);
    // There is one contact per triangle, since each triangle is in one leaf.
    return static_cast<int64_t>(peer.touched.numContacts());
}

int closest(Fcl &peer, const float *point, float max_distance, float *nearest)
{
    const fcl::Spheref sphere(0);
    const fcl::DistanceRequestf request(true);
    fcl::DistanceResultf result(max_distance);
    fcl::detail::MeshShapeDistanceTraversalNode<Box, fcl::Spheref, Solver> node;
    // Like FCL's `initialize`, which does not link: it is declared with one signature and defined with another.
    node.request = request;
    node.result = &result;
    node.model1 = &peer.model;
    node.tf1.setIdentity();
    node.model2 = &sphere;
    node.tf2 = at(point);
    node.nsolver = &peer.solver;
    node.vertices = peer.model.vertices;
    node.tri_indices = peer.model.tri_indices;
    fcl::computeBV(sphere, node.tf2, node.model2_bv);
    fcl::detail::distance(&node);
    if (!result.o1)
        return 0;
    // A point on the triangle itself counts as inside the sphere, and then FCL returns no nearest point.
    const fcl::Vector3f on = result.min_distance > 0 ? result.nearest_points[0] : vector(point);
    for (int k = 0; k < 3; k++)
        nearest[k] = on[k];
    return 1;
}

} // namespace

void *fcl_new(const float *positions, uint32_t vertices, const uint32_t *triangles, uint32_t triangle_count)
{
    try
    {
        return make(positions, vertices, triangles, triangle_count).release();
    }
    catch (...)
    {
        return nullptr;
    }
}

void fcl_free(void *peer) { delete static_cast<Fcl *>(peer); }

void fcl_update(void *peer, const float *positions)
{
    // Not beginUpdateModel, which keeps the old positions and fits every leaf to old and new ones.
    fcl::BVHModel<Box> &model = static_cast<Fcl *>(peer)->model;
    model.beginReplaceModel();
    for (int k = 0; k < model.num_vertices; k++)
        model.replaceVertex(vector(positions + 3 * size_t(k)));
    model.endReplaceModel(true, true);
}

// FCL has no rays.
int fcl_cast_ray(void *, const float *, const float *, float, float *, uint32_t *) { return UNSUPPORTED; }

int64_t fcl_overlap_sphere(void *peer, const float *center, float radius)
{
    try
    {
        return overlap(*static_cast<Fcl *>(peer), center, radius);
    }
    catch (...)
    {
        return UNSUPPORTED;
    }
}

int fcl_closest_point(void *peer, const float *point, float max_distance, float *nearest)
{
    try
    {
        return closest(*static_cast<Fcl *>(peer), point, max_distance, nearest);
    }
    catch (...)
    {
        return UNSUPPORTED;
    }
}

// FCL's continuous collision cannot cast a sphere against a mesh. CCDC_CONSERVATIVE_ADVANCEMENT, which is meant for it,
// lets the sphere pass through a mesh that it does not touch at the start: for RSS and OBBRSS, it measures from a wrong
// position of the sphere; for boxes, it treats their motion as zero; and with the sphere as the first argument, it
// crashes. CCDC_NAIVE samples times and tunnels, CCDC_POLYNOMIAL_SOLVER is for two meshes, which it changes, and
// CCDC_RAY_SHOOTING is empty.
int fcl_cast_sphere(void *, const float *, float, const float *, float *) { return UNSUPPORTED; }

uint64_t fcl_hidden_bytes(void *) { return 0; }
