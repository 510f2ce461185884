// bench_lines ANIMATION [MODEL [PICTURE.png]]: what a line drawing of a frame costs on the device, from its pose to its
// image: wall milliseconds of whole frames (medians), and device milliseconds by kernel.

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <optional>
#include <string>
#include <vector>

#include "gpu/curvature/animated_surface.h"
#include "gpu/lines/line_renderer.h"
#include "gpu/runtime/device.h"
#include "host/animation/read_animation.h"
#include "host/core/errors.h"
#include "host/core/stopwatch.h"
#include "host/curvature/samples.h"
#include "host/imaging/png.h"
#include "host/lines/lines.h"

namespace exemplar {
namespace {

constexpr int k_width = 1280, k_height = 720;
constexpr std::size_t k_warm_up = 5, k_frames = 60;

/// The camera that shows what all of these frames cover, seen obliquely.
Camera camera_around(const Animation& animation, const std::vector<FrameRef>& frames) {
    TriangleMesh all;
    for (const FrameRef& at : frames) {
        const std::vector<Vec3> vertices = frame_vertices(animation, animation.clips[at.clip], at.frame);
        all.vertices.insert(all.vertices.end(), vertices.begin(), vertices.end());
    }
    return fit_camera(all, Vec3(0.5f, 0.3f, 1), float(k_width) / k_height);
}

LinePicture picture_of(const Animation& animation, const std::vector<FrameRef>& frames) {
    LinePicture picture;
    picture.view.camera = camera_around(animation, frames);
    picture.view.width = k_width;
    picture.view.height = k_height;
    TriangleMesh mesh = animation.rest;
    mesh.vertices = frame_vertices(animation, animation.clips[frames[0].clip], frames[0].frame);
    picture.view.feature_size = feature_size(mesh.vertices, estimate_curvature(mesh, false));
    picture.view.unit_depth = (picture.view.camera.position() - area_centroid(mesh)).norm();
    const LineType types[] = {LineType::contours, LineType::suggestive_contours};
    picture.families = line_families(types);
    picture.looks = plain_looks(picture.thresholds, {});
    return picture;
}

void run(const std::string& path, const std::string& model, const std::string& png) {
    const Animation animation = read_animation(path);
    const std::vector<FrameRef> frames = select_frames(animation, {.clips = {}, .most = k_frames});
    Device device;
    const GpuSurface surface(device, animation.rest);
    const GpuLineSurface line_surface(surface);
    GpuAnimatedSurface moving(surface, animation.rig, {.derivatives = true, .smoothing = 1});
    if (!model.empty()) moving.set_model(load_curvature_model(model));
    LineRenderer renderer(device, line_surface);
    const LinePicture picture = picture_of(animation, frames);
    Profiler profiler;
    Stream stream(device), profiled(device, &profiler);
    const auto record = [&](Stream& into, const FrameRef& at) {
        const Clip& clip = animation.clips[at.clip];
        const CurvatureSource source = model.empty() ? CurvatureSource::estimated : CurvatureSource::learned;
        if (clip.poses.empty())
            moving.record(into, clip.frames[at.frame], source);
        else
            moving.record(into, clip.poses[at.frame], source);
        const auto [first, second, derivative] = moving.curvature();
        renderer.record(into, {moving.vertices(), moving.normals(), first, second, derivative}, picture);
        renderer.record_download(into);
        into.finish();
    };
    std::vector<double> seconds;
    for (std::size_t i = 0; i < frames.size() + k_warm_up; ++i) {
        const Stopwatch watch;
        record(stream, frames[i % frames.size()]);
        if (i >= k_warm_up) seconds.push_back(watch.wall());
    }
    if (!png.empty()) write_png(png, renderer.read_image());
    for (const FrameRef& at : frames) record(profiled, at);
    std::sort(seconds.begin(), seconds.end());
    const double median = seconds[seconds.size() / 2];
    fmt::print("{} vertices: {:.2f} ms a frame, {:.1f} frames/s (median of {})\n", animation.rest.vertex_count(),
               1e3 * median, 1 / median, seconds.size());
    for (const auto& [name, entry] : profiler.entries())
        fmt::print("{:>40} {:8.3f} ms in {} dispatches\n", name, entry.milliseconds / double(frames.size()),
                   entry.dispatches / frames.size());
}

}  // namespace
}  // namespace exemplar

int main(int argc, char** argv) {
    if (argc < 2) {
        fmt::print(stderr, "usage: bench_lines ANIMATION [MODEL [PICTURE.png]]\n");
        return 2;
    }
    try {
        exemplar::run(argv[1], argc > 2 ? argv[2] : "", argc > 3 ? argv[3] : "");
    } catch (const std::exception& error) {
        fmt::print(stderr, "error: {}\n", error.what());
        return 1;
    }
}
