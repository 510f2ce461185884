// The rows of `exemplar bench` about line drawings: what a frame costs from its pose to its image on the device.

#include <fmt/format.h>

#include "apps/exemplar/bench/bench_rows.h"
#include "apps/exemplar/lines/frames_view.h"
#include "gpu/lines/animation_renderer.h"
#include "host/core/freed_memory.h"

namespace exemplar {
namespace {

constexpr int k_bench_width = 1280, k_bench_height = 720;

LinePicture picture_of(const BenchCharacter& character) {
    LinePicture picture;
    picture.view = view_of_frames(character.unseen, character.unseen_frames, k_bench_width, k_bench_height);
    const LineType types[] = {LineType::contours, LineType::suggestive_contours};
    picture.families = line_families(types);
    picture.thresholds = family_thresholds({});
    picture.looks = plain_looks({}, {});
    return picture;
}

}  // namespace

void bench_lines(BenchContext& context, const std::function<void(const BenchRow&)>& row) {
    keep_freed_memory();
    const BenchCharacter& character = context.character();
    const CurvatureModel& model = context.curvature_model();
    Device device({.name = context.device_name()});
    AnimationRenderer renderer(device, character.unseen, model.truth, &model);
    const LinePicture picture = picture_of(character);
    // The host records a frame while the device draws the one before.
    Stream streams[] = {Stream(device), Stream(device)};
    const auto draw_all = [&](CurvatureSource from) {
        for (std::size_t i = 0; i < character.unseen_frames.size(); ++i) {
            Stream& stream = streams[i % 2];
            stream.wait();
            renderer.record(stream, character.unseen_frames[i], from);
            renderer.view().record(stream, renderer.snapshot(), picture);
            stream.submit();
        }
        for (Stream& stream : streams) stream.wait();
    };
    for (const CurvatureSource from : {CurvatureSource::learned, CurvatureSource::estimated}) {
        draw_all(from);  // once untimed: D17 in docs/portability.md
        Cost cost = measure(3 * context.runs(), [&] { draw_all(from); });
        const auto frames = static_cast<double>(character.unseen_frames.size());
        for (double* seconds : {&cost.wall, &cost.cpu}) *seconds /= frames;
        row({.name = "lines",
             .what = fmt::format("two types, {}, pose to image, 20k vertices, {} x {}, {}",
                                 from == CurvatureSource::learned ? "learned curvature" : "estimated with diffusion",
                                 k_bench_width, k_bench_height, device.info().name),
             .goal = "24 frames a second",
             .cost = cost,
             .remarks = {fmt::format("{:.1f} frames a second", 1 / cost.wall)},
             .numbers = {{"frames_per_second", 1 / cost.wall}}});
    }
}

}  // namespace exemplar
