// Bullet 3: a btBvhTriangleMeshShape, refitted each frame.
//
// The shape's tree is quantised, because Bullet refits no other: on a tree that is not quantised, btOptimizedBvh::refit
// does nothing, and queries see the mesh as it was built.
#include "peer.h"
#include "triangle.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <memory>
#include <vector>

#include <BulletCollision/NarrowPhaseCollision/btRaycastCallback.h>
#include <btBulletCollisionCommon.h>

DECLARE_PEER(bullet)

namespace
{

btVector3 vector(const float *v) { return {v[0], v[1], v[2]}; }
Point point(const btVector3 &v) { return {v.x(), v.y(), v.z()}; }

struct Bullet
{
    std::vector<float> positions;
    std::vector<int> triangles;
    // Bounds of the positions. The tree is quantised between them.
    btVector3 low, high;
    btTriangleIndexVertexArray array;
    std::unique_ptr<btBvhTriangleMeshShape> shape;
    btCollisionObject object;

    void take(const float *from)
    {
        std::memcpy(positions.data(), from, positions.size() * sizeof(float));
        low = high = vector(from);
        for (size_t k = 3; k < positions.size(); k += 3)
        {
            const btVector3 v = vector(from + k);
            low.setMin(v);
            high.setMax(v);
        }
    }

    Bullet(const float *from, uint32_t vertices, const uint32_t *corners, uint32_t triangle_count)
        : positions(size_t(vertices) * 3), triangles(corners, corners + size_t(triangle_count) * 3)
    {
        take(from);
        btIndexedMesh mesh;
        mesh.m_numTriangles = static_cast<int>(triangle_count);
        mesh.m_triangleIndexBase = reinterpret_cast<const unsigned char *>(triangles.data());
        mesh.m_triangleIndexStride = 3 * sizeof(int);
        mesh.m_numVertices = static_cast<int>(vertices);
        mesh.m_vertexBase = reinterpret_cast<const unsigned char *>(positions.data());
        mesh.m_vertexStride = 3 * sizeof(float);
        mesh.m_vertexType = PHY_FLOAT;
        array.addIndexedMesh(mesh, PHY_INTEGER);
        shape = std::make_unique<btBvhTriangleMeshShape>(&array, true, low, high);
        // With the default margin, every triangle is 4 cm thick for a convex cast.
        shape->setMargin(0);
        object.setCollisionShape(shape.get());
    }
};

// A distance from a point within which the whole mesh lies.
float reach(const Bullet &bullet, const btVector3 &from)
{
    btVector3 farthest = (from - bullet.low).absolute();
    farthest.setMax((from - bullet.high).absolute());
    return farthest.length() * 1.001f;
}

struct Ray : btTriangleRaycastCallback
{
    int triangle = -1;

    Ray(const btVector3 &from, const btVector3 &to) : btTriangleRaycastCallback(from, to) {}

    btScalar reportHit(const btVector3 &, btScalar fraction, int, int index) override
    {
        triangle = index;
        return fraction;
    }
};

struct Within : btTriangleCallback
{
    Point center;
    float radius_sq;
    int64_t count = 0;

    void processTriangle(btVector3 *corners, int, int) override
    {
        const Point on = closest_point(center, point(corners[0]), point(corners[1]), point(corners[2]));
        const float distance_sq = dot(on - center, on - center);
        count += distance_sq <= radius_sq;
    }
};

struct Closest : btTriangleCallback
{
    Point center;
    float best_sq;
    bool found = false;
    Point nearest{};

    void processTriangle(btVector3 *corners, int, int) override
    {
        const Point on = closest_point(center, point(corners[0]), point(corners[1]), point(corners[2]));
        const float distance_sq = dot(on - center, on - center);
        if (distance_sq <= best_sq)
        {
            best_sq = distance_sq;
            nearest = on;
            found = true;
        }
    }
};

} // namespace

void *bullet_new(const float *positions, uint32_t vertices, const uint32_t *triangles, uint32_t triangle_count)
{
    try
    {
        return new Bullet(positions, vertices, triangles, triangle_count);
    }
    catch (...)
    {
        return nullptr;
    }
}

void bullet_free(void *peer) { delete static_cast<Bullet *>(peer); }

void bullet_update(void *peer, const float *positions)
{
    Bullet &bullet = *static_cast<Bullet *>(peer);
    bullet.take(positions);
    // Like the shape's refitTree, but without the shape's own bounds: these take six passes over all triangles, several
    // times the time of the refit, and no query of this peer reads them.
    bullet.shape->getOptimizedBvh()->refit(&bullet.array, bullet.low, bullet.high);
}

int bullet_cast_ray(void *peer, const float *origin, const float *direction, float max_distance, float *distance,
                    uint32_t *triangle)
{
    Bullet &bullet = *static_cast<Bullet *>(peer);
    const btVector3 from = vector(origin);
    // Bullet casts along segments. A segment no longer than needed keeps the precision.
    const float length = std::min(max_distance, reach(bullet, from));
    const btVector3 to = from + vector(direction) * length;
    Ray ray(from, to);
    bullet.shape->performRaycast(&ray, from, to);
    if (ray.triangle < 0)
        return 0;
    *distance = ray.m_hitFraction * length;
    *triangle = static_cast<uint32_t>(ray.triangle);
    return 1;
}

int64_t bullet_overlap_sphere(void *peer, const float *center, float radius)
{
    const Bullet &bullet = *static_cast<Bullet *>(peer);
    Within within;
    within.center = {center[0], center[1], center[2]};
    within.radius_sq = radius * radius;
    const btVector3 at = vector(center), by(radius, radius, radius);
    bullet.shape->processAllTriangles(&within, at - by, at + by);
    return within.count;
}

int bullet_closest_point(void *peer, const float *at, float max_distance, float *nearest)
{
    const Bullet &bullet = *static_cast<Bullet *>(peer);
    const btVector3 center = vector(at);
    const float most = std::min(max_distance, reach(bullet, center));
    // Bullet has no query for closest points, and no query with a box that shrinks meanwhile. So boxes grow until the
    // sphere inside a box contains a point of the mesh. The last box costs most, so the size of the first one matters
    // little.
    float radius = std::min(most, (bullet.high - bullet.low).length() / 256);
    for (;;)
    {
        Closest closest;
        closest.center = point(center);
        closest.best_sq = radius * radius;
        const btVector3 by(radius, radius, radius);
        bullet.shape->processAllTriangles(&closest, center - by, center + by);
        if (closest.found)
        {
            std::memcpy(nearest, &closest.nearest, sizeof closest.nearest);
            return 1;
        }
        if (radius >= most)
            return 0;
        radius = std::min(most, radius * 2);
    }
}

int bullet_cast_sphere(void *peer, const float *center, float radius, const float *motion, float *time)
{
    Bullet &bullet = *static_cast<Bullet *>(peer);
    btSphereShape sphere(radius);
    btTransform from, to;
    from.setIdentity();
    from.setOrigin(vector(center));
    to.setIdentity();
    to.setOrigin(vector(center) + vector(motion));
    btCollisionWorld::ClosestConvexResultCallback hit(from.getOrigin(), to.getOrigin());
    btCollisionWorld::objectQuerySingle(&sphere, from, to, &bullet.object, bullet.shape.get(),
                                        btTransform::getIdentity(), hit, 0);
    if (!hit.hasHit())
        return 0;
    *time = hit.m_closestHitFraction;
    return 1;
}

uint64_t bullet_hidden_bytes(void *) { return 0; }
