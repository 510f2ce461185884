// bench_lines ANIMATION [MODEL [PICTURE.png]]: cost of a line drawing of a frame on the device, from its pose to its
// image: median milliseconds of whole frames, wall and CPU time.

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "apps/exemplar/lines/frames_view.h"
#include "gpu/imaging/picture.h"
#include "gpu/lines/animation_renderer.h"
#include "gpu/runtime/device/device.h"
#include "host/animation/read_animation.h"
#include "host/core/errors.h"
#include "host/core/freed_memory.h"
#include "host/core/statistics.h"
#include "host/core/stopwatch.h"
#include "host/curvature/state/samples.h"
#include "host/imaging/png.h"

namespace exemplar {
namespace {

constexpr int k_width = 1280, k_height = 720;
constexpr std::size_t k_warm_up = 5, k_frames = 60;

LinePicture picture_of(const Animation& animation, const std::vector<FrameRef>& frames) {
    LinePicture picture;
    picture.view = view_of_frames(animation, frames, k_width, k_height);
    const LineType types[] = {LineType::contours, LineType::suggestive_contours};
    picture.families = line_families(types);
    picture.thresholds = family_thresholds({});
    picture.looks = plain_looks({}, {});
    return picture;
}

/// Stages of a frame; each measurement records one stage more.
struct Stage {
    const char* name;
    std::function<void(const FrameRef&)> record;
};

/// Milliseconds of a frame: wall time, and CPU time of this process, which other work slows less. CPU time includes
/// drivers that run on the CPU.
struct FrameTime {
    double wall, cpu;
};
FrameTime median_time(Stream& stream, const std::vector<FrameRef>& frames,
                      const std::function<void(const FrameRef&)>& record) {
    std::vector<double> wall, cpu;
    for (std::size_t i = 0; i < frames.size() + k_warm_up; ++i) {
        const Stopwatch watch;
        record(frames[i % frames.size()]);
        stream.finish();
        if (i < k_warm_up) continue;
        wall.push_back(1e3 * watch.wall());
        cpu.push_back(1e3 * watch.cpu());
    }
    return {upper_median(wall), upper_median(cpu)};
}

void run(const std::string& path, const std::string& model, const std::string& png) {
    keep_freed_memory();
    const Animation animation = read_animation(path);
    const std::vector<FrameRef> frames = select_frames(animation, {.clips = {}, .most = k_frames});
    Device device;
    std::optional<CurvatureModel> learned;
    if (!model.empty()) learned = load_curvature_model(model);
    AnimationRenderer drawn(device, animation, {.derivatives = true, .smoothing = 1}, learned ? &*learned : nullptr);
    LineRenderer& renderer = drawn.view();
    const LinePicture picture = picture_of(animation, frames);
    Stream stream(device);
    const CurvatureSource source = model.empty() ? CurvatureSource::estimated : CurvatureSource::learned;
    GpuLineExtraction lines(drawn.line_surface());
    GpuChains chains(lines);
    const auto pose = [&](const FrameRef& at) { drawn.record(stream, at, source); };
    const auto extract = [&](const FrameRef& at) {
        pose(at);
        lines.record(stream, drawn.snapshot(), picture.families,
                     {.eye = homogeneous_eye(picture.view.camera),
                      .feature_size = picture.view.feature_size,
                      .thresholds = picture.thresholds});
    };
    const auto chain = [&](const FrameRef& at) {
        extract(at);
        chains.record(stream, drawn.snapshot().vertices, picture.view.camera, k_width, k_height);
    };
    const auto draw = [&](const FrameRef& at) {
        pose(at);
        renderer.record(stream, drawn.snapshot(), picture);
    };
    const auto draw_and_download = [&](const FrameRef& at) {
        draw(at);
        renderer.record_download(stream);
    };
    const auto draw_again = [&](const FrameRef&) { renderer.record(stream, drawn.snapshot(), picture); };
    const std::vector<Stage> stages = {{"pose, normals, curvature", pose},
                                       {"and segments", extract},
                                       {"and chains", chain},
                                       {"and the surface, visibility and strokes: the image", draw},
                                       {"and the image on the host", draw_and_download},
                                       {"the image alone, of a surface that stands still", draw_again}};
    const auto print_flicker = [&](bool coherent) {
        LinePicture with = picture;
        with.coherent = coherent;
        double slip = 0, appeared = 0, stretch = 0;
        for (const FrameRef& at : frames) {
            pose(at);
            renderer.record(stream, drawn.snapshot(), with);
            stream.finish();
            if (&at == &frames[0]) continue;
            const LineFlicker flicker = renderer.coherence().flicker();
            slip += flicker.slip;
            appeared += flicker.appeared;
            stretch += flicker.stretch;
        }
        const double count = static_cast<double>(frames.size() - 1);
        fmt::print(
            "textures {}: move {:.2f} pixels a frame along lines; stretched by {:.1f} %; {:.2f} % of lines are "
            "new in a frame\n",
            coherent ? "kept" : "not kept", slip / count, 100 * stretch / count, 100 * appeared / count);
    };
    fmt::print("{} vertices, {} faces, {} x {}; medians over {} frames, milliseconds\n", animation.rest.vertex_count(),
               animation.rest.face_count(), k_width, k_height, frames.size());
    for (const Stage& stage : stages) {
        const FrameTime time = median_time(stream, frames, stage.record);
        fmt::print("{:>55} {:8.2f}  ({:.1f} a second), CPU {:.2f}\n", stage.name, time.wall, 1e3 / time.wall, time.cpu);
    }
    for (const bool coherent : {false, true}) print_flicker(coherent);
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
