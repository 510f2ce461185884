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
constexpr double k_longest = 15 * 60;                  // seconds; a size that would take longer is left out

/// Costs of one operation over the sizes.
struct Growth {
    std::string what, goal;
    std::vector<double> faces, cpu, peak;
    std::vector<Cost> costs;

    void add(std::size_t face_count, const Cost& cost) {
        faces.push_back(static_cast<double>(face_count));
        cpu.push_back(cost.cpu);
        peak.push_back(cost.peak);
        costs.push_back(cost);
    }
    /// The wall time of four times as many faces, if it goes on as it did.
    double expected_next() const {
        if (costs.size() < 2) return 0;
        const double last = costs.back().wall;
        return last * std::max(4.0, last / costs[costs.size() - 2].wall);
    }
};

void report(const Growth& growth, const std::function<void(const BenchRow&)>& row) {
    for (std::size_t i = 0; i < growth.costs.size(); ++i) {
        BenchRow result{.name = "scaling",
                        .what = fmt::format("{}, {:.0f} faces", growth.what, growth.faces[i]),
                        .cost = growth.costs[i]};
        if (i + 1 == growth.costs.size() && i > 0) {
            const double time = fitted_exponent(growth.faces, growth.cpu);
            result.goal = "nothing quadratic: exponents well below 2";
            result.others = "the authors' program: exponent 1.85";
            result.remarks.push_back(fmt::format("CPU time grows with faces to the power of {:.2f}", time));
            result.numbers["time_exponent"] = time;
            if (!std::isnan(growth.peak[i])) {
                const double memory = fitted_exponent(growth.faces, growth.peak);
                result.remarks.push_back(fmt::format("memory grows with faces to the power of {:.2f}", memory));
                result.numbers["memory_exponent"] = memory;
            }
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
        fmt::print("    feature families, exponents between the last two sizes: {}\n", text);
    if (features.costs.size() < k_sizes)
        fmt::print("    features of larger meshes would take more than {:.0f} minutes and were left out\n",
                   k_longest / 60);
}

}  // namespace exemplar
