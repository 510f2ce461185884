#pragma once

#include <memory>
#include <string>

#include "host/labeling/inference/labeler.h"

namespace exemplar {

/// The device that a command works on, and labeling's operations on it.
class DeviceBackend {
  public:
    /// Opens the device that `device` names (index, part of a name, or empty for the default); throws DeviceError.
    explicit DeviceBackend(const std::string& device);
    ~DeviceBackend();
    DeviceBackend(const DeviceBackend&) = delete;
    DeviceBackend& operator=(const DeviceBackend&) = delete;

    /// By shaders, or by the host's own vector units where the device is a CPU.
    LabelingBackend labeling();
    /// What labeling() computes on: the device's name, or "the host".
    const std::string& labels_on() const;
    const std::string& device_name() const;
    /// Renders a mesh with a color per triangle, seen obliquely from above, to a PNG file.
    void render_png(const std::filesystem::path& path, const TriangleMesh& mesh, std::span<const Color> face_colors);

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace exemplar
