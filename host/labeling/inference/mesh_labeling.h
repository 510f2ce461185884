#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "host/data/corpus.h"
#include "host/labeling/inference/labeler.h"
#include "host/mesh/mesh.h"
#include "host/mesh/editing/simplify.h"

namespace exemplar {

/// The most faces that features are computed on. Larger meshes are simplified to about so many: part borders are found
/// to a hundredth of the shape's size long before, and time and memory stay bounded (see simplify_mesh).
constexpr std::size_t k_most_working_faces = 40'000;

/// What is unusual about a mesh as it is labeled, vertices at the same place being one: a line each, with what is done
/// about it. Throws MeshError naming `name` if it cannot be labeled.
std::vector<std::string> labeling_warnings(const TriangleMesh& mesh, const std::string& name);

/// The mesh that features are computed on: vertices at the same place made one, as distances run along shared edges,
/// and large meshes simplified.
SimplifiedMesh working_mesh(const TriangleMesh& mesh, std::size_t most_faces = k_most_working_faces);

/// The working meshes of a corpus with their labels; of the simplified ones a face takes the label that has the most
/// area among the faces it stands for.
LabeledCorpus working_corpus(LabeledCorpus corpus, std::size_t most_faces = k_most_working_faces);

/// A mesh on its way to its labels: what its labels are computed on.
struct WorkingFeatures {
    MeshFeatures features;               ///< of the working mesh
    std::vector<std::uint32_t> face_of;  ///< for each face of the original the face of the working mesh
    std::string cache_entry;             ///< where a cache of features keeps them
    double seconds = 0;                  ///< wall time that this took
};

/// The first step of labeling a mesh of any size: the features (remembered in `cache`, see cached_features) of its
/// working mesh. Throws what compute_features throws.
WorkingFeatures working_features(const FeatureOptions& options, const TriangleMesh& mesh,
                                 const std::filesystem::path& cache, std::size_t most_faces = k_most_working_faces);
/// The second, of several meshes together: score_faces of their working meshes.
std::vector<FaceScores> score_meshes(const LabelingModel& model, std::span<WorkingFeatures* const> meshes,
                                     const LabelingBackend& backend);
/// The last: cut_faces, brought back to the original's triangles. `seconds` of the result begin with "features".
/// Threads may do this for different meshes at once.
FaceLabeling finish_labeling(const LabelingModel& model, const WorkingFeatures& mesh, FaceScores scores);

/// Labels a mesh of any size (thesis Sec. 3.2): the three steps, one after the other.
FaceLabeling label_mesh(const LabelingModel& model, const TriangleMesh& mesh, const std::filesystem::path& cache,
                        const LabelingBackend& backend, std::size_t most_faces = k_most_working_faces);

}  // namespace exemplar
