#pragma once

#include <memory>
#include <string>

#include "host/labeling/inference/labeler.h"

namespace exemplar {

/// The device of a command, with the operations of labeling.
class DeviceBackend {
  public:
    /// Opens the device that `device` names (index, part of a name, or empty for the default); throws DeviceError.
    explicit DeviceBackend(const std::string& device);
    ~DeviceBackend();
    DeviceBackend(const DeviceBackend&) = delete;
    DeviceBackend& operator=(const DeviceBackend&) = delete;

    /// Returns the operations of labeling: by shaders, or by the host's vector units if the device is a CPU.
    LabelingBackend labeling();
    /// Returns where labeling() computes: the device's name, or "the host".
    const std::string& labeling_device_name() const;
    const std::string& device_name() const;
    /// Renders a mesh with a color per triangle, seen obliquely from above, to a PNG file.
    void render_png(const std::filesystem::path& path, const TriangleMesh& mesh, std::span<const Color> face_colors);

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace exemplar
