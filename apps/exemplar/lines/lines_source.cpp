#include "apps/exemplar/lines/lines_source.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "apps/exemplar/arguments.h"
#include "host/animation/read_animation.h"
#include "host/core/errors.h"
#include "host/mesh/io/io.h"

namespace exemplar {
namespace {

namespace fs = std::filesystem;

/// A mesh as an animation of one frame.
Animation still_of(const fs::path& path) {
    MeshFile file = read_mesh(path);
    DrawableMesh drawable = drawable_mesh(file.mesh, path.string());
    Animation animation;
    animation.name = path.string();
    animation.rest = std::move(drawable.mesh);
    animation.warnings = std::move(file.warnings);
    if (drawable.turned) animation.warnings.emplace_back("the surface is inside out; its faces were turned around");
    Clip clip;
    clip.name = path.stem().string();
    clip.frames.push_back(animation.rest.vertices);
    animation.clips.push_back(std::move(clip));
    return animation;
}

/// A clip of the pose at rest, for a rig that has none.
void add_rest_clip(Animation& animation) {
    Clip clip;
    clip.name = "rest";
    clip.poses.push_back(rest_pose(animation.rig));
    animation.clips.push_back(std::move(clip));
}

bool is_gltf(const fs::path& path) {
    std::string extension = path.extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return extension == ".glb" || extension == ".gltf";
}

/// Folders and glTF files with something that moves are animations, all else is a mesh.
bool moves(const LinesSourceArguments& arguments, Animation& animation) {
    const fs::path& path = arguments.input;
    require_input(path);
    const bool folder = fs::is_directory(path);
    if (!folder && !is_gltf(path)) return false;
    try {
        animation = read_animation(path, {.frames_per_second = arguments.frames_per_second});
        return true;
    } catch (const MeshError&) {
        // A glTF file may also hold a plain mesh. If it holds neither, reading that says what is wrong.
        if (folder || !arguments.model.empty()) throw;
    }
    return false;
}

}  // namespace

LinesSource::LinesSource(const LinesSourceArguments& arguments) : arguments_(arguments) {
    animated_ = moves(arguments, animation_);
    if (!animated_) {
        if (!arguments.model.empty())
            throw UsageError(fmt::format("--model is for animations: {} is a mesh, whose curvature is measured",
                                         arguments.input.string()));
        animation_ = still_of(arguments.input);
    }
    if (animation_.clips.empty()) add_rest_clip(animation_);
    if (!arguments.quiet)
        for (const std::string& warning : animation_.warnings)
            fmt::print(stderr, "warning: {}: {}\n", arguments.input.string(), warning);
    FrameSelection selection = selection_of(arguments.frames);
    if (arguments.first_frame_only && arguments.frames.range.empty() && arguments.frames.most == 0) selection.most = 1;
    frames_ = select_frames(animation_, selection);
    if (!arguments.model.empty()) {
        require_input(arguments.model);
        model_ = load_curvature_model(arguments.model);
        require_compatible(*model_, animation_);
        evaluator_ = std::make_unique<CurvatureEvaluator>(*model_);
    }
    const DrawableOptions options{arguments.smoothing, arguments.derivatives,
                                  model_ ? std::nullopt : arguments.split_angle};
    drawable_ = std::make_unique<DrawableSurface>(faces(), vertices(0), options);
    if (model_) estimator_ = std::make_unique<CurvatureEstimator>(faces(), vertex_count());
}

std::vector<Vec3> LinesSource::vertices(std::size_t frame) const {
    const FrameRef& ref = frames_[frame];
    return frame_vertices(animation_, animation_.clips[ref.clip], ref.frame);
}

void LinesSource::predict(std::size_t frame) {
    estimator_->estimate(vertices_, {.derivatives = false});  // for its normals
    const FrameRef& ref = frames_[frame];
    const Clip& clip = animation_.clips[ref.clip];
    curvature_ = clip.poses.empty()
                     ? &evaluator_->evaluate(vertices_, estimator_->normals())
                     : &evaluator_->evaluate(animation_.rig, clip.poses[ref.frame], vertices_, estimator_->normals());
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
    if (model_) return {faces(), vertices_, estimator_->normals(), *curvature_, neighbors()};
    return drawable_->surface();
}

float LinesSource::feature_size() {
    if (!feature_size_) {
        if (model_) {
            feature_size_ = model_->feature_size;
        } else {
            const LineSurface first = surface(0);
            feature_size_ = exemplar::feature_size(first.vertices, first.curvature);
        }
    }
    if (!(*feature_size_ > 0))
        throw MeshError(fmt::format("{}: has no extent, all vertices are at one place; there is nothing to draw",
                                    arguments_.input.string()));
    return *feature_size_;
}

}  // namespace exemplar
