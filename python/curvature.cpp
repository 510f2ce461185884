// Curvature: measured on a mesh, and learned from an animation.

#include "host/mesh/curvature/curvature.h"

#include <fmt/format.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <algorithm>
#include <array>
#include <optional>

#include "host/core/text.h"
#include "host/curvature/learning/training.h"
#include "host/curvature/model/evaluation.h"
#include "host/mesh/curvature/curvature_estimator.h"
#include "host/mesh/editing/validate.h"
#include "python/animation_object.h"
#include "python/arrays.h"
#include "python/bindings.h"
#include "python/curvature_object.h"
#include "python/long_work.h"
#include "python/mesh_object.h"

namespace exemplar::python {
namespace {

namespace fs = std::filesystem;

using CurvatureModelPointer = std::shared_ptr<CurvatureModel>;

/// Returns the index of a word in a list; throws UsageError with the nearest word if it is not there.
std::size_t place_of(const std::string& word, const std::string& argument, const std::vector<std::string>& words) {
    const auto at = std::ranges::find(words, word);
    if (at == words.end())
        throw UsageError(fmt::format("{}: '{}' is not known{}; give one of {}", argument, word, suggestion(word, words),
                                     fmt::join(words, ", ")));
    return static_cast<std::size_t>(at - words.begin());
}

RobustEstimator robust_of(const std::string& word) {
    constexpr std::array k_estimators{RobustEstimator::none, RobustEstimator::cauchy, RobustEstimator::geman_mcclure};
    return k_estimators.at(place_of(word, "robust", {"none", "cauchy", "geman-mcclure"}));
}

Learner learner_of(const std::string& word) {
    constexpr std::array k_learners{Learner::local, Learner::additive, Learner::averaged, Learner::network,
                                    Learner::global};
    std::vector<std::string> names;
    names.reserve(k_learners.size());
    for (const Learner learner : k_learners) names.emplace_back(name_of(learner));
    return k_learners.at(place_of(word, "learner", names));
}

CurvaturePointer measured(const MeshObject& mesh, bool derivatives, double smoothing, const std::string& robust) {
    require_range("smoothing", smoothing, 0, 100);
    const CurvatureOptions options{.derivatives = derivatives, .smoothing = smoothing, .robust = robust_of(robust)};
    return std::make_shared<VertexCurvature>(long_result([&] {
        require_drawable(*mesh.mesh, mesh.name);
        CurvatureEstimator estimator(mesh.mesh->faces, mesh.mesh->vertex_count());
        CurvatureOptions possible = options;
        // A mesh whose vertices are all at one point has no length scale for smoothing.
        if (!(estimator.median_edge_length(mesh.mesh->vertices) > 0)) possible.smoothing = 0;
        return estimator.estimate(mesh.mesh->vertices, possible);
    }));
}

/// The frames to learn from; none: all.
std::vector<FrameRef> chosen_frames(const AnimationObject& animation,
                                    const std::optional<std::vector<std::int64_t>>& chosen) {
    if (!chosen) return animation.frames;
    std::vector<FrameRef> frames;
    for (const std::int64_t frame : *chosen) frames.push_back(frame_of(animation, frame));
    return frames;
}

CurvatureModelPointer train_curvature(const AnimationObject& animation,
                                      const std::optional<std::vector<std::int64_t>>& chosen, std::uint64_t seed,
                                      double smoothing, const std::string& robust, const std::string& learner,
                                      double variance) {
    require_range("smoothing", smoothing, 0, 20);
    require_range("variance", variance, 0.01, 1);
    CurvatureTraining training;
    training.seed = training.sequence.seed = seed;
    training.truth.smoothing = smoothing;
    training.truth.robust = robust_of(robust);
    training.learner = learner_of(learner);
    training.variance = variance;
    // Cloth keeps all components, as on the command line: small ones in training may be large in other folds.
    if (animation.animation.kind == AnimationKind::sequence) training.dropped_variance = 0;
    const std::vector<FrameRef> frames = chosen_frames(animation, chosen);
    return std::make_shared<CurvatureModel>(long_result([&] {
        CurvatureTrainingReport report;
        CurvatureModel model = train_curvature(animation.animation, frames, training, report);
        model.training = {{"animation", animation.animation.name},
                          {"poses", std::to_string(frames.size())},
                          {"learner", std::string(name_of(training.learner))},
                          {"seed", std::to_string(seed)}};
        return model;
    }));
}

CurvaturePointer predicted(const CurvatureModel& model, const AnimationObject& object, std::int64_t frame) {
    const FrameRef ref = frame_of(object, frame);
    return std::make_shared<VertexCurvature>(long_result([&] {
        const Animation& animation = object.animation;
        require_compatible(model, animation);
        TriangleMesh posed = animation.rest;
        posed.vertices = frame_vertices(animation, animation.clips[ref.clip], ref.frame);
        const std::vector<Vec3> normals = vertex_normals(posed);
        CurvatureEvaluator evaluator(model);
        return evaluator.evaluate(animation.rig, shape_at(animation, ref.clip, ref.frame), posed.vertices, normals);
    }));
}

/// Measures curvature as for the model's training.
CurvaturePointer measured_as_truth(const CurvatureModel& model, const AnimationObject& object, std::int64_t frame) {
    const FrameRef ref = frame_of(object, frame);
    return std::make_shared<VertexCurvature>(long_result([&] {
        require_compatible(model, object.animation);
        return SnapshotReader(object.animation, model.segments, model.truth).read(ref).curvature;
    }));
}

void add_values(py::module_& module) {
    py::class_<VertexCurvature, CurvaturePointer>(
        module, "Curvature",
        "Curvature at each of n vertices, in one over the units of the mesh: positive where the surface is convex.")
        .def_property_readonly(
            "k1", [](const CurvaturePointer& self) { return list_view(self, self->k1); },
            "The larger principal curvature (n float32).")
        .def_property_readonly(
            "k2", [](const CurvaturePointer& self) { return list_view(self, self->k2); },
            "The smaller principal curvature (n float32).")
        .def_property_readonly(
            "e1", [](const CurvaturePointer& self) { return list_view(self, self->e1); },
            "The unit direction of k1 (n x 3 float32); its sign means nothing.")
        .def_property_readonly(
            "e2", [](const CurvaturePointer& self) { return list_view(self, self->e2); },
            "The unit direction of k2 (n x 3 float32); e1 x e2 is the normal.")
        .def_property_readonly(
            "derivative",
            [](const CurvaturePointer& self) -> py::object {
                if (self->derivative.empty()) return py::none();
                return list_view(self, self->derivative);
            },
            "How curvature changes along the surface (n x 4 float32, in one over squared units): dk1/de1, dk1/de2,\n"
            "dk2/de1 and dk2/de2. None if it was not asked for.")
        .def("__repr__", [](const CurvaturePointer& self) {
            return fmt::format("<exemplar.Curvature of {}>", counted(self->k1.size(), "vertex", "vertices"));
        });
}

void add_curvature_model(py::module_& module) {
    py::class_<CurvatureModel, CurvatureModelPointer>(
        module, "CurvatureModel", "Predicts the curvature of one animated surface in any pose: see train_curvature().")
        .def_static(
            "load",
            [](const fs::path& path) {
                return std::make_shared<CurvatureModel>(long_result([&] { return load_curvature_model(path); }));
            },
            py::arg("path"), "Reads a model file, and checks it completely. Raises ModelError.")
        .def(
            "save",
            [](const CurvatureModel& self, const fs::path& path) {
                run_long([&] { save_curvature_model(path, self); });
            },
            py::arg("path"), "Writes the model as a .safetensors file, which the programs read, too.")
        .def("predict", &predicted, py::arg("animation"), py::arg("frame"),
             "The learned curvature in a frame of an animation of the same surface, which may be one that it never "
             "saw.\n"
             "Raises ModelError if the surface is another one, UsageError if there is no such frame.")
        .def("measure", &measured_as_truth, py::arg("animation"), py::arg("frame"),
             "The measured curvature in a frame, measured as that which the model learned from: what to compare\n"
             "predict() with. Raises as predict().")
        .def_readonly("vertex_count", &CurvatureModel::vertex_count, "How many vertices the surface has.")
        .def_readonly("feature_size", &CurvatureModel::feature_size, "Of the surface in training, see draw_lines().")
        .def_readonly("training", &CurvatureModel::training, "What it was trained on, in words.")
        .def("__repr__", [](const CurvatureModel& self) {
            return fmt::format("<exemplar.CurvatureModel of {}>", counted(self.vertex_count, "vertex", "vertices"));
        });
}

}  // namespace

void add_curvature(py::module_& module) {
    add_values(module);
    add_curvature_model(module);
    module.def(
        "curvature", &measured, py::arg("mesh"), py::kw_only(), py::arg("derivatives") = true,
        py::arg("smoothing") = 0.0, py::arg("robust") = "none",
        "Measures the curvature of a mesh at its vertices. Vertices at the same place are not joined: along seams the\n"
        "surface ends. `smoothing`: width, in median edge lengths, of a Gaussian over the surface (0 to 100).\n"
        "`robust`: \"none\", or \"cauchy\" or \"geman-mcclure\" for noisy meshes. Raises MeshError for a mesh that is\n"
        "empty or not finite.");
    constexpr CurvatureTraining k_usual;
    module.def(
        "train_curvature", &train_curvature, py::arg("animation"), py::kw_only(), py::arg("frames") = py::none(),
        py::arg("seed") = k_usual.seed, py::arg("smoothing") = k_usual.truth.smoothing, py::arg("robust") = "none",
        py::arg("learner") = std::string(name_of(k_usual.learner)), py::arg("variance") = k_usual.variance,
        "Learns how the curvature of a surface follows from its pose. `frames`: numbers of the frames to learn from\n"
        "(20 at least; None: all). `smoothing` of the measured curvature, in median edge lengths (0 to 20). `robust` "
        "as\n"
        "in curvature(). `learner`: \"local\", or \"additive\", \"averaged\", \"network\" or \"global\" as the command "
        "line\n"
        "has them. `variance`: share of what varies that is kept (0.01 to 1). Equal seeds give equal models. Raises\n"
        "UsageError for too few frames or if nothing moves.");
}

}  // namespace exemplar::python
