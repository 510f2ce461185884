// The rows of `exemplar bench` about the host's work for a device: what a graphics card waits for. Counted, not timed,
// so the numbers are the same on every machine. Device memory counts as not mapped, and kernels run also where the host
// would be faster: as on a graphics card.

#include <fmt/format.h>

#include <array>

#include "apps/exemplar/bench/bench_data.h"
#include "apps/exemplar/bench/bench_rows.h"
#include "apps/exemplar/lines/frames_view.h"
#include "gpu/hatching/hatching_device.h"
#include "gpu/labeling/labeling_device.h"
#include "gpu/lines/animation_renderer.h"
#include "host/imaging/camera.h"
#include "host/synth/shapes/shapes.h"

namespace exemplar {
namespace {

constexpr std::size_t k_counted_meshes = 8, k_counted_faces = 20'000, k_counted_columns = 330;

DeviceOptions as_a_card(const BenchContext& context) {
    return {.name = context.device_name(), .switches = DeviceSwitches{.maps_memory = false, .prefers_host = false}};
}

/// Measures a unit of work, and counts its tasks once it has run before, so that what is kept is there.
void count_tasks(Device& device, BenchRow result, const std::function<void(const BenchRow&)>& row,
                 const std::function<void()>& unit) {
    unit();
    const HostWork before = device.host_work().total();
    unit();
    const HostWork work = device.host_work().total().since(before);
    std::string remark;
    for (std::size_t i = 0; i < k_host_tasks; ++i) {
        const auto task = static_cast<HostTask>(i);
        remark += fmt::format("{}{} {}", remark.empty() ? "" : ", ", work[task], plural_name(task));
        result.numbers[std::string(plural_name(task))] = work[task];
    }
    result.name = "host";
    result.remarks.push_back(std::move(remark));
    result.cost = measure(1, unit);
    row(result);
}

void count_scoring(BenchContext& context, const std::function<void(const BenchRow&)>& row) {
    constexpr std::size_t k_classes = 8, k_stumps = 1200;
    LabelingDevice device(as_a_card(context));
    const FeatureMatrix features = make_boosting_data(k_counted_faces, k_counted_columns, k_classes).features;
    const BoostedStumps classifier = random_stumps(k_stumps, k_counted_columns, k_classes);
    std::vector<std::vector<float>> out(k_counted_meshes, std::vector<float>(k_counted_faces * k_classes));
    std::vector<ScoredMatrix> matrices;
    matrices.reserve(out.size());
    for (std::vector<float>& probabilities : out) matrices.push_back({&features, probabilities});
    count_tasks(device.device(),
                {.what = fmt::format("stump scoring, {} meshes of {} faces", k_counted_meshes, k_counted_faces),
                 .goal = "1 submission, 2 copies"},
                row, [&] { device.labeling().scorer.probabilities_of_all(classifier, Link::softmax, 1, matrices); });
}

void count_scores(BenchContext& context, const std::function<void(const BenchRow&)>& row) {
    LabelingDevice device(as_a_card(context));
    const LabelingModel& model = context.model();
    std::vector<MeshFeatures> features(k_counted_meshes, compute_features(context.mesh().mesh));
    std::vector<MeshFeatures*> meshes;
    meshes.reserve(features.size());
    for (MeshFeatures& mesh : features) meshes.push_back(&mesh);
    count_tasks(device.device(),
                {.what = fmt::format("all scores of {} meshes of {} faces, {} stages of labels and {} of edges",
                                     k_counted_meshes, context.mesh().mesh.face_count(), model.unary.size(),
                                     model.pairwise.size()),
                 .goal = "2 submissions"},
                row, [&] { score_faces(model, meshes, device.labeling()); });
}

void count_features(BenchContext& context, const std::function<void(const BenchRow&)>& row) {
    constexpr int k_size = 512;
    HatchingDevice device(as_a_card(context));
    ImageTools& images = device.tools().images;
    const HatchingSurface surface = measure_surface(make_shape("fourleg", 1, 2000).mesh);
    HatchingView view{.camera = fit_camera(surface.mesh, Vec3(0.3f, 0.8f, 1), 1), .width = k_size, .height = k_size};
    view.light = default_light(view.camera);
    const GBuffer gbuffer = images.gbuffers.render(surface.mesh, view.camera, k_size, k_size);
    ImageStack stack(k_size, k_size, k_max_derived_images);
    for (std::size_t i = 0; i < stack.values.size(); ++i) stack.values[i] = gbuffer.barycentric[i % stack.pixels()][0];
    count_tasks(device.device(), {.what = "derivatives of four images, 512 x 512", .goal = "1 submission"}, row,
                [&] { images.filters.derivatives(stack, gbuffer.face, 2, false); });
    std::vector<std::uint32_t> all(k_pixel_features);
    for (std::uint32_t k = 0; k < k_pixel_features; ++k) all[k] = k;
    count_tasks(device.device(), {.what = "all features of a picture, 512 x 512", .goal = "15 submissions"}, row, [&] {
        PixelFeatures pixels(surface, view, images);
        pixels.scalars(all, {});
        pixels.orientations({});
    });
}

void count_frame(BenchContext& context, const std::function<void(const BenchRow&)>& row) {
    const BenchCharacter& character = context.character();
    const CurvatureModel& model = context.curvature_model();
    Device device(as_a_card(context));
    AnimationRenderer renderer(device, character.unseen, model.truth, &model);
    LinePicture picture;
    picture.view = view_of_frames(character.unseen, character.unseen_frames, 1280, 720);
    picture.families = line_families(std::array{LineType::contours, LineType::suggestive_contours});
    picture.thresholds = family_thresholds({});
    picture.looks = plain_looks({}, {});
    Stream stream(device);
    // Buffers take turns from frame to frame: after two frames all sets are known.
    const auto draw = [&] {
        for (int i = 0; i < 2; ++i) {
            renderer.record(stream, character.unseen_frames.front(), CurvatureSource::learned);
            renderer.view().record(stream, renderer.snapshot(), picture);
            stream.finish();
        }
    };
    count_tasks(device, {.what = "two frames of lines, 1280 x 720", .goal = "no views, sets or allocations"}, row,
                draw);
}

void count_allocations(BenchContext& context, const std::function<void(const BenchRow&)>& row) {
    constexpr std::size_t k_buffers = 3000;
    Device device(as_a_card(context));
    std::vector<Buffer> buffers(k_buffers);
    BenchRow result{
        .name = "host", .what = fmt::format("{} buffers of 4 to 64 KiB", k_buffers), .goal = "40 allocations"};
    result.cost = measure(1, [&] {
        for (std::size_t i = 0; i < k_buffers; ++i) buffers[i] = Buffer(device, (1 + i % 16) << 12);
    });
    const std::size_t live = device.memory().live_allocations();
    result.remarks.push_back(fmt::format("{} allocations of device memory", live));
    result.numbers["live_allocations"] = live;
    row(result);
}

}  // namespace

void bench_host_work(BenchContext& context, const std::function<void(const BenchRow&)>& row) {
    count_scoring(context, row);
    count_scores(context, row);
    count_features(context, row);
    count_frame(context, row);
    count_allocations(context, row);
}

}  // namespace exemplar
