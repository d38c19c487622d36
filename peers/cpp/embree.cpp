// Embree 3: a scene of one mesh, refitted each frame through its vertex buffer.
#include "peer.h"
#include "triangle.h"

#include <algorithm>
#include <atomic>
#include <cstring>
#include <malloc.h>
#include <new>

#include <embree3/rtcore.h>

DECLARE_PEER(embree)
DECLARE_PEER(embree_robust)

namespace
{

struct Embree
{
    RTCDevice device = nullptr;
    RTCScene scene = nullptr;
    RTCGeometry mesh = nullptr;
    Point *vertices = nullptr;
    uint32_t (*triangles)[3] = nullptr;
    size_t vertex_count = 0;
    // Bytes that Embree holds now, by its own count, and the bytes that malloc counted after the tree was built. Embree
    // maps the tree of a large mesh itself, without malloc.
    std::atomic<int64_t> bytes{0};
    int64_t known_to_malloc = 0;

    ~Embree()
    {
        if (mesh)
            rtcReleaseGeometry(mesh);
        if (scene)
            rtcReleaseScene(scene);
        // The device reports the bytes that it frees at the end to the monitor, so it is released while `bytes` lives.
        if (device)
            rtcReleaseDevice(device);
    }
};

int64_t malloc_bytes()
{
    const struct mallinfo2 now = mallinfo2();
    return static_cast<int64_t>(now.uordblks + now.hblkhd);
}

bool count_bytes(void *user, ssize_t bytes, bool)
{
    static_cast<Embree *>(user)->bytes += bytes;
    return true;
}

Embree *make(const float *positions, uint32_t vertices, const uint32_t *triangles, uint32_t triangle_count,
             RTCSceneFlags flags)
{
    Embree *peer = new (std::nothrow) Embree;
    if (!peer)
        return nullptr;
    peer->device = rtcNewDevice("threads=1,set_affinity=0");
    if (!peer->device)
    {
        delete peer;
        return nullptr;
    }
    const int64_t before = malloc_bytes();
    rtcSetDeviceMemoryMonitorFunction(peer->device, count_bytes, peer);
    peer->scene = rtcNewScene(peer->device);
    peer->mesh = rtcNewGeometry(peer->device, RTC_GEOMETRY_TYPE_TRIANGLE);
    peer->vertices = static_cast<Point *>(
        rtcSetNewGeometryBuffer(peer->mesh, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(Point), vertices));
    peer->triangles = static_cast<uint32_t(*)[3]>(rtcSetNewGeometryBuffer(
        peer->mesh, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, sizeof *peer->triangles, triangle_count));
    if (!peer->vertices || !peer->triangles)
    {
        delete peer;
        return nullptr;
    }
    peer->vertex_count = vertices;
    std::memcpy(peer->vertices, positions, vertices * sizeof(Point));
    std::memcpy(peer->triangles, triangles, triangle_count * sizeof *peer->triangles);
    // Embree refits only in a DYNAMIC scene of LOW quality, which puts the mesh's tree under a tree of the scene. In
    // other scenes, it builds anew, at about twenty times the cost.
    rtcSetGeometryBuildQuality(peer->mesh, RTC_BUILD_QUALITY_REFIT);
    rtcSetSceneBuildQuality(peer->scene, RTC_BUILD_QUALITY_LOW);
    rtcSetSceneFlags(peer->scene, flags);
    rtcCommitGeometry(peer->mesh);
    rtcAttachGeometry(peer->scene, peer->mesh);
    rtcCommitScene(peer->scene);
    if (rtcGetDeviceError(peer->device) != RTC_ERROR_NONE)
    {
        delete peer;
        return nullptr;
    }
    peer->known_to_malloc = malloc_bytes() - before;
    return peer;
}

void update(Embree &peer, const float *positions)
{
    std::memcpy(peer.vertices, positions, peer.vertex_count * sizeof(Point));
    rtcUpdateGeometryBuffer(peer.mesh, RTC_BUFFER_TYPE_VERTEX, 0);
    rtcCommitGeometry(peer.mesh);
    rtcCommitScene(peer.scene);
}

int cast_ray(const Embree &peer, const float *origin, const float *direction, float max_distance, float *distance,
             uint32_t *triangle)
{
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    RTCRayHit ray{};
    ray.ray.org_x = origin[0];
    ray.ray.org_y = origin[1];
    ray.ray.org_z = origin[2];
    ray.ray.dir_x = direction[0];
    ray.ray.dir_y = direction[1];
    ray.ray.dir_z = direction[2];
    ray.ray.tfar = max_distance;
    ray.ray.mask = ~0u;
    ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(peer.scene, &context, &ray);
    if (ray.hit.geomID == RTC_INVALID_GEOMETRY_ID)
        return 0;
    *distance = ray.ray.tfar;
    *triangle = ray.hit.primID;
    return 1;
}

// The data of a point query: Embree walks the tree within a radius, and a callback tests the triangles.
struct PointQuery
{
    const Embree *peer;
    Point point;
    float radius_sq;
    int64_t count;
    Point nearest;
};

Point nearest_of(const PointQuery &query, uint32_t triangle)
{
    const uint32_t *corners = query.peer->triangles[triangle];
    const Point *vertices = query.peer->vertices;
    return closest_point(query.point, vertices[corners[0]], vertices[corners[1]], vertices[corners[2]]);
}

bool count_within(RTCPointQueryFunctionArguments *args)
{
    PointQuery &query = *static_cast<PointQuery *>(args->userPtr);
    const Point from = nearest_of(query, args->primID) - query.point;
    query.count += dot(from, from) <= query.radius_sq;
    return false;
}

bool keep_nearest(RTCPointQueryFunctionArguments *args)
{
    PointQuery &query = *static_cast<PointQuery *>(args->userPtr);
    const Point nearest = nearest_of(query, args->primID);
    const Point from = nearest - query.point;
    const float distance_sq = dot(from, from);
    if (!(distance_sq <= query.radius_sq))
        return false;
    query.radius_sq = distance_sq;
    query.nearest = nearest;
    query.count = 1;
    // The radius shrinks; the result true reports this to Embree.
    args->query->radius = std::sqrt(distance_sq);
    return true;
}

PointQuery query_point(const Embree &peer, const float *center, float radius, RTCPointQueryFunction function)
{
    PointQuery found = {&peer, {center[0], center[1], center[2]}, radius * radius, 0, {}};
    RTCPointQueryContext context;
    rtcInitPointQueryContext(&context);
    RTCPointQuery query{};
    query.x = center[0];
    query.y = center[1];
    query.z = center[2];
    query.radius = radius;
    rtcPointQuery(peer.scene, &query, &context, function, &found);
    return found;
}

int closest(const Embree &peer, const float *point, float max_distance, float *nearest)
{
    const PointQuery found = query_point(peer, point, max_distance, keep_nearest);
    if (found.count == 0)
        return 0;
    std::memcpy(nearest, &found.nearest, sizeof found.nearest);
    return 1;
}

uint64_t hidden(const Embree &peer)
{
    return static_cast<uint64_t>(std::max<int64_t>(0, peer.bytes - peer.known_to_malloc));
}

const Embree &embree(const void *peer) { return *static_cast<const Embree *>(peer); }

} // namespace

