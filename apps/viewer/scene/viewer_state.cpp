#include "apps/viewer/scene/viewer_state.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <new>

#include "host/animation/random_poses.h"
#include "host/core/errors.h"
#include "host/core/files.h"

namespace exemplar {
namespace {

namespace fs = std::filesystem;

bool is_labels_file(const fs::path& path) {
    return path.extension() == ".seg" || path.filename().string().ends_with("_labels.txt");
}

// Returns a ball around the surface in some frames of a clip.
ViewBall ball_of(const Animation& animation, std::size_t clip) {
    constexpr std::size_t k_frames = 12;
    const std::size_t frames = clip < animation.clips.size() ? animation.clips[clip].size() : std::size_t{1};
    std::vector<Vec3> points;
    for (std::size_t i = 0; i < std::min(frames, k_frames); ++i) {
        const std::size_t frame = i * frames / std::min(frames, k_frames);
        const std::vector<Vec3> vertices = vertices_of(animation, shape_at(animation, clip, frame));
        points.insert(points.end(), vertices.begin(), vertices.end());
    }
    return ball_around(points);
}

template <typename T, std::size_t count>
T next_of(const std::array<T, count>& values, T value) {
    const auto place = std::ranges::find(values, value);
    return place == values.end() || place + 1 == values.end() ? values.front() : *(place + 1);
}

SurfacePaint next_paint(SurfacePaint paint, bool has_colors) {
    constexpr std::array k_paints{SurfacePaint::plain,           SurfacePaint::faces,
                                  SurfacePaint::mean_curvature,  SurfacePaint::gaussian_curvature,
                                  SurfacePaint::first_curvature, SurfacePaint::second_curvature,
                                  SurfacePaint::normals};
    do {
        paint = next_of(k_paints, paint);
    } while (paint == SurfacePaint::faces && !has_colors);
    return paint;
}

}  // namespace

void ViewerState::open(const fs::path& path, ViewSize view) {
    if (path.extension() == ".safetensors" && labeling)
        labeling->use_model(std::make_shared<const LabelingModel>(load_model(path)));
    else if (path.extension() == ".safetensors")
        is_hatching_style(path) ? open_hatching(path) : open_model(path);
    else if (path.extension() == ".json")
        settings.set_style(load_style(path.string()));
    else if (is_labels_file(path))
        open_labels(path);
    else
        open_document(path, view);
}

void ViewerState::open_document(const fs::path& path, ViewSize view) {
    auto document = std::make_unique<Document>(read_document(path));
    labeling.reset();
    show_document(std::move(document), view);
    if (playback.frame_count() > 1) playback.play();
}

void ViewerState::show_document(std::unique_ptr<Document> document, ViewSize view) {
    training.reset();
    document_ = std::move(document);
    ++document_version_;
    set_model(nullptr, {});
    pose = PoseControls(document_->animation.rig);
    settings.paint = document_->face_colors.empty() ? SurfacePaint::plain : SurfacePaint::faces;
    set_clip(0);
    fit(view);
    for (const std::string& remark : document_->animation.warnings) messages.remark(remark);
}

void ViewerState::open_model(const fs::path& path) {
    auto model = std::make_shared<const CurvatureModel>(load_curvature_model(path));
    if (!document_)
        throw UsageError(fmt::format("{} is a model: open the animation first that it was learned on", path.string()));
    require_compatible(*model, document_->animation);
    if (model->truth.robust != RobustEstimator::none)
        messages.remark(fmt::format(
            "{} was trained with --robust; measured curvature beside it is not, as the device does not measure so",
            path.filename().string()));
    set_model(std::move(model), path.filename().string());
}

void ViewerState::open_hatching(const fs::path& path) {
    hatching_ = std::make_shared<const HatchingStyle>(load_hatching_style(path));
    hatching_name_ = path.filename().string();
}

void ViewerState::open_labels(const fs::path& path) {
    if (!document_) throw UsageError(fmt::format("{} holds labels: open their mesh first", path.string()));
    add_labels(*document_, path);
    ++document_version_;
    settings.paint = SurfacePaint::faces;
}

void ViewerState::close() {
    training.reset();
    labeling.reset();
    document_.reset();
    ++document_version_;
    set_model(nullptr, {});
    pose = {};
    playback.set_clip(0, 30);
}

void ViewerState::set_clip(std::size_t clip) {
    const std::vector<Clip>& clips = document_->animation.clips;
    clip_ = clips.empty() ? 0 : clip % clips.size();
    if (clips.empty())
        playback.set_clip(0, 30);
    else
        playback.set_clip(clips[clip_].size(), clips[clip_].frames_per_second);
}

void ViewerState::set_model(std::shared_ptr<const CurvatureModel> model, std::string name) {
    model_ = std::move(model);
    model_name_ = std::move(name);
    ++model_version_;
    settings.source = model_ ? ShownCurvature::learned : ShownCurvature::estimated;
}

void ViewerState::fit(ViewSize view) {
    if (!document_) return;
    if (shows_both()) view.width = std::max(view.width / 2, 1);
    camera.fit(ball_of(document_->animation, clip_), view);
}

SurfaceShape ViewerState::shape() const {
    SurfaceShape shape = shape_at(document_->animation, clip_, playback.frame());
    if (shape.pose && pose.changed()) shape.pose = pose.apply(*shape.pose);
    return shape;
}

// One switch over all actions but those of painting.
// NOLINTNEXTLINE(readability-function-size)
bool ViewerState::perform(Action action, ViewSize view) {
    constexpr float k_turn = 0.15f, k_zoom = 1.15f, k_faster = 1.25f;
    const Vec2 center(0.5f * static_cast<float>(view.width), 0.5f * static_cast<float>(view.height));
    switch (action) {
        case Action::play_pause:
            playback.toggle();
            return true;
        case Action::next_frame:
            playback.step(1);
            return true;
        case Action::previous_frame:
            playback.step(-1);
            return true;
        case Action::first_frame:
            playback.scrub(0);
            return true;
        case Action::last_frame:
            playback.scrub(playback.frame_count());
            return true;
        case Action::faster:
            playback.set_speed(playback.speed() * k_faster);
            return true;
        case Action::slower:
            playback.set_speed(playback.speed() / k_faster);
            return true;
        case Action::loop:
            playback.set_loops(!playback.loops());
            return true;
        case Action::next_clip:
            if (document_) set_clip(clip_ + 1);
            return true;
        case Action::fit:
            fit(view);
            return true;
        case Action::upright:
            camera.turn_upright();
            return true;
        case Action::front:
            camera.look_from(ViewSide::front);
            return true;
        case Action::back:
            camera.look_from(ViewSide::back);
            return true;
        case Action::left:
            camera.look_from(ViewSide::left);
            return true;
        case Action::right:
            camera.look_from(ViewSide::right);
            return true;
        case Action::top:
            camera.look_from(ViewSide::top);
            return true;
        case Action::bottom:
            camera.look_from(ViewSide::bottom);
            return true;
        case Action::parallel:
            camera.set_parallel(!camera.parallel());
            return true;
        case Action::turn_left:
            camera.turn(-k_turn, 0);
            return true;
        case Action::turn_right:
            camera.turn(k_turn, 0);
            return true;
        case Action::turn_up:
            camera.turn(0, -k_turn);
            return true;
        case Action::turn_down:
            camera.turn(0, k_turn);
            return true;
        case Action::zoom_in:
            camera.zoom(k_zoom, center, view);
            return true;
        case Action::zoom_out:
            camera.zoom(1 / k_zoom, center, view);
            return true;
        case Action::next_light:
            settings.light =
                next_of(std::array{SurfaceLight::smooth, SurfaceLight::flat, SurfaceLight::steps, SurfaceLight::none},
                        settings.light);
            return true;
        case Action::next_paint:
            settings.paint = next_paint(settings.paint, document_ && !document_->face_colors.empty());
            return true;
        case Action::curvature_source:
            if (model_)
                settings.source =
                    next_of(std::array{ShownCurvature::learned, ShownCurvature::estimated, ShownCurvature::both},
                            settings.source);
            return true;
        case Action::reset_pose:
            pose.reset();
            return true;
        case Action::panels:
            show_panels = !show_panels;
            return true;
        case Action::frame_times:
            show_times = !show_times;
            return true;
        case Action::help:
            show_help = !show_help;
            return true;
        case Action::save_png:
        case Action::save_svg:
        case Action::save_hatching:
        case Action::save_model:
        case Action::quit:
            break;
        default:  // those of painting
            if (labeling) perform_labeling(action, view);
            return true;
    }
    return false;
}

void ViewerState::start_training() {
    constexpr std::size_t k_random_poses = 300;
    constexpr std::uint64_t k_seed = 1;
    if (!document_) throw UsageError("there is nothing to learn from: open an animation first");
    Animation animation = document_->animation;
    if (animation.clips.empty() && animation.kind == AnimationKind::blend_shapes)
        animation.clips.push_back(random_expressions(animation.rig, k_random_poses, k_seed));
    if (animation.frame_count() < k_min_poses)
        throw UsageError(fmt::format("{}: {} frames are too few to learn from; at least {} are needed", animation.name,
                                     animation.frame_count(), k_min_poses));
    training = std::make_unique<TrainingJob>(std::move(animation), k_seed);
}

void ViewerState::collect_training() {
    if (!training || !training->finished()) return;
    const std::unique_ptr<TrainingJob> job = std::move(training);
    try {
        set_model(std::make_shared<const CurvatureModel>(job->take()), "trained here");
        messages.remark(fmt::format("Learned curvature of {}", document_->animation.name));
    } catch (const Interrupted&) {
        messages.remark("Training was canceled");
    } catch (const Error& error) {
        messages.error(error.what());
    } catch (const std::bad_alloc&) {
        messages.error("There is not enough memory to learn from this animation");
    }
}

void ViewerState::start_hatching(ViewSize size, const std::string& device, StillNames names) {
    if (hatching_job) return;
    hatching_job = std::make_unique<HatchingJob>(hatched_still(*this, size, device), std::move(names));
}

void ViewerState::collect_hatching() {
    if (!hatching_job || !hatching_job->finished()) return;
    const std::unique_ptr<HatchingJob> job = std::move(hatching_job);
    try {
        for (const fs::path& file : job->take()) messages.remark(fmt::format("Saved {}", fs::absolute(file).string()));
    } catch (const Interrupted&) {
        messages.remark("Hatching was canceled");
    } catch (const Error& error) {
        messages.error(error.what());
    } catch (const std::bad_alloc&) {
        messages.error("There is not enough memory to hatch this mesh; one of fewer faces may do");
    }
}

}  // namespace exemplar
