// Features of faces and edges, as arrays.

#include "host/labeling/features/features.h"

#include <fmt/format.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <algorithm>
#include <map>
#include <numeric>

#include "host/labeling/inference/mesh_labeling.h"
#include "host/mesh/editing/validate.h"
#include "python/arrays.h"
#include "python/bindings.h"
#include "python/long_work.h"
#include "python/mesh_object.h"

namespace exemplar::python {
namespace {

struct FeaturesObject {
    WorkingFeatures working;
    std::string mesh;        ///< its name
    FeatureMatrix per_face;  ///< of a simplified mesh: the rows of all original faces, made at first use

    const MeshFeatures& features() const { return working.features; }
    bool simplified() const { return features().unary.rows != working.face_of.size(); }
    /// Features of edges belong to the working mesh alone.
    void require_edges() const {
        if (simplified())
            throw UsageError(fmt::format("{}: has {} faces; features of edges take {} at most: simplify it first", mesh,
                                         working.face_of.size(), k_max_working_faces));
    }
};
using FeaturesPointer = std::shared_ptr<FeaturesObject>;

/// Returns a view of faces x features; its columns are contiguous in memory.
py::array matrix_view(const std::shared_ptr<const void>& owner, const FeatureMatrix& matrix) {
    const auto rows = static_cast<py::ssize_t>(matrix.rows), columns = static_cast<py::ssize_t>(matrix.cols());
    return view(owner, matrix.values.data(), {rows, columns},
                {static_cast<py::ssize_t>(sizeof(float)), rows * static_cast<py::ssize_t>(sizeof(float))});
}

/// Returns a row for each original face: that of its simplified face.
FeatureMatrix gathered(const FeatureMatrix& matrix, const std::vector<std::uint32_t>& face_of) {
    FeatureMatrix result{face_of.size(), matrix.names, {}};
    result.values.reserve(matrix.cols() * face_of.size());
    for (std::size_t feature = 0; feature < matrix.cols(); ++feature) {
        const std::span<const float> column = matrix.column(feature);
        for (const std::uint32_t face : face_of) result.values.push_back(column[face]);
    }
    return result;
}

py::array face_values(const FeaturesPointer& self) {
    if (!self->simplified()) return matrix_view(self, self->features().unary);
    if (self->per_face.rows == 0) self->per_face = gathered(self->features().unary, self->working.face_of);
    return matrix_view(self, self->per_face);
}

FeaturesPointer features(const MeshObject& mesh, std::int64_t samples, bool orientation,
                         const std::filesystem::path& cache) {
    require_range("samples", samples, std::int64_t{1}, static_cast<std::int64_t>(k_max_samples));
    const FeatureOptions options{static_cast<std::size_t>(samples), orientation};
    auto result = std::make_shared<FeaturesObject>();
    result->mesh = mesh.name;
    run_long([&] {
        named(mesh, [&] {
            require_usable(*mesh.mesh, mesh.name);
            result->working = working_features(options, *mesh.mesh, cache);
        });
    });
    return result;
}

/// A property that is of edges.
template <typename Get>
auto of_edges(Get get) {
    return [get](const FeaturesPointer& self) {
        self->require_edges();
        return get(self);
    };
}

using FeaturesClass = py::class_<FeaturesObject, FeaturesPointer>;

void add_edges(FeaturesClass& features) {
    features
        .def_property_readonly(
            "edges", of_edges([](const FeaturesPointer& self) { return list_view(self, self->features().edges); }),
            "The two faces at each interior edge (e x 2 uint32), in the order of `pairwise`.")
        .def_property_readonly(
            "pairwise",
            of_edges([](const FeaturesPointer& self) { return matrix_view(self, self->features().pairwise); }),
            "Features of the interior edges (e x d float32). Raises UsageError for a mesh that was simplified.")
        .def_property_readonly(
            "pairwise_names", [](const FeaturesPointer& self) { return self->features().pairwise.names; },
            "The names of the columns of `pairwise`.")
        .def_property_readonly("edge_length", of_edges([](const FeaturesPointer& self) {
                                   return list_view(self, self->features().edge_length);
                               }),
                               "Lengths of the interior edges (e float32), in units of their median.")
        .def_property_readonly(
            "dihedral",
            of_edges([](const FeaturesPointer& self) { return list_view(self, self->features().dihedral); }),
            "The angle outside of the surface at each interior edge over pi, at most 1 (e float32): less is hollow.");
}

}  // namespace

void add_features(py::module_& module) {
    FeaturesClass features_class(module, "Features",
                                 "What labeling knows of a mesh: features of its faces and interior edges.");
    features_class
        .def_property_readonly(
            "values", &face_values,
            "Features of the faces (m x d float32, every value finite): a read-only view whose columns are contiguous.")
        .def_property_readonly(
            "names", [](const FeaturesPointer& self) { return self->features().unary.names; },
            "The names of the columns of `values`, as \"curvature.k1@0.05\": the family comes first.")
        .def_property_readonly(
            "face_of", [](const FeaturesPointer& self) { return list_view(self, self->working.face_of); },
            "Meshes of more than 40,000 faces are simplified: the face of the simplified mesh that stands for each "
            "face\n"
            "(m uint32), whose features it has. Of smaller meshes each face stands for itself.")
        .def_property_readonly(
            "seconds",
            [](const FeaturesPointer& self) {
                return std::map<std::string, double>(self->features().seconds.begin(), self->features().seconds.end());
            },
            "How long each family of features took to compute, when that was.")
        .def("__repr__", [](const FeaturesPointer& self) {
            return fmt::format("<exemplar.Features of '{}': {} faces x {} features>", self->mesh,
                               self->working.face_of.size(), self->features().unary.cols());
        });
    add_edges(features_class);
    module.def(
        "features", &features, py::arg("mesh"), py::kw_only(), py::arg("samples") = FeatureOptions{}.samples,
        py::arg("orientation") = false, py::arg("cache") = "",
        "Computes the features of a mesh, on all cores. They do not change when the mesh is moved, turned or\n"
        "scaled. `samples`: how many faces stand for the surface in statistics of distances (1 to 1,000,000).\n"
        "`orientation`: adds coordinates, for shapes that share an orientation. `cache`: a folder that remembers\n"
        "features (see feature_folder()); empty: nothing is remembered. Raises MeshError for a mesh that is empty\n"
        "or not finite; all else is worked around.");
}

}  // namespace exemplar::python
