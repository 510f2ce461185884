// The rows of `exemplar bench` that say how costs grow with the size of the mesh.

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "apps/exemplar/bench/bench_data.h"
#include "apps/exemplar/bench/bench_rows.h"
#include "host/core/progress.h"
#include "host/labeling/inference/mesh_labeling.h"
#include "host/labeling/training/training.h"
#include "host/lines/drawing.h"
#include "host/lines/extraction/drawable_surface.h"
#include "host/lines/strokes/style.h"
#include "host/lines/strokes/view_point.h"
#include "host/mesh/editing/drawable_mesh.h"
#include "host/synth/arrangements/arrangements.h"
#include "host/synth/shapes/shapes.h"

namespace exemplar {
namespace {

constexpr std::size_t k_coarsest = 2000, k_sizes = 6;  // each 4 times the one before: up to two million faces

/// Costs of one operation over the sizes.
struct Growth {
    std::string what;
    std::vector<double> faces, cpu, memory;
    std::vector<Cost> costs;

    void add(std::size_t face_count, const Cost& cost) {
        faces.push_back(static_cast<double>(face_count));
        cpu.push_back(cost.cpu);
        memory.push_back(cost.own);
        costs.push_back(cost);
    }
};

/// Adds the exponent over all sizes and that between the last two, where the steepest of several terms shows first.
void add_exponent(const char* what, const char* key, const std::vector<double>& faces,
                  const std::vector<double>& values, BenchRow& result) {
    if (std::ranges::any_of(values, [](double value) { return !(value > 0); })) return;
    const std::size_t last = faces.size() - 1;
    const double all = fitted_exponent(faces, values);
    const double end = fitted_exponent({faces[last - 1], faces[last]}, {values[last - 1], values[last]});
    result.remarks.push_back(
        fmt::format("{} grows with faces to the power of {:.2f}; {:.2f} between the last two sizes", what, all, end));
    result.numbers[key] = all;
    result.numbers[std::string(key) + "_at_end"] = end;
}

void report_growth(const char* part, const Growth& growth, const std::function<void(const BenchRow&)>& row) {
    for (std::size_t i = 0; i < growth.costs.size(); ++i) {
        BenchRow result{.name = part,
                        .what = fmt::format("{}, {:.0f} faces", growth.what, growth.faces[i]),
                        .cost = growth.costs[i]};
        if (i + 1 == growth.costs.size() && i > 0) {
            add_exponent("CPU time", "time_exponent", growth.faces, growth.cpu, result);
            add_exponent("memory", "memory_exponent", growth.faces, growth.memory, result);
        }
        row(result);
    }
}

/// Draws what `exemplar lines` draws by default.
void draw_lines_of(const TriangleMesh& mesh) {
    const DrawableMesh drawable = drawable_mesh(mesh, "arrangement");
    DrawableSurface surface(drawable.mesh.faces, drawable.mesh.vertices);
    surface.measure(drawable.mesh.vertices);
    constexpr std::array k_types{LineType::contours, LineType::suggestive_contours, LineType::boundaries};
    draw_lines(surface.surface(), k_types, load_style("ink"), stroke_view({}, drawable.mesh, surface.feature_size()));
}

}  // namespace

void bench_scaling(BenchContext& context, const std::function<void(const BenchRow&)>& row) {
    // A model to apply: of three coarse shapes, for its size does not depend on the mesh that it labels.
    const LabeledCorpus corpus = generated_fourlegs(3, k_coarsest);
    std::vector<MeshFeatures> examples;
    for (const LabeledMesh& mesh : corpus.meshes) examples.push_back(compute_features(mesh.mesh));
    TrainOptions options;
    options.rows_per_mesh = 500;
    TrainReport unused;
    const LabelingModel model = train_labeling(corpus, examples, options, context.backend().labeling(), unused);

    Growth labeling{"labeling, features included", {}, {}, {}, {}}, cut{"alpha-expansion, 8 labels", {}, {}, {}, {}};
    TriangleMesh mesh = corpus.meshes.front().mesh;
    Progress progress("growing", k_sizes);
    for (std::size_t size = 0; size < k_sizes; ++size) {
        if (size > 0) mesh = refine(std::move(mesh), 1);
        {
            const CutProblem problem = make_cut_problem(mesh, 8);
            cut.add(mesh.face_count(), measure(context.runs(), [&] {
                        alpha_expansion(problem.unary, problem.labels, problem.edges, problem.weight,
                                        problem.compatibility);
                    }));
        }
        labeling.add(mesh.face_count(), measure(1, [&] { label_mesh(model, mesh, {}, context.backend().labeling()); }));
        progress.advance(1, fmt::format("{} faces", mesh.face_count()));
    }
    progress.finish();
    report_growth("scaling", labeling, row);
    report_growth("scaling", cut, row);
}

void bench_arrangements(BenchContext& context, const std::function<void(const BenchRow&)>& row) {
    const std::vector<std::size_t> sizes = context.quick() ? std::vector<std::size_t>{5'000, 10'000}
                                                           : std::vector<std::size_t>{5'000, 10'000, 20'000, 40'000};
    const auto add = [&](std::string_view name, const std::function<TriangleMesh(std::size_t)>& make) {
        Growth features{fmt::format("features, {}", name), {}, {}, {}, {}};
        Growth lines{fmt::format("line drawing, {}", name), {}, {}, {}, {}};
        for (const std::size_t size : sizes) {
            const TriangleMesh mesh = make(size);
            features.add(mesh.face_count(), measure(1, [&] { compute_features(mesh); }));
            lines.add(mesh.face_count(), measure(1, [&] { draw_lines_of(mesh); }));
        }
        report_growth("arrangements", features, row);
        report_growth("arrangements", lines, row);
    };
    add("an ordinary shape", [](std::size_t faces) { return make_shape("fourleg", 1, faces).mesh; });
    for (const Arrangement& arrangement : arrangements()) add(arrangement.name, arrangement.make);
}

}  // namespace exemplar
