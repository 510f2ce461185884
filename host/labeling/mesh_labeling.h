#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "host/data/corpus.h"
#include "host/labeling/labeler.h"
#include "host/mesh/mesh.h"
#include "host/mesh/simplify.h"

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

/// Labels a mesh of any size (thesis Sec. 3.2): features (remembered in `cache`, see cached_features) and labels are
/// computed on the working mesh and brought back to its triangles. `seconds` of the result begin
/// with "features".
FaceLabeling label_mesh(const LabelingModel& model, const TriangleMesh& mesh, const std::filesystem::path& cache,
                        const LabelingBackend& backend, std::size_t most_faces = k_most_working_faces);

}  // namespace exemplar
