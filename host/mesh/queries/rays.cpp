#include "host/mesh/queries/rays.h"

#include <embree3/rtcore.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "host/core/errors.h"
#include "host/mesh/queries/sliver_groups.h"

namespace exemplar {

namespace {

/// The mesh's face of each triangle: per geometry of the scene (an instance is one), per triangle of the geometry.
using FaceTable = std::vector<std::vector<std::uint32_t>>;

std::uint32_t face_of_hit(const FaceTable& faces, unsigned instance, unsigned geometry, unsigned triangle) {
    return faces[instance != RTC_INVALID_GEOMETRY_ID ? instance : geometry][triangle];
}

/// An Embree context with the face to ignore.
struct SkippingContext {
    RTCIntersectContext embree;  // first, so that a pointer to it is a pointer to the whole
    const FaceTable* faces;
    std::uint32_t skipped_face;
};

void reject_skipped_face(const RTCFilterFunctionNArguments* arguments) {
    const auto* context = reinterpret_cast<const SkippingContext*>(arguments->context);
    RTCHitN* const hit = arguments->hit;
    const unsigned n = arguments->N;
    if (face_of_hit(*context->faces, RTCHitN_instID(hit, n, 0, 0), RTCHitN_geomID(hit, n, 0),
                    RTCHitN_primID(hit, n, 0)) == context->skipped_face)
        arguments->valid[0] = 0;
}

RTCScene make_scene(RTCDevice device) {
    RTCScene scene = rtcNewScene(device);
    // Robust traversal: a ray through a shared edge must not slip between its two faces.
    rtcSetSceneFlags(scene, static_cast<RTCSceneFlags>(RTC_SCENE_FLAG_ROBUST | RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION));
    rtcSetSceneBuildQuality(scene, RTC_BUILD_QUALITY_HIGH);
    return scene;
}

/// Adds some faces of a mesh, rotated, as one geometry; returns its number.
unsigned attach_faces(RTCDevice device, RTCScene scene, const TriangleMesh& mesh, std::span<const std::uint32_t> faces,
                      const Eigen::Matrix3f* rotation) {
    static_assert(sizeof(Vec3) == 3 * sizeof(float) && sizeof(Face) == 3 * sizeof(std::uint32_t));
    // Numbers of the vertices in the geometry, which holds only those of its own faces.
    std::vector<std::uint32_t> used;
    used.reserve(3 * faces.size());
    for (const std::uint32_t f : faces) used.insert(used.end(), mesh.faces[f].begin(), mesh.faces[f].end());
    std::ranges::sort(used);
    used.erase(std::unique(used.begin(), used.end()), used.end());
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* vertices = static_cast<Vec3*>(
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(Vec3), used.size()));
    auto* triangles = static_cast<Face*>(
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, sizeof(Face), faces.size()));
    unsigned number = RTC_INVALID_GEOMETRY_ID;
    if (vertices && triangles) {
        for (std::size_t i = 0; i < used.size(); ++i) {
            const Vec3& p = mesh.vertices[used[i]];
            std::construct_at(vertices + i, rotation ? Vec3(*rotation * p) : p);
        }
        for (std::size_t i = 0; i < faces.size(); ++i) {
            Face face = mesh.faces[faces[i]];
            for (std::uint32_t& v : face)
                v = static_cast<std::uint32_t>(std::ranges::lower_bound(used, v) - used.begin());
            std::construct_at(triangles + i, face);
        }
        rtcCommitGeometry(geometry);
        number = rtcAttachGeometry(scene, geometry);
    }
    rtcReleaseGeometry(geometry);
    return number;
}

/// Adds a group of slivers as an instance of a scene in their own frame; returns its number.
unsigned attach_group(RTCDevice device, RTCScene scene, const TriangleMesh& mesh, const SliverGroup& group) {
    RTCScene part = make_scene(device);
    attach_faces(device, part, mesh, group.faces, &group.rotation);
    rtcCommitScene(part);
    RTCGeometry instance = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_INSTANCE);
    rtcSetGeometryInstancedScene(instance, part);
    rtcReleaseScene(part);
    // Three columns of the rotation back to the mesh, and no shift.
    Eigen::Matrix<float, 3, 4> back = Eigen::Matrix<float, 3, 4>::Zero();
    back.leftCols<3>() = group.rotation.transpose();
    rtcSetGeometryTransform(instance, 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, back.data());
    rtcCommitGeometry(instance);
    const unsigned number = rtcAttachGeometry(scene, instance);
    rtcReleaseGeometry(instance);
    return number;
}

