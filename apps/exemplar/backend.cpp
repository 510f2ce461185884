#include "apps/exemplar/backend.h"

#include <optional>

#include "gpu/imaging/mesh_renderer.h"
#include "gpu/labeling/labeling_device.h"
#include "host/imaging/camera.h"
#include "host/imaging/png.h"

namespace exemplar {
namespace {

constexpr int k_picture_size = 1024;  // pixels a side

// From the front, the right and above, which shows most of an upright shape.
const Vec3 k_oblique_view{0.6f, 0.5f, 1.0f};

}  // namespace

struct DeviceBackend::Impl {
    explicit Impl(const std::string& name) : device({.name = name}) {}
    LabelingDevice device;
    std::optional<MeshRenderer> renderer;  // made at the first picture, as a device that only computes can label too
};

DeviceBackend::DeviceBackend(const std::string& device) : impl_(std::make_unique<Impl>(device)) {}
DeviceBackend::~DeviceBackend() = default;

LabelingBackend DeviceBackend::labeling() {
    return impl_->device.labeling();
}

const std::string& DeviceBackend::labeling_device_name() const {
    return impl_->device.labeling_device_name();
}

const std::string& DeviceBackend::device_name() const {
    return impl_->device.device().info().name;
}

void DeviceBackend::render_png(const std::filesystem::path& path, const TriangleMesh& mesh,
                               std::span<const Color> face_colors) {
    if (!impl_->renderer) impl_->renderer.emplace(impl_->device.device());
    const Camera camera = fit_camera(mesh, k_oblique_view, 1.0f);
    write_png(path, impl_->renderer->render(mesh, face_colors, camera, k_picture_size, k_picture_size));
}

}  // namespace exemplar
