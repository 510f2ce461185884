#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "host/labeling/features/features.h"
#include "host/labeling/inference/model.h"

namespace exemplar {

/// The energy terms of one mesh that do not depend on the CRF's parameters (thesis Eqs. 3.1-3.4), computed once so that
/// a parameter search only combines them.
struct CrfTerms {
    std::size_t classes = 0;
    std::vector<float> unary;     ///< faces x classes: a_i E_1 = -(area / median area) log P(c | x) (Eq. 3.2)
    std::vector<float> boundary;  ///< per edge: -log P(c != c' | y)
    std::vector<float> dihedral;  ///< per edge: -log(1 - min(omega / pi, 1) + epsilon), at least 0
};
/// Computes the terms. `probabilities`: faces x classes; `boundary_probability`: one per edge of `features`.
CrfTerms make_crf_terms(const MeshFeatures& features, std::span<const float> probabilities, std::size_t classes,
                        std::span<const float> boundary_probability);

/// Returns the cost of a border along each edge of `features` between labels of compatibility 1 (Eqs. 3.3, 3.4).
std::vector<double> border_costs(const MeshFeatures& features, const CrfTerms& terms, const CrfParameters& parameters);

/// Returns the labels of the lowest energy that alpha-expansion finds, one per face.
std::vector<std::int32_t> solve_crf(const MeshFeatures& features, const CrfTerms& terms,
                                    const CrfParameters& parameters);

/// Connected pieces of equal label: the piece of each face, and the label and share of the total area of each piece.
struct LabelComponents {
    std::vector<std::uint32_t> of_face;
    std::vector<std::int32_t> label;
    std::vector<float> area_share;
};
LabelComponents label_components(std::span<const std::array<std::uint32_t, 2>> edges, std::span<const float> face_area,
                                 std::span<const std::int32_t> labels);

/// Relabels every piece whose area share is below `parameters.merge_fraction` times the smallest training piece of its
/// label: it takes the neighboring label with the longest common border. Smallest pieces come first. A piece without
/// neighbors stays.
void merge_small_components(const MeshFeatures& features, const CrfParameters& parameters,
                            std::span<const float> smallest_component, std::vector<std::int32_t>& labels);

}  // namespace exemplar
