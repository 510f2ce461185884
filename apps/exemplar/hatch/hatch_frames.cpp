// exemplar hatch draw: an animation, frame by frame, with strokes that stay on the surface.

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <optional>

#include "apps/exemplar/arguments.h"
#include "apps/exemplar/hatch/hatch_draw.h"
#include "apps/exemplar/video.h"
#include "gpu/hatching/hatching_device.h"
#include "host/core/errors.h"
#include "host/core/interrupt.h"
#include "host/core/progress.h"
#include "host/core/stopwatch.h"
#include "host/core/text.h"
#include "host/hatching/animation/advected_strokes.h"
#include "host/hatching/animation/hatching_flicker.h"
#include "host/imaging/png.h"
#include "host/mesh/editing/loose_vertices.h"
#include "host/mesh/io/io.h"
#include "host/mesh/label_files/label_files.h"

namespace exemplar {
namespace {

namespace fs = std::filesystem;

/// The frames of an animation, or of a mesh that turns, and the camera of each.
class HatchedFrames {
  public:
    explicit HatchedFrames(const HatchDrawJob& job) : job_(job), source_(arguments_of(job)) {
        const FrameSelection asked = selection_of(job.source.frames);
        const std::size_t around =
            job.turn != 0 ? static_cast<std::size_t>(std::lround(360 / std::abs(job.turn))) : std::size_t{1};
        const std::size_t of_mesh = std::min(asked.end, std::max(asked.begin + 1, around)) - asked.begin;
        count_ = source_.is_animation() ? source_.frame_count() : of_mesh;
        first_ = source_.is_animation() ? 0 : asked.begin;
        if (!source_.is_animation() && (!job.source.frames.clips.empty() || job.source.frames.most > 0))
            throw UsageError(
                fmt::format("--clips and --poses are for animations: {} is a mesh, whose frames are those of "
                            "--turn and --frames",
                            job.scene.mesh.string()));
        kept_ = vertices_of_faces(source_.animation().rest);
        surface_ = without_loose_vertices(source_.animation().rest);
        up_ = point_of(job.scene.camera.up, "--up").normalized();
        find_camera();
    }

    std::size_t count() const { return count_; }
    double frames_per_second() const { return moves() ? source_.frames_per_second() : job_.source.frames_per_second; }
    bool moves() const { return source_.is_animation(); }
    const std::optional<FaceLabels>& labels() const { return source_.labels(); }
    TriangleMesh mesh(std::size_t frame) const {
        const std::vector<Vec3> all = source_.vertices(moves() ? frame : 0);
        TriangleMesh mesh = surface_;
        for (std::size_t i = 0; i < kept_.size(); ++i) mesh.vertices[i] = all[kept_[i]];
        return mesh;
    }
    /// Turns the object before a fixed camera, by turning the camera around it.
    HatchingView view(std::size_t frame) const {
        HatchingView view;
        view.camera = sized_.camera;
        view.camera.view = (Eigen::Affine3f(sized_.camera.view) * turned(frame)).matrix();
        view.light = light_from(view.camera, point_of(job_.scene.light, "--light"));
        view.width = sized_.width;
        view.height = sized_.height;
        view.up = up_;
        return view;
    }
    float unit_depth() const { return unit_depth_; }
    const TriangleMesh& surface() const { return surface_; }

  private:
    /// For a mesh the frames are those of its turning, not of an animation.
    static LinesSourceArguments arguments_of(const HatchDrawJob& job) {
        LinesSourceArguments arguments = job.source;
        if (job.turn != 0 && !is_animation(arguments)) arguments.frames = {};
        return arguments;
    }
    static bool is_animation(LinesSourceArguments arguments) {
        arguments.frames = {};
        arguments.first_frame_only = arguments.quiet = true;
        return LinesSource(arguments).is_animation();
    }

    Eigen::Affine3f turned(std::size_t frame) const {
        const auto angle = static_cast<float>(static_cast<double>(first_ + frame) * job_.turn * std::numbers::pi / 180);
        return Eigen::Translation3f(center_) * Eigen::AngleAxisf(angle, up_) * Eigen::Translation3f(-center_);
    }

    void find_camera() {
        constexpr std::size_t k_most = 60;
        const TriangleMesh first = mesh(0);
        const BoundingBox box = bounding_box(first);
        center_ = (0.5 * (box.low + box.high)).cast<float>();
        TriangleMesh extent;
        const std::size_t some = std::min(count_, k_most);
        for (std::size_t i = 0; i < some; ++i) {
            const std::size_t frame = some > 1 ? i * (count_ - 1) / (some - 1) : 0;
            for (const Vec3& vertex : mesh(frame).vertices) extent.vertices.push_back(turned(frame) * vertex);
        }
        sized_ = camera_of(job_.scene.camera, extent);
        unit_depth_ = std::max(-(sized_.camera.view * center_.homogeneous()).z(), 1e-20f);
    }

    const HatchDrawJob& job_;
    LinesSource source_;
    std::size_t count_ = 0, first_ = 0;  // first_: of a mesh that turns
    std::vector<std::uint32_t> kept_;    // vertices of the source that the surface has
    TriangleMesh surface_;
    SizedCamera sized_;
    Vec3 up_ = Vec3::UnitY(), center_ = Vec3::Zero();
    float unit_depth_ = 1;
};

/// Hatches frames, one after the other.
class FrameHatcher {
  public:
    FrameHatcher(const HatchDrawJob& job, const HatchedFrames& frames)
        : job_(job), frames_(frames), style_(load_hatching_style(job.style)), device_({.name = job.common.device}) {
        const HatchingView view = frames.view(0);
        style_.resize(view.width, view.height);
        look_ = curve_look(style_);
        if (!job.scene.labels.empty()) labels_ = read_face_labels(job.scene.labels, frames.surface());
        if (job.scene.materials.empty()) return;
        MeshFile still;
        still.mesh = frames.surface();
        still.labels = frames.labels();
        inks_ = read_hatching_inks(job.scene, still);
    }