#define DEFINE_PEER(P, FLAGS)                                                                                         \
    void *P##_new(const float *positions, uint32_t vertices, const uint32_t *triangles, uint32_t triangle_count)      \
    {                                                                                                                 \
        return make(positions, vertices, triangles, triangle_count, FLAGS);                                           \
    }                                                                                                                 \
    void P##_free(void *peer) { delete static_cast<Embree *>(peer); }                                                 \
    void P##_update(void *peer, const float *positions) { update(*static_cast<Embree *>(peer), positions); }          \
    int P##_cast_ray(void *peer, const float *origin, const float *direction, float max_distance, float *distance,    \
                     uint32_t *triangle)                                                                              \
    {                                                                                                                 \
        return cast_ray(embree(peer), origin, direction, max_distance, distance, triangle);                           \
    }                                                                                                                 \
    int64_t P##_overlap_sphere(void *peer, const float *center, float radius)                                         \
    {                                                                                                                 \
        return query_point(embree(peer), center, radius, count_within).count;                                         \
    }                                                                                                                 \
    int P##_closest_point(void *peer, const float *point, float max_distance, float *nearest)                         \
    {                                                                                                                 \
        return closest(embree(peer), point, max_distance, nearest);                                                   \
    }                                                                                                                 \
    /* Embree casts rays only: a user geometry can be hit by a ray, but cannot be cast. */                            \
    int P##_cast_sphere(void *, const float *, float, const float *, float *) { return UNSUPPORTED; }                 \
    uint64_t P##_hidden_bytes(void *peer) { return hidden(embree(peer)); }

DEFINE_PEER(embree, RTC_SCENE_FLAG_DYNAMIC)
DEFINE_PEER(embree_robust, RTC_SCENE_FLAG_DYNAMIC | RTC_SCENE_FLAG_ROBUST)
