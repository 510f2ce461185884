#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "apps/viewer/document.h"
#include "apps/viewer/view_settings.h"
#include "gpu/curvature/curvature.h"
#include "gpu/curvature/learned_curvature.h"
#include "gpu/curvature/normals.h"
#include "gpu/curvature/poser.h"
#include "gpu/runtime/stream.h"
#include "host/curvature/model.h"

namespace exemplar {

/// What a surface looks like at a moment: a pose of its rig, or vertices of a sequence.
struct Moment {
    std::optional<Pose> pose;
    std::span<const Vec3> vertices{};  ///< empty for rigs, and for meshes that do not move
};

/// The moment of a frame of a document, which must live as long.
Moment moment_of(const Document& document, std::size_t clip, std::size_t frame);
/// The vertices at a moment, on the host.
std::vector<Vec3> vertices_at(const Document& document, const Moment& moment);

/// A document on the device: from moments to vertices, normals and curvature, and from these to pictures, without any
/// of them coming back.
class SurfaceScene {
  public:
    /// The document must live as long. Throws MeshError or DeviceLimitError if the device cannot show it.
    SurfaceScene(Device& device, const Document& document);

    /// Takes learned curvature from a model, or from none. Throws ModelError if it is of another surface.
    void set_model(std::shared_ptr<const CurvatureModel> model);
    bool has_model() const { return learned_.has_value(); }

    /// Poses the surface; with curvature by `source` where `settings` need it.
    void record_moment(Stream& stream, const Moment& moment, const ViewSettings& settings);
    /// Adds the surface to a pass; curvature is the learned one or else the estimated one.
    void draw(Pass& pass, const Camera& camera, const ViewSettings& settings, bool learned);

  private:
    void make_estimator();
    void record_learned(Stream& stream, const Moment& moment);
    const Buffer& normals() const;
    const Document& document_;
    Device& device_;
    GpuSurface surface_;
    GpuPoser poser_;
    GpuNormals normals_;
    SurfacePainter painter_;
    Buffer colors_;
    float feature_size_ = 0;
    std::shared_ptr<const CurvatureModel> model_;
    std::optional<GpuCurvature> estimated_;
    std::optional<GpuLearnedCurvature> learned_;
    bool estimates_ = false;  // at the moment recorded last
};

}  // namespace exemplar
