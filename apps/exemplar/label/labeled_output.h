#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>

#include "host/labeling/inference/labeler.h"
#include "host/mesh/io/io.h"

namespace exemplar {

/// A labeling converted to the faces of the mesh file (polygons included).
struct LabeledOutput {
    FaceLabels labels;              ///< per source face
    std::vector<float> confidence;  ///< per source face: area-weighted mean over its triangles
};
LabeledOutput make_labeled_output(const TriangleMesh& mesh, const LabelingModel& model, const FaceLabeling& labeling);

/// Writes, for the mesh of a file, STEM_labels.txt, STEM.ply, STEM.seg and, with `gltf`, STEM.glb.
void write_labeled_files(const std::filesystem::path& stem, const MeshFile& file, const LabeledOutput& output,
                         bool gltf);

/// The color of each triangle's label.
std::vector<Color> triangle_colors(const LabelingModel& model, const FaceLabeling& labeling);

/// Per label that occurs: area share, number of faces, mean confidence; and the mesh's mean confidence.
nlohmann::json describe_output(const TriangleMesh& mesh, const LabelingModel& model, const FaceLabeling& labeling);

}  // namespace exemplar
