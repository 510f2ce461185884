#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "host/labeling/evaluation/segmentation_metrics.h"
#include "host/mesh/mesh.h"

namespace exemplar {

/// The meshes of a category that are used for training and for testing.
struct Split {
    std::vector<std::size_t> train, test;
};

/// Splits `count` meshes `splits` times: train_count of them, drawn at random (by seed and split number), for
/// training, the others for testing. With train_count = count - 1 (leave one out), split k tests mesh k. Throws
/// UsageError if none is left for training or testing.
std::vector<Split> make_splits(std::size_t count, std::size_t train_count, std::size_t splits, std::uint64_t seed);

/// How well one mesh was labeled. The rates are NaN if no face has a true label.
struct MeshScore {
    double recognition_rate = 0;           ///< share of the area labeled right (one minus Eq. 3.8), in [0, 1]
    double segment_weighted_accuracy = 0;  ///< one minus Eq. 3.9, mean over the labels present
    std::vector<double> confusion;         ///< classes x classes, row = truth, share of the mesh's area
};

/// Compares predicted with true labels, weighted by face area; faces whose truth is -1 are ignored.
MeshScore score_labeling(std::span<const float> face_area, std::span<const std::int32_t> truth,
                         std::span<const std::int32_t> predicted, std::size_t classes);

/// Returns the labels that the classifiers alone give, from their probabilities (faces x classes).
std::vector<std::int32_t> most_probable_labels(std::span<const float> probabilities, std::size_t classes);

/// Returns the entropy of each face's probabilities (faces x classes) divided by log C: 0 for one sure label, 1 if all
/// are equal (thesis Fig. 3.2c).
std::vector<float> relative_entropy(std::span<const float> probabilities, std::size_t classes);

/// Compares a labeling, as a segmentation into connected components of equal label, with each of the human
/// segmentations (one segment per triangle; thesis Sec. 3.4). All NaN without human segmentations.
SegmentationErrors score_segmentation(const TriangleMesh& mesh, std::span<const std::int32_t> predicted,
                                      std::span<const std::vector<std::int32_t>> human_segmentations);

/// Returns the files with the human segmentations of a mesh in the benchmark's layout, FOLDER/NAME/*.seg, in name
/// order; empty if there are none.
std::vector<std::filesystem::path> human_segmentation_files(const std::filesystem::path& folder,
                                                            const std::string& name);

/// Reads these files: for each segmentation the segment of each face.
std::vector<std::vector<std::int32_t>> read_human_segmentations(const std::filesystem::path& folder,
                                                                const std::string& name, std::size_t faces);

}  // namespace exemplar
