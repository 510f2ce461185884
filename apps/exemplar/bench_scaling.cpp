// The rows of `exemplar bench` that say how costs grow with the size of the mesh.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "apps/exemplar/bench_data.h"
#include "apps/exemplar/bench_rows.h"
#include "host/core/progress.h"
#include "host/labeling/labeler.h"
#include "host/labeling/training.h"
#include "host/synth/shapes.h"

namespace exemplar {
namespace {

constexpr std::size_t k_coarsest = 2000, k_sizes = 5;  // each 4 times the one before: up to 512,000 faces
constexpr double k_longest = 15 * 60;                  // CPU seconds; a size that would take longer is left out

/// Costs of one operation over the sizes.
struct Growth {
    std::string what, goal;
    std::vector<double> faces, cpu, memory;
    std::vector<Cost> costs;

    void add(std::size_t face_count, const Cost& cost) {
        faces.push_back(static_cast<double>(face_count));
        cpu.push_back(cost.cpu);
        memory.push_back(cost.own);
        costs.push_back(cost);
    }
    /// The CPU time of four times as many faces, if it goes on as it did: a loaded machine must not decide.
    double expected_next() const {
        if (cpu.size() < 2) return 0;
        return cpu.back() * std::max(4.0, cpu.back() / cpu[cpu.size() - 2]);
    }
};

/// Over all sizes, and between the last two: where several terms add up, the steepest shows there first.
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

void report(const Growth& growth, const std::function<void(const BenchRow&)>& row) {
    for (std::size_t i = 0; i < growth.costs.size(); ++i) {
        BenchRow result{.name = "scaling",
                        .what = fmt::format("{}, {:.0f} faces", growth.what, growth.faces[i]),
                        .cost = growth.costs[i]};
        if (i + 1 == growth.costs.size() && i > 0) {
            add_exponent("CPU time", "time_exponent", growth.faces, growth.cpu, result);
            add_exponent("memory", "memory_exponent", growth.faces, growth.memory, result);
        }
        row(result);
    }
}

/// How much time each family takes more when the faces are four times as many, as an exponent of the last two sizes.
std::string family_exponents(const std::vector<std::map<std::string, double>>& seconds) {
    std::string text;
    if (seconds.size() < 2) return text;
    const auto& before = seconds[seconds.size() - 2];
    for (const auto& [family, time] : seconds.back())
        text += fmt::format("{}{} {:.2f}", text.empty() ? "" : ", ", family,
                            std::log(time / before.at(family)) / std::log(4.0));
    return text;
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

    Growth features{"all features", {}, {}, {}, {}, {}}, labeling{"labeling, features at hand", {}, {}, {}, {}, {}},
        cut{"alpha-expansion, 8 labels", {}, {}, {}, {}, {}};
    std::vector<std::map<std::string, double>> families;
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
        if (features.expected_next() < k_longest) {
            MeshFeatures of_mesh;
            features.add(mesh.face_count(), measure(1, [&] { of_mesh = compute_features(mesh); }));
            families.emplace_back(of_mesh.seconds.begin(), of_mesh.seconds.end());
            label_faces(model, of_mesh, context.backend().labeling());
            drop_context_columns(of_mesh);
            labeling.add(mesh.face_count(),
                         measure(1, [&] { label_faces(model, of_mesh, context.backend().labeling()); }));
        }
        progress.advance(1, fmt::format("{} faces", mesh.face_count()));
    }
    progress.finish();
    report(features, row);
    report(labeling, row);
    report(cut, row);
    if (const std::string text = family_exponents(families); !text.empty())
        fmt::print("    feature families, exponents of wall time between the last two sizes: {}\n", text);
    if (features.costs.size() < k_sizes)
        fmt::print("    features of larger meshes would take more than {:.0f} minutes of CPU and were left out\n",
                   k_longest / 60);
}

}  // namespace exemplar
