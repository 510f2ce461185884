#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "host/learn/feature_matrix.h"

namespace exemplar {

constexpr std::size_t k_max_classes = 64;

/// A decision stump shared by a set of classes (thesis Eq. 2.64): classes in `classes` (bit c, the set C_S) get `above`
/// (a) where feature > threshold (tau), else `below` (b). Other classes get a constant k_c, kept in
/// BoostedStumps::elsewhere.
struct Stump {
    std::uint32_t feature;
    float threshold;
    float above;
    float below;
    std::uint64_t classes;
};

/// A JointBoost classifier: H(x, c) = sum of its stumps (Eq. 2.65).
struct BoostedStumps {
    std::uint32_t class_count = 0;
    std::vector<Stump> stumps;
    std::vector<float> elsewhere;  ///< stumps x class_count: k_c, zero for classes in the stump's set

    /// Returns the sum of the k_c over all stumps, per class: the constant part of H.
    std::vector<float> constant() const;
};

/// Returns the classifier whose H is the mean of the H of several (at least one, all of the same classes): bagging
/// (Breiman 1996). It has all their stumps, in order.
BoostedStumps mean_classifier(std::span<const BoostedStumps> classifiers);

/// The function that turns H into a probability.
enum class Link : std::uint32_t {
    softmax = 0,  ///< exp(s H_c) / sum exp(s H) (Eq. 2.66)
    sigmoid = 1,  ///< sigma(s H_c) / sum sigma(s H)
};

/// Turns scores H (rows x classes) into probabilities, in place, on all cores.
void scores_to_probabilities(std::span<float> scores, std::size_t classes, Link link, float scale);

/// A trained classifier and how its scores become probabilities.
struct CalibratedStumps {
    BoostedStumps stumps;
    Link link = Link::softmax;
    float scale = 1;  ///< s of the link, > 0
};

/// A matrix to score, and the output of its probabilities: rows x class_count.
struct ScoredMatrix {
    const FeatureMatrix* features;
    std::span<float> out;
};

/// Evaluates a classifier for many items. The CPU implementation is the reference; gpu/learn implements it in a shader.
class StumpScorer {
  public:
    virtual ~StumpScorer() = default;
    /// Computes class probabilities, rows x class_count, item-major. A NaN feature is above no threshold. `scale` is
    /// the link's s (> 0). Throws ModelError if a stump uses a feature that the matrix lacks or a class that the
    /// classifier lacks, UsageError if `out` has another size or the scale is not above zero.
    void probabilities(const BoostedStumps& classifier, const FeatureMatrix& features, Link link, float scale,
                       std::span<float> out) {
        const ScoredMatrix one{&features, out};
        probabilities_of_all(classifier, link, scale, std::span(&one, 1));
    }
    /// Scores several matrices, faster than one by one. Each gets the result that it would get alone, bit for bit on
    /// one device. Scores nothing if one of them is refused.
    virtual void probabilities_of_all(const BoostedStumps& classifier, Link link, float scale,
                                      std::span<const ScoredMatrix> matrices) = 0;
};

/// Throws ModelError or UsageError, as StumpScorer::probabilities does, for arguments that do not fit together.
void check_scoring(const BoostedStumps& classifier, const FeatureMatrix& features, float scale,
                   std::span<const float> out);

class CpuStumpScorer final : public StumpScorer {
  public:
    void probabilities_of_all(const BoostedStumps& classifier, Link link, float scale,
                              std::span<const ScoredMatrix> matrices) override;
};

}  // namespace exemplar
