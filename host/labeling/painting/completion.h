#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "host/labeling/painting/completion_descriptors.h"
#include "host/mesh/mesh.h"
#include "host/mesh/queries/geodesics.h"

namespace exemplar {

/// A labeling of a whole mesh, completed from a few painted faces.
struct CompletedLabels {
    std::vector<std::int32_t> label;  ///< per face; -1 everywhere if nothing is painted and nothing suggested
    std::vector<float> confidence;    ///< per face, in [0, 1]: probability of its label; 1 where it is painted
};

/// The output of a trained model for a mesh, from which completion starts.
struct LabelEvidence {
    std::vector<float> probabilities;                 ///< faces x labels of the palette; empty: there is no model
    std::vector<std::array<std::uint32_t, 2>> edges;  ///< interior edges: the two faces
    std::vector<double> edge_cost;      ///< of a border along each edge (Eq. 3.3), where faces cost their area share
    std::vector<double> compatibility;  ///< labels x labels, symmetric, zero diagonal (Eq. 3.3)

    /// Returns the number of labels that the evidence is about; the palette may have grown since.
    std::size_t labels(std::size_t faces) const { return faces == 0 ? 0 : probabilities.size() / faces; }
};

/// Parameters of completion; docs/labeling.md says how they were chosen.
struct CompletionOptions {
    float likeness = 8;               ///< weight of the squared distance of descriptors
    float nearness = 3;               ///< weight of nearness
    float reach = 0.25F;              ///< of the nearness, in square roots of the surface's area
    float concave_length = 4;         ///< an edge bent inward by 180 degrees is longer by this factor
    double lambda = 0.15, mu = 0.05;  ///< of the cut: weights of the dihedral term (Eq. 3.4) and of length
    float outlier = 0.02F;            ///< probability that is shared by all labels
    // The following count only if a model suggests labels.
    float trust = 0.8F;              ///< weight of its log probabilities, once there are strokes
    float correction = 10;           ///< what a stroke adds to the score of its label
    float correction_likeness = 12;  ///< as `likeness`, for what a stroke adds
    float elsewhere = 0.3F;          ///< share of what a stroke adds that counts far from it, too
};

/// Completes painted labels to the whole mesh: a face takes the label of painted faces that are alike (descriptors)
/// and near (geodesic distance, longer across concave edges), then a minimum cut (alpha-expansion) moves borders to
/// short, concave edges.
class LabelCompletion {
  public:
    /// Without features, nearness alone counts.
    explicit LabelCompletion(const TriangleMesh& mesh, const CompletionOptions& options = {});
    /// Adds the descriptors of the same faces, when they are computed.
    void set_descriptors(FaceDescriptors descriptors) { descriptors_ = std::move(descriptors); }
    /// Sets what a model says about the mesh; strokes then correct it where the surface is like theirs.
    void set_evidence(LabelEvidence evidence) { evidence_ = std::move(evidence); }

    /// Completes `painted`: per face a label below `labels`, or -1. Labels that occur neither in it nor in the
    /// suggestion are not used.
    CompletedLabels complete(std::span<const std::int32_t> painted, std::size_t labels) const;

    std::size_t face_count() const { return area_.size(); }
    const DualGraph& graph() const { return graph_; }
    std::span<const float> area() const { return area_; }

  private:
    /// How far the faces are from the strokes of each label.
    struct StrokeDistances {
        std::vector<std::vector<float>> distance;  ///< along the surface, per label and face; empty without strokes
        std::vector<float> unlike;                 ///< squared, of descriptors, per face and label; may be empty
    };
    StrokeDistances stroke_distances(std::span<const std::int32_t> painted, std::size_t labels) const;
    float score(const StrokeDistances& strokes, std::size_t face, std::size_t label) const;
    std::vector<float> likeness(std::span<const std::int32_t> painted, std::size_t labels) const;
    std::vector<float> distances(std::span<const std::int32_t> painted, std::int32_t label) const;
    std::vector<float> probabilities(std::span<const std::int32_t> painted, std::size_t labels) const;
    std::vector<std::int32_t> cut(std::span<const std::int32_t> painted, std::span<const float> probability,
                                  std::size_t labels) const;

    CompletionOptions options_;
    std::vector<float> area_;  ///< per face, share of the surface
    DualGraph graph_;          ///< lengths grow where the surface is concave, in square roots of the area
    std::vector<std::array<std::uint32_t, 2>> edges_;
    std::vector<double> edge_cost_;  ///< of a border along each edge, without a model
    FaceDescriptors descriptors_;
    LabelEvidence evidence_;
};

}  // namespace exemplar
