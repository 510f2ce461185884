#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "host/data/corpus.h"
#include "host/labeling/inference/labeler.h"
#include "host/mesh/editing/simplify.h"
#include "host/mesh/mesh.h"

namespace exemplar {

/// Maximum number of faces that features are computed on. Larger meshes are simplified to about this many. Far fewer
/// suffice to find part borders to a hundredth of the shape's size, and time and memory stay bounded (see
/// simplify_mesh).
constexpr std::size_t k_max_working_faces = 40'000;

/// Returns one line per defect of a mesh, after joining vertices at the same place, and what is done about it. Throws
/// MeshError naming `name` if the mesh cannot be labeled.
std::vector<std::string> labeling_warnings(const TriangleMesh& mesh, const std::string& name);

/// Returns the mesh that features are computed on: vertices at the same place are joined, as distances run along
/// shared edges, and large meshes are simplified.
SimplifiedMesh working_mesh(const TriangleMesh& mesh, std::size_t max_faces = k_max_working_faces);

/// Returns the working meshes of a corpus with their labels. A simplified face takes the label that has the most area
/// among the faces it replaces.
LabeledCorpus working_corpus(LabeledCorpus corpus, std::size_t max_faces = k_max_working_faces);

/// Features of a mesh's working mesh, from which its labels are computed.
struct WorkingFeatures {
    MeshFeatures features;               ///< of the working mesh
    std::vector<std::uint32_t> face_of;  ///< per original face: the face of the working mesh
    std::string cache_entry;             ///< file name of the features in the cache
    double seconds = 0;                  ///< wall time to compute all of this
};

/// Step 1 of labeling a mesh of any size: returns the features of its working mesh, cached in `cache` (see
/// cached_features). Throws what compute_features throws.
WorkingFeatures working_features(const FeatureOptions& options, const TriangleMesh& mesh,
                                 const std::filesystem::path& cache, std::size_t max_faces = k_max_working_faces);
/// Step 2 is score_faces of the working meshes' features. Step 3: cut_faces, mapped back to the original's triangles.
/// `seconds` of the result begin with "features". Threads may do this for different meshes at once.
FaceLabeling finish_labeling(const LabelingModel& model, const WorkingFeatures& mesh, FaceScores scores);

/// Labels a mesh of any size (thesis Sec. 3.2): the three steps, one after the other.
FaceLabeling label_mesh(const LabelingModel& model, const TriangleMesh& mesh, const std::filesystem::path& cache,
                        const LabelingBackend& backend, std::size_t max_faces = k_max_working_faces);

}  // namespace exemplar
