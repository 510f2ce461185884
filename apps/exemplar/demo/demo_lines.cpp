#include "apps/exemplar/demo/demo_lines.h"

#include <fmt/format.h>

#include <array>

#include "apps/exemplar/lines/frames_view.h"
#include "host/animation/write_animation.h"
#include "host/core/files.h"
#include "host/core/interrupt.h"
#include "host/core/progress.h"
#include "host/core/stopwatch.h"
#include "host/core/text.h"
#include "host/curvature/learning/training.h"
#include "host/curvature/model/evaluation.h"
#include "host/lines/drawing_svg.h"
#include "host/synth/animations/animations.h"

namespace exemplar {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t k_vertices = 4000, k_seen = 60, k_frames = 120, k_demo_frames = 30;
constexpr int k_demo_width = 560, k_demo_height = 620;
constexpr std::array k_types{LineType::suggestive_contours, LineType::contours};

/// One frame twice: by learned curvature, and by that which is measured in it.
Drawing draw_twice(const std::vector<Face>& faces, const std::vector<FaceNeighbors>& neighbors,
                   const FrameCurvature& at, const DrawingStyle& style, const StrokeView& view) {
    const auto draw = [&](const VertexCurvature& curvature) {
        return draw_lines({faces, at.snapshot.vertices, at.snapshot.normals, curvature, neighbors}, k_types, style,
                          view);
    };
    return side_by_side(draw(at.learned), draw(at.snapshot.curvature));
}

std::vector<Drawing> draw_demo_frames(const CurvatureModel& model, const Animation& animation,
                                      const std::vector<FrameRef>& frames, const DrawingStyle& style) {
    StrokeView view = view_of_frames(animation, frames, k_demo_width, k_demo_height);
    view.feature_size = model.feature_size;
    const std::vector<Face>& faces = animation.rest.faces;
    const std::vector<FaceNeighbors> neighbors = build_face_neighbors(faces, animation.rest.vertices);
    std::vector<Drawing> drawings;
    Progress progress("drawing a figure in lines", frames.size());
    for (const FrameRef& frame : frames) {
        check_interrupt();
        drawings.push_back(draw_twice(faces, neighbors, curvature_at(model, animation, frame), style, view));
        progress.advance();
    }
    return drawings;
}

/// Returns the error of suggestive contours, as contours do not depend on curvature.
LineError error_of_lines(const CurvatureModel& model, const Animation& animation, const std::vector<FrameRef>& frames) {
    for (const LineError& error : evaluate_curvature(model, animation, frames).lines)
        if (error.type == LineType::suggestive_contours) return error;
    return {};
}

}  // namespace

DemoLines make_demo_lines(const fs::path& folder, std::uint64_t seed) {
    const Stopwatch watch;
    fs::create_directories(folder);
    const Animation animation =
        make_animation("figure", {.vertices = k_vertices, .frames = k_frames, .motion_seed = seed});
    write_gltf_animation(folder / "figure.glb", animation);
    const Stopwatch training_watch;
    CurvatureTrainingReport training;
    const CurvatureModel model =
        train_curvature(animation, select_frames(animation, {.clips = {}, .end = k_seen}), {.seed = seed}, training);
    const double learned = training_watch.wall();
    save_curvature_model(folder / "figure.safetensors", model);
    const std::vector<FrameRef> unseen =
        select_frames(animation, {.clips = {}, .begin = k_seen, .most = k_demo_frames});
    const DrawingStyle style = load_style("ink");
    const std::vector<Drawing> drawings = draw_demo_frames(model, animation, unseen, style);
    SvgOptions svg;
    // The shown frames take the time of all unseen ones.
    svg.frames_per_second = animation.clips[0].frames_per_second * k_demo_frames / (k_frames - k_seen);
    svg.title = "A figure in lines";
    write_drawing_svg(folder / "figure.svg", drawings, style, svg);

    const LineError error = error_of_lines(model, animation, unseen);
    DemoLines result;
    result.drawing = {.title = "A moving figure, drawn by learned curvature",
                      .text = fmt::format(
                          "From the first {} frames of its motion the program has learned, in {}, how the curvature of "
                          "this surface follows from its pose. The next {} it had never seen. Of all faces {:.2f} % "
                          "carry a suggestive contour in a frame; learned curvature has {:.2f} % of the faces wrong, "
                          "the mean of training in its place {:.2f} %.",
                          k_seen, format_seconds(learned), k_frames - k_seen, 100 * error.truth,
                          100 * error.misclassified, 100 * error.zero_order),
                      .svg = read_file(folder / "figure.svg"),
                      .captions = {"by learned curvature", "by curvature measured in each frame"}};
    result.report = {{"frames", unseen.size()},
                     {"faces_with_line", error.truth},
                     {"misclassified", error.misclassified},
                     {"zero_order_misclassified", error.zero_order},
                     {"seconds", watch.wall()}};
    return result;
}

}  // namespace exemplar
