#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "host/labeling/inference/crf.h"

namespace exemplar {

/// A mesh on which CRF parameters are evaluated; its terms come from classifiers that never saw it.
struct CrfExample {
    const MeshFeatures* features;
    CrfTerms terms;
    std::span<const std::int32_t> truth;    ///< per face; faces with -1 are ignored
    std::vector<float> smallest_component;  ///< per label, of the other meshes (see merge_small_components)
};

/// Cost and result of the parameter search.
struct CrfSearchReport {
    std::size_t evaluations = 0;
    double error_without_cut = 0;  ///< mean segment-weighted error of the classifiers alone
    double error = 0;              ///< the same with the learned parameters
};

/// Learns kappa, lambda, mu, L and the merging of small pieces (thesis Sec. 3.3.2) by minimizing the mean
/// segment-weighted error (Eq. 3.9) over the examples: first on a coarse grid, with L = 1 for labels that touch in
/// `touching` (classes x classes) and a prohibitive value for others, then without derivatives (NLopt) over all
/// parameters. A small penalty keeps compatibilities near 1 unless a change helps. Deterministic. Calls `progress`
/// after each evaluation.
CrfParameters learn_crf(std::span<const CrfExample> examples, std::size_t classes, const std::vector<bool>& touching,
                        const std::function<void()>& progress, CrfSearchReport& report);

/// Returns an upper bound on the evaluations that learn_crf makes, to show progress.
std::size_t crf_search_evaluations(std::size_t classes, const std::vector<bool>& touching);

}  // namespace exemplar
