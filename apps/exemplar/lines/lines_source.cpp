#include "apps/exemplar/lines/lines_source.h"

#include <fmt/format.h>

#include "apps/exemplar/arguments.h"
#include "host/animation/read_surface.h"
#include "host/core/errors.h"

namespace exemplar {
namespace {

/// Adds a clip of the shape at rest.
void add_rest_clip(Animation& animation, const std::string& name) {
    Clip clip;
    clip.name = name;
    if (animation.has_rig())
        clip.poses.push_back(rest_pose(animation.rig));
    else
        clip.frames.push_back(animation.rest.vertices);
    animation.clips.push_back(std::move(clip));
}

}  // namespace

LinesSource::LinesSource(const LinesSourceArguments& arguments) : arguments_(arguments) {
    SurfaceFile file = read_surface(arguments.input, {.frames_per_second = arguments.frames_per_second});
    animation_ = std::move(file.animation);
    animated_ = animation_.moves();
    if (!animated_ && !arguments.model.empty()) {
        if (!file.why_still.empty()) throw MeshError(file.why_still);
        throw UsageError(fmt::format("--model is for animations: {} is a mesh, whose curvature is measured",
                                     arguments.input.string()));
    }
    if (animation_.clips.empty()) add_rest_clip(animation_, animated_ ? "rest" : arguments.input.stem().string());
    if (!arguments.quiet)
        for (const std::string& warning : animation_.warnings)
            fmt::print(stderr, "warning: {}: {}\n", arguments.input.string(), warning);
    FrameSelection selection = selection_of(arguments.frames);
    if (arguments.first_frame_only && arguments.frames.range.empty() && arguments.frames.most == 0) selection.most = 1;
    frames_ = select_frames(animation_, selection);
    labels_ = std::move(file.labels);
    if (!arguments.inks.materials.empty()) {
        MeshFile still;
        still.mesh = animation_.rest;
        still.labels = labels_;
        inks_ = read_inks(arguments.inks, arguments.input, still, &PartMaterial::line);
    }
    if (!arguments.model.empty()) {
        require_input(arguments.model);
        model_ = load_curvature_model(arguments.model);
        require_compatible(*model_, animation_);
        evaluator_ = std::make_unique<CurvatureEvaluator>(*model_);
    }
    drawable_ = std::make_unique<DrawableSurface>(faces(), vertices(0), arguments.measuring);
    if (model_) estimator_ = std::make_unique<CurvatureEstimator>(faces(), vertex_count());
}

std::vector<Vec3> LinesSource::vertices(std::size_t frame) const {
    const FrameRef& ref = frames_[frame];
    return frame_vertices(animation_, animation_.clips[ref.clip], ref.frame);
}

TriangleMesh LinesSource::mesh(std::size_t frame) const {
    TriangleMesh mesh;
    mesh.vertices = vertices(frame);
    mesh.faces = animation_.rest.faces;
    return mesh;
}

void LinesSource::predict(std::size_t frame) {
    estimator_->estimate(vertices_, {.derivatives = false});  // for its normals
    const FrameRef& ref = frames_[frame];
    const VertexCurvature& learned = evaluator_->evaluate(animation_.rig, shape_at(animation_, ref.clip, ref.frame),
                                                          vertices_, estimator_->normals());
    drawable_->take(vertices_, estimator_->normals(), learned);
}

LineSurface LinesSource::surface(std::size_t frame) {
    if (current_ != frame) {
        vertices_ = vertices(frame);
        if (model_)
            predict(frame);
        else
            drawable_->measure(vertices_);
        current_ = frame;
    }
    return drawable_->surface();
}

float LinesSource::feature_size() {
    if (!feature_size_) {
        if (model_) {
            feature_size_ = model_->feature_size;
        } else {
            surface(0);
            feature_size_ = drawable_->feature_size();
        }
    }
    if (!(*feature_size_ > 0))
        throw MeshError(fmt::format("{}: has no extent, all vertices are at one place; there is nothing to draw",
                                    arguments_.input.string()));
    return *feature_size_;
}

}  // namespace exemplar