    HatchedDrawing draw(std::size_t frame) {
        follow(frame);
        const HatchingView view = frames_.view(frame);
        PixelFeatures pixels(*surface_, view, device_.tools().images);
        if (labels_) pixels.set_labels(*labels_);
        const std::vector<AdvectedStroke> carried = advected_strokes(before_, surface_->mesh, view, pixels.gbuffer());
        std::vector<HatchStroke> kept;
        if (!job_.fresh)
            for (const AdvectedStroke& one : carried) kept.push_back(one.stroke);
        ViewHatching hatching = hatch_view(style_, pixels, device_.tools(), job_.hatching, kept);
        if (frame > 0) flicker_.push_back(measure_flicker(hatching.strokes, carried));
        stroke_counts_.push_back(hatching.strokes.size());
        if (!inks_.strokes.empty()) inks_.face = pixels.gbuffer().face;
        before_ = strokes_on_surface(hatching.strokes, surface_->mesh, view, pixels.gbuffer());
        taper_strokes(hatching.strokes, job_.taper_of(style_));
        return {view.width, view.height, std::move(hatching.strokes),
                feature_curves(*surface_, view, job_.curve_types(), look_, frames_.unit_depth()), inks_};
    }

    const DrawingStyle& look() const { return look_; }
    const std::vector<HatchingFlicker>& flicker() const { return flicker_; }
    const std::vector<std::size_t>& stroke_counts() const { return stroke_counts_; }
    const std::string& style_name() const { return style_.name; }
    const std::string& device_name() { return device_.device().info().name; }

  private:
    void follow(std::size_t frame) {
        if (surface_ && !frames_.moves()) return;
        const TriangleMesh mesh = frames_.mesh(frame);
        if (!surface_)
            surface_ = cached_surface(mesh, usable_cache(job_.scene.cache, job_.common.quiet, "measured surfaces"));
        else if (job_.remeasure)
            surface_ = measure_surface(mesh);
        else
            move_surface(*surface_, mesh.vertices);
    }

    const HatchDrawJob& job_;
    const HatchedFrames& frames_;
    HatchingStyle style_;
    HatchingDevice device_;
    DrawingStyle look_;
    std::optional<FaceLabels> labels_;
    HatchingInks inks_;
    std::optional<HatchingSurface> surface_;
    std::vector<SurfaceStroke> before_;
    std::vector<HatchingFlicker> flicker_;
    std::vector<std::size_t> stroke_counts_;  // of each frame
};

/// Draws all frames and writes them in the way that the job asks for.
void write_frames(const HatchDrawJob& job, const HatchedFrames& frames, FrameHatcher& hatcher) {
    if (job.is_single_picture()) return write_hatched_drawing(job, hatcher.draw(0), hatcher.look());
    std::optional<Video> video;
    if (job.output == LinesOutput::folder) fs::create_directories(job.out);
    Progress progress("drawing", frames.count());
    for (std::size_t frame = 0; frame < frames.count(); ++frame) {
        check_interrupt();
        const Image image = hatching_picture(hatcher.draw(frame), hatcher.look(), job.scale);
        if (job.output == LinesOutput::folder) {
            write_png(job.out / fmt::format("frame_{:04}.png", frame), image);
        } else {
            if (!video) video.emplace(job.out, image.width, image.height, frames.frames_per_second());
            video->add(image);
        }
        progress.advance();
    }
    if (video) video->finish();
}

nlohmann::json described(const HatchingFlicker& flicker) {
    return {{"drawn", flicker.drawn},
            {"appeared", flicker.appeared},
            {"vanished", flicker.vanished},
            {"slip", flicker.slip}};
}

void print_and_report(const HatchDrawJob& job, const HatchedFrames& frames, FrameHatcher& hatcher, double seconds) {
    const HatchingFlicker flicker = mean_flicker(hatcher.flicker());
    if (!job.common.quiet) {
        fmt::print("{}: {}, {:.1f} s each\n", job.out.string(), counted(frames.count(), "frame"),
                   seconds / static_cast<double>(frames.count()));
        if (frames.count() > 1)
            fmt::print(
                "from a frame to the next {:.1f} % of the length of strokes is new, {:.1f} % vanishes, and ends slip "
                "by {:.1f} pixels\n",
                100 * flicker.appeared, 100 * flicker.vanished, flicker.slip);
    }
    nlohmann::json report = {{"input", job.scene.mesh.string()},   {"style", hatcher.style_name()},
                             {"device", hatcher.device_name()},    {"frames", frames.count()},
                             {"strokes", hatcher.stroke_counts()}, {"seconds", seconds}};
    if (frames.count() > 1) report["flicker"] = described(flicker);
    for (const HatchingFlicker& one : hatcher.flicker()) report["flicker_of_frames"].push_back(described(one));
    write_report(job.common, report);
}

}  // namespace

void write_hatched_frames(const HatchDrawJob& job) {
    if (!job.properties.empty()) throw UsageError("--properties is for a still; leave out what asks for frames");
    if (job.output == LinesOutput::video) require_ffmpeg(job.out);
    const Stopwatch watch;
    const HatchedFrames frames(job);
    if (job.is_single_picture() && frames.count() > 1)
        throw UsageError(fmt::format("{}: {} frames are no single picture; give a folder or one frame (--frames 0)",
                                     job.out.string(), frames.count()));
    FrameHatcher hatcher(job, frames);
    write_frames(job, frames, hatcher);
    print_and_report(job, frames, hatcher, watch.wall());
}

}  // namespace exemplar
