// Labeling: models from labeled meshes, and labels for others.

#include <fmt/format.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <algorithm>
#include <limits>
#include <map>
#include <set>

#include "gpu/labeling/labeling_device.h"
#include "host/core/interrupt.h"
#include "host/core/progress.h"
#include "host/core/text.h"
#include "host/labeling/features/feature_cache.h"
#include "host/labeling/inference/mesh_labeling.h"
#include "host/labeling/training/training.h"
#include "host/mesh/editing/validate.h"
#include "python/arrays.h"
#include "python/bindings.h"
#include "python/long_work.h"
#include "python/mesh_object.h"

namespace exemplar::python {
namespace {

namespace fs = std::filesystem;

using ModelPointer = std::shared_ptr<LabelingModel>;

/// A labeled mesh: its labels, their probabilities and their names.
struct LabelingObject {
    FaceLabeling labeling;
    std::vector<std::string> names;
    std::string mesh;
};
using LabelingPointer = std::shared_ptr<LabelingObject>;

/// The names of all labels that faces have, sorted.
std::vector<std::string> used_names(const std::vector<MeshPointer>& meshes) {
    std::set<std::string> used;
    for (const MeshPointer& mesh : meshes)
        for (const std::int32_t label : mesh->labels->label)
            if (label >= 0) used.insert(mesh->labels->names[label]);
    return {used.begin(), used.end()};
}

/// The labels of a mesh as numbers of `names`.
std::vector<std::int32_t> labels_in(const FaceLabels& labels, const std::vector<std::string>& names) {
    std::vector<std::int32_t> index;
    for (const std::string& name : labels.names)
        index.push_back(static_cast<std::int32_t>(std::ranges::find(names, name) - names.begin()));
    std::vector<std::int32_t> result;
    for (const std::int32_t label : labels.label) result.push_back(label < 0 ? -1 : index[label]);
    return result;
}

void require_labels(const std::vector<MeshPointer>& meshes) {
    for (std::size_t i = 0; i < meshes.size(); ++i)
        if (!meshes[i]->labels)
            throw UsageError(fmt::format("meshes: number {} ('{}') has no labels; give it some by with_labels()", i,
                                         meshes[i]->name));
}

/// Labels of equal names are one label, whichever meshes they come from.
LabeledCorpus corpus_of(const std::vector<MeshPointer>& meshes) {
    LabeledCorpus corpus;
    corpus.names = used_names(meshes);
    for (const MeshPointer& mesh : meshes) {
        require_usable(*mesh->mesh, mesh->name);
        corpus.meshes.push_back(
            {fs::path(mesh->name).stem().string(), mesh->name, *mesh->mesh, labels_in(*mesh->labels, corpus.names)});
    }
    return working_corpus(std::move(corpus));
}

LabelingModel train_labeling(const std::vector<MeshPointer>& meshes, const TrainOptions& options, const fs::path& cache,
                             const std::string& device) {
    LabelingDevice backend({.name = device});
    const LabeledCorpus corpus = corpus_of(meshes);
    std::vector<MeshFeatures> features;
    Progress progress("computing features", corpus.meshes.size());
    for (const LabeledMesh& mesh : corpus.meshes) {
        check_interrupt();
        features.push_back(cached_features(mesh.mesh, options.features, cache));
        progress.advance(1, mesh.name);
    }
    TrainReport report;
    return train_labeling(corpus, features, options, backend.labeling(), report);
}

// One parameter for each keyword of the Python function. NOLINTNEXTLINE(readability-function-size)
ModelPointer train_model(const std::vector<MeshPointer>& meshes, std::uint64_t seed, std::int64_t rounds,
                         std::int64_t patience, std::int64_t stages, std::int64_t bins, std::int64_t rows,
                         double feature_fraction, double shrinkage, bool linear, bool boundary, std::int64_t samples,
                         const std::string& orientation, const fs::path& cache, const std::string& device) {
    constexpr std::int64_t k_any = std::numeric_limits<std::int64_t>::max();
    require_range("rounds", rounds, std::int64_t{1}, std::int64_t{100'000});
    require_range("patience", patience, std::int64_t{1}, k_any);
    require_range("stages", stages, std::int64_t{1}, std::int64_t{64});
    require_range("bins", bins, std::int64_t{2}, std::int64_t{256});
    require_range("rows", rows, std::int64_t{0}, k_any);
    require_range("feature_fraction", feature_fraction, 0.001, 1);
    require_range("shrinkage", shrinkage, 0.01, 1);
    require_range("samples", samples, std::int64_t{1}, static_cast<std::int64_t>(k_max_samples));
    require_labels(meshes);
    const TrainOptions options{.seed = seed,
                               .rounds = static_cast<std::size_t>(rounds),
                               .patience = static_cast<std::size_t>(patience),
                               .max_stages = static_cast<std::size_t>(stages),
                               .bins = static_cast<std::size_t>(bins),
                               .rows_per_mesh = static_cast<std::size_t>(rows),
                               .feature_fraction = feature_fraction,
                               .shrinkage = shrinkage,
                               .linear = linear,
                               .boundary = boundary,
                               .orientation = orientation_use(orientation),
                               .features = {static_cast<std::size_t>(samples)}};
    return std::make_shared<LabelingModel>(long_result([&] { return train_labeling(meshes, options, cache, device); }));
}

LabelingPointer label(const LabelingModel& model, const MeshObject& mesh, bool keep_small, const fs::path& cache,
                      const std::string& device) {
    auto result = std::make_shared<LabelingObject>();
    result->names = model.label_names;
    result->mesh = mesh.name;
    run_long([&] {
        named(mesh, [&] {
            require_usable(*mesh.mesh, mesh.name);
            LabelingModel used = model;
            if (keep_small) used.crf.merge_fraction = 0;
            LabelingDevice backend({.name = device});
            result->labeling = label_mesh(used, *mesh.mesh, cache, backend.labeling());
        });
    });
    return result;
}

void add_labels(py::module_& module) {
    py::class_<LabelingObject, LabelingPointer>(module, "Labeling", "What a model says about the faces of a mesh.")
        .def_property_readonly(
            "labels", [](const LabelingPointer& self) { return list_view(self, self->labeling.label); },
            "The label of each face (m int32): its place in label_names.")
        .def_property_readonly(
            "confidence", [](const LabelingPointer& self) { return list_view(self, self->labeling.confidence); },
            "The probability of that label (m float32, from 0 to 1).")
        .def_property_readonly(
            "probabilities",
            [](const LabelingPointer& self) {
                const auto columns = static_cast<py::ssize_t>(self->names.size());
                const std::vector<float>& values = self->labeling.probabilities;
                return view(self, values.data(), {static_cast<py::ssize_t>(values.size()) / columns, columns});
            },
            "The probability of every label at each face (m x labels float32), before borders were smoothed: the "
            "label\n"
            "of a face may not be the one of its largest probability.")
        .def_readonly("label_names", &LabelingObject::names, "The names of the labels, in the order of their numbers.")
        .def_property_readonly(
            "seconds",
            [](const LabelingPointer& self) {
                return std::map<std::string, double>(self->labeling.seconds.begin(), self->labeling.seconds.end());
            },
            "How long each step took.")
        .def("__repr__", [](const LabelingPointer& self) {
            return fmt::format("<exemplar.Labeling of '{}': {}, {}>", self->mesh,
                               counted(self->labeling.label.size(), "face"), counted(self->names.size(), "label"));
        });
}

void add_labeling_model(py::module_& module) {
    py::class_<LabelingModel, ModelPointer>(module, "LabelingModel",
                                            "A model that labels the parts of meshes: see train_labeling().")
        .def_static(
            "load",
            [](const fs::path& path) {
                return std::make_shared<LabelingModel>(long_result([&] { return load_model(path); }));
            },
            py::arg("path"),
            "Reads a model file, and checks it completely. Raises ModelError if it is damaged, newer, or of another "
            "kind.")
        .def(
            "save", [](const LabelingModel& self, const fs::path& path) { run_long([&] { save_model(path, self); }); },
            py::arg("path"),
            "Writes the model as a .safetensors file, which the programs read, too. Equal models give equal bytes.")
        .def("label", &label, py::arg("mesh"), py::kw_only(), py::arg("keep_small") = false, py::arg("cache") = "",
             py::arg("device") = "",
             "Labels a mesh of any size. `keep_small`: leaves pieces that are much smaller than any in training as "
             "they\n"
             "are, instead of merging them. `cache`: a folder that remembers features, see features(). `device`: the "
             "index\n"
             "or a part of the name of a Vulkan device, see devices(); empty: the best. Raises MeshError for a mesh "
             "that is\n"
             "empty or not finite, DeviceError where there is no device.")
        .def_readonly("label_names", &LabelingModel::label_names, "The names of the labels.")
        .def_readonly("feature_names", &LabelingModel::unary_names, "The features of faces that it takes.")
        .def_readonly("provenance", &LabelingModel::provenance, "A line for each mesh that it learned from.")
        .def_readonly("seed", &LabelingModel::seed, "The seed of its training.")
        .def("__repr__", [](const LabelingModel& self) {
            return fmt::format("<exemplar.LabelingModel of {}>", counted(self.label_names.size(), "label"));
        });
}

}  // namespace

void add_labeling(py::module_& module) {
    add_labels(module);
    add_labeling_model(module);
    constexpr TrainOptions k_usual;
    module.def(
        "train_labeling", &train_model, py::arg("meshes"), py::kw_only(), py::arg("seed") = k_usual.seed,
        py::arg("rounds") = k_usual.rounds, py::arg("patience") = k_usual.patience,
        py::arg("stages") = k_usual.max_stages, py::arg("bins") = k_usual.bins, py::arg("rows") = k_usual.rows_per_mesh,
        py::arg("feature_fraction") = k_usual.feature_fraction, py::arg("shrinkage") = k_usual.shrinkage,
        py::arg("linear") = k_usual.linear, py::arg("boundary") = k_usual.boundary,
        py::arg("samples") = k_usual.features.samples, py::arg("orientation") = "auto", py::arg("cache") = "",
        py::arg("device") = "",
        "Learns to label from labeled meshes (see Mesh.with_labels() and read_labeled()): labels of equal names are\n"
        "one label, and faces with -1 teach nothing. The options are those of `exemplar label train`: `rounds` of\n"
        "boosting for each classifier (1 to 100,000), `patience` (rounds without gain that end boundary classifiers),\n"
        "`stages` of the cascade at most (1 to 64), histogram `bins` (2 to 256), `rows` (faces of each mesh to boost\n"
        "on; 0: all), `feature_fraction` (share of the features that a round looks at, 0.001 to 1), `shrinkage` of "
        "each\n"
        "response (0.01 to 1), `linear` (whether stumps are pooled with a linear classifier where that is better on\n"
        "held-out meshes), `boundary` (whether it learns where parts end), `samples` as in features(), `orientation` "
        "(\"yes\", \"no\", or \"auto\": whether faces are\n"
        "also known by where they are; auto if held-out meshes tell that all lie alike). Equal meshes and seeds give\n"
        "equal models.\n"
        "`cache` and `device` as in LabelingModel.label(). Raises UsageError if a mesh has no labels, DataError if\n"
        "nothing is labeled, MeshError for a mesh that cannot be used.");
}

}  // namespace exemplar::python
