#include "host/mesh/queries/rays.h"

#include <embree3/rtcore.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <span>

#include "host/core/errors.h"

namespace exemplar {

namespace {

/// An Embree context with the face to ignore.
struct SkippingContext {
    RTCIntersectContext embree;  // first, so that a pointer to it is a pointer to the whole
    std::uint32_t skipped_face;
};

void reject_skipped_face(const RTCFilterFunctionNArguments* arguments) {
    const auto* context = reinterpret_cast<const SkippingContext*>(arguments->context);
    if (RTCHitN_primID(arguments->hit, arguments->N, 0) == context->skipped_face) arguments->valid[0] = 0;
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
        return Hit{query.ray.tfar, query.hit.primID};
    }
};

RayScene::Impl::Impl(const TriangleMesh& mesh) : device(rtcNewDevice(nullptr)) {
    if (!device) throw Error("ray casting is unavailable: Embree found no usable processor features");
    scene = rtcNewScene(device);
    // Robust traversal: a ray through a shared edge must not slip between its two faces.
    rtcSetSceneFlags(scene, static_cast<RTCSceneFlags>(RTC_SCENE_FLAG_ROBUST | RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION));
    rtcSetSceneBuildQuality(scene, RTC_BUILD_QUALITY_HIGH);
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

void RayScene::Impl::attach(const TriangleMesh& mesh) {
    static_assert(sizeof(Vec3) == 3 * sizeof(float) && sizeof(Face) == 3 * sizeof(std::uint32_t));
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    void* vertices = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(Vec3),
                                             mesh.vertex_count());
    void* faces =
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, sizeof(Face), mesh.face_count());
    if (vertices && faces) {
        std::ranges::uninitialized_copy(mesh.vertices, std::span(static_cast<Vec3*>(vertices), mesh.vertex_count()));
        std::ranges::uninitialized_copy(mesh.faces, std::span(static_cast<Face*>(faces), mesh.face_count()));
        rtcCommitGeometry(geometry);
        rtcAttachGeometry(scene, geometry);
    }
    rtcReleaseGeometry(geometry);
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
    context.skipped_face = from;
    return impl_->intersect(make_ray(origin, direction, impl_->smallest_distance), context.embree);
}

}  // namespace exemplar
