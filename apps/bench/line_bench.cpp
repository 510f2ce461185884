// bench_lines ANIMATION [MODEL [PICTURE.png]]: what a line drawing of a frame costs on the device, from its pose to its
// image: wall milliseconds of whole frames (medians), and device milliseconds by kernel.

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <functional>
#include <string>
#include <vector>

#include "gpu/curvature/animated_surface.h"
#include "gpu/imaging/picture.h"
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
    picture.thresholds = family_thresholds({});
    picture.looks = plain_looks({}, {});
    return picture;
}

/// What is recorded for a frame, one stage more each time.
struct Stage {
    const char* name;
    std::function<void(const FrameRef&)> record;
};

double median_milliseconds(Stream& stream, const std::vector<FrameRef>& frames,
                           const std::function<void(const FrameRef&)>& record) {
    std::vector<double> milliseconds;
    for (std::size_t i = 0; i < frames.size() + k_warm_up; ++i) {
        const Stopwatch watch;
        record(frames[i % frames.size()]);
        stream.finish();
        if (i >= k_warm_up) milliseconds.push_back(1e3 * watch.wall());
    }
    const auto middle = milliseconds.begin() + static_cast<std::ptrdiff_t>(milliseconds.size() / 2);
    std::nth_element(milliseconds.begin(), middle, milliseconds.end());
    return *middle;
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
    Stream stream(device);
    const CurvatureSource source = model.empty() ? CurvatureSource::estimated : CurvatureSource::learned;
    GpuLineExtraction lines(line_surface);
    GpuChains chains(lines);
    const auto pose = [&](const FrameRef& at) {
        const Clip& clip = animation.clips[at.clip];
        if (clip.poses.empty())
            moving.record(stream, clip.frames[at.frame], source);
        else
            moving.record(stream, clip.poses[at.frame], source);
    };
    const auto extract = [&](const FrameRef& at) {
        pose(at);
        lines.record(stream, moving.moment(), picture.families,
                     {.eye = homogeneous_eye(picture.view.camera),
                      .feature_size = picture.view.feature_size,
                      .thresholds = picture.thresholds});
    };
    const auto chain = [&](const FrameRef& at) {
        extract(at);
        chains.record(stream, moving.vertices(), picture.view.camera, k_width, k_height);
    };
    const auto draw = [&](const FrameRef& at) {
        pose(at);
        renderer.record(stream, moving.moment(), picture);
    };
    const auto draw_and_download = [&](const FrameRef& at) {
        draw(at);
        renderer.record_download(stream);
    };
    const std::vector<Stage> stages = {{"pose, normals, curvature", pose},
                                       {"and segments", extract},
                                       {"and chains", chain},
                                       {"and the surface, visibility and strokes: the image", draw},
                                       {"and the image on the host", draw_and_download}};
    fmt::print("{} vertices, {} faces, {} x {}; medians over {} frames, milliseconds\n", animation.rest.vertex_count(),
               animation.rest.face_count(), k_width, k_height, frames.size());
    for (const Stage& stage : stages) {
        const double median = median_milliseconds(stream, frames, stage.record);
        fmt::print("{:>55} {:8.2f}  ({:.1f} a second)\n", stage.name, median, 1e3 / median);
    }
    if (!png.empty()) write_png(png, renderer.read_image());
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