RTCRayHit make_ray(const Vec3& origin, const Vec3& direction, float near) {
    RTCRayHit query{};
    query.ray.org_x = origin.x();
    query.ray.org_y = origin.y();
    query.ray.org_z = origin.z();
    query.ray.dir_x = direction.x();
    query.ray.dir_y = direction.y();
    query.ray.dir_z = direction.z();
    query.ray.tnear = near;
    query.ray.tfar = std::numeric_limits<float>::infinity();
    query.ray.mask = ~0u;
    query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    return query;
}

}  // namespace

struct RayScene::Impl {
    RTCDevice device = nullptr;
    RTCScene scene = nullptr;
    FaceTable faces;
    float smallest_distance = 0;  ///< hits nearer than this cannot be told from the start point itself

    explicit Impl(const TriangleMesh& mesh);
    ~Impl() {
        if (scene) rtcReleaseScene(scene);
        if (device) rtcReleaseDevice(device);
    }
    Impl(const Impl&) = delete;
    Impl& operator=(const Impl&) = delete;

    void attach(const TriangleMesh& mesh);
    std::optional<Hit> intersect(RTCRayHit query, RTCIntersectContext& context) const {
        rtcIntersect1(scene, &context, &query);
        if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return std::nullopt;
        return Hit{query.ray.tfar, face_of_hit(faces, query.hit.instID[0], query.hit.geomID, query.hit.primID)};
    }
};

RayScene::Impl::Impl(const TriangleMesh& mesh) : device(rtcNewDevice(nullptr)) {
    if (!device) throw Error("ray casting is unavailable: Embree found no usable processor features");
    scene = make_scene(device);
    if (!mesh.faces.empty()) attach(mesh);
    rtcCommitScene(scene);
    if (rtcGetDeviceError(device) != RTC_ERROR_NONE) {
        rtcReleaseScene(scene);
        rtcReleaseDevice(device);
        throw Error("ray casting is unavailable: Embree could not index the mesh (out of memory?)");
    }
    float largest = 0;
    for (const Vec3& p : mesh.vertices) largest = std::max(largest, p.cwiseAbs().maxCoeff());
    smallest_distance = 4 * std::numeric_limits<float>::epsilon() * largest;
}

/// Adds the groups of slivers, and the other faces as one geometry.
void RayScene::Impl::attach(const TriangleMesh& mesh) {
    const auto note = [&](unsigned number, std::vector<std::uint32_t> added) {
        if (number == RTC_INVALID_GEOMETRY_ID) return;  // the device notes the error
        faces.resize(std::max<std::size_t>(faces.size(), number + std::size_t{1}));
        faces[number] = std::move(added);
    };
    std::vector<bool> grouped(mesh.face_count(), false);
    for (SliverGroup& group : group_slivers(mesh)) {
        for (const std::uint32_t f : group.faces) grouped[f] = true;
        const unsigned number = attach_group(device, scene, mesh, group);
        note(number, std::move(group.faces));
    }
    std::vector<std::uint32_t> others;
    for (std::uint32_t f = 0; f < mesh.face_count(); ++f)
        if (!grouped[f]) others.push_back(f);
    if (others.empty()) return;
    const unsigned number = attach_faces(device, scene, mesh, others, nullptr);
    note(number, std::move(others));
}

RayScene::RayScene(const TriangleMesh& mesh) : impl_(std::make_unique<Impl>(mesh)) {}
RayScene::~RayScene() = default;
RayScene::RayScene(RayScene&&) noexcept = default;
RayScene& RayScene::operator=(RayScene&&) noexcept = default;

std::optional<RayScene::Hit> RayScene::first_hit(const Vec3& origin, const Vec3& direction, float near) const {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    // Embree reports only hits strictly beyond the near end.
    return impl_->intersect(make_ray(origin, direction, near > 0 ? std::nextafter(near, 0.0f) : 0.0f), context);
}

std::optional<RayScene::Hit> RayScene::first_hit_from(std::uint32_t from, const Vec3& origin,
                                                      const Vec3& direction) const {
    SkippingContext context;
    rtcInitIntersectContext(&context.embree);
    context.embree.filter = reject_skipped_face;
    context.faces = &impl_->faces;
    context.skipped_face = from;
    return impl_->intersect(make_ray(origin, direction, impl_->smallest_distance), context.embree);
}

}  // namespace exemplar
