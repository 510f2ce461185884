#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "apps/exemplar/animation_arguments.h"
#include "apps/exemplar/ink_arguments.h"
#include "host/animation/animation.h"
#include "host/curvature/model/model.h"
#include "host/curvature/state/samples.h"
#include "host/lines/extraction/drawable_surface.h"
#include "host/lines/extraction/lines.h"
#include "host/mesh/curvature/curvature_estimator.h"

namespace exemplar {

/// Command-line arguments of the surface that is drawn.
struct LinesSourceArguments {
    std::filesystem::path input, model;  ///< no model: curvature is measured
    FrameArguments frames;
    bool first_frame_only = false;  ///< if no frames are selected
    double frames_per_second = 30;
    DrawableOptions measuring{};  ///< if there is no model
    InkArguments inks;
    bool quiet = false;
};

/// A mesh, or the selected frames of an animation, with its curvature frame by frame.
class LinesSource {
  public:
    /// Reads all files, of any kind, and prints their warnings unless `quiet`. Throws MeshError, ModelError,
    /// DataError or UsageError for what cannot be drawn.
    explicit LinesSource(const LinesSourceArguments& arguments);

    std::size_t frame_count() const { return frames_.size(); }
    bool is_animation() const { return animated_; }
    /// Frames per second of the first frame's clip.
    double frames_per_second() const { return animation_.clips[frames_[0].clip].frames_per_second; }
    std::span<const Face> faces() const { return animation_.rest.faces; }  ///< of the uncut surface
    std::size_t vertex_count() const { return animation_.rest.vertex_count(); }
    std::vector<Vec3> vertices(std::size_t frame) const;
    TriangleMesh mesh(std::size_t frame) const;  ///< the uncut surface at a frame
    /// The surface at a frame, cut open along sharp edges; valid until the next call.
    LineSurface surface(std::size_t frame);
    /// Feature size of the first frame, or of the model's training. It is constant, so that lines do not flicker.
    float feature_size();

    /// The labels in the file of a mesh.
    const std::optional<FaceLabels>& labels() const { return labels_; }
    /// The inks of the parts' lines; empty if the arguments name none.
    const PartInks& inks() const { return inks_; }

    const Animation& animation() const { return animation_; }
    const std::vector<FrameRef>& frames() const { return frames_; }
    const std::optional<CurvatureModel>& model() const { return model_; }

  private:
    void predict(std::size_t frame);

    LinesSourceArguments arguments_;
    Animation animation_;  ///< of a mesh: one clip of one frame
    bool animated_ = false;
    std::vector<FrameRef> frames_;
    std::optional<FaceLabels> labels_;
    PartInks inks_;
    std::optional<CurvatureModel> model_;
    std::unique_ptr<DrawableSurface> drawable_;
    std::unique_ptr<CurvatureEstimator> estimator_;  ///< for normals, with a model
    std::unique_ptr<CurvatureEvaluator> evaluator_;
    std::vector<Vec3> vertices_;
    std::optional<std::size_t> current_;  ///< the frame that surface() has made
    std::optional<float> feature_size_;
};

}  // namespace exemplar
