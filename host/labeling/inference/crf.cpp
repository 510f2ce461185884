#include "host/labeling/inference/crf.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "host/core/disjoint_sets.h"
#include "host/graphcut/alpha_expansion.h"

namespace exemplar {
namespace {

constexpr float k_min_unary_probability = 1e-6F;  ///< keeps -log P finite
constexpr float k_epsilon = 1e-3F;                ///< the epsilon of Eq. 3.4

float negative_log(float probability) {
    return -std::log(std::max(probability, k_min_unary_probability));
}

/// Returns the neighboring label with the longest common border of one piece; -1 if it has no neighbors.
std::int32_t most_touched_label(const std::map<std::int32_t, float>& border) {
    std::int32_t best = -1;
    float longest = 0;
    for (const auto& [label, length] : border)
        if (length > longest) longest = length, best = label;
    return best;
}

}  // namespace

CrfTerms make_crf_terms(const MeshFeatures& features, std::span<const float> probabilities, std::size_t classes,
                        std::span<const float> boundary_probability) {
    CrfTerms terms;
    terms.classes = classes;
    terms.unary.resize(probabilities.size());
    for (std::size_t i = 0; i < probabilities.size(); ++i)
        terms.unary[i] = features.face_area[i / classes] * negative_log(probabilities[i]);
    for (std::size_t e = 0; e < features.edges.size(); ++e) {
        terms.boundary.push_back(negative_log(boundary_probability[e]));
        terms.dihedral.push_back(std::max(0.0F, -std::log(1.0F - features.dihedral[e] + k_epsilon)));
    }
    return terms;
}

std::vector<double> border_costs(const MeshFeatures& features, const CrfTerms& terms, const CrfParameters& parameters) {
    std::vector<double> weight(features.edges.size());
    for (std::size_t e = 0; e < weight.size(); ++e) {
        const double g = parameters.kappa * terms.boundary[e] + parameters.lambda * terms.dihedral[e] + parameters.mu;
        weight[e] = features.edge_length[e] * g;
    }
    return weight;
}

std::vector<std::int32_t> solve_crf(const MeshFeatures& features, const CrfTerms& terms,
                                    const CrfParameters& parameters) {
    const std::vector<double> weight = border_costs(features, terms, parameters);
    return alpha_expansion(terms.unary, terms.classes, features.edges, weight, parameters.compatibility).labels;
}

LabelComponents label_components(std::span<const std::array<std::uint32_t, 2>> edges, std::span<const float> face_area,
                                 std::span<const std::int32_t> labels) {
    DisjointSets sets(labels.size());
    for (const auto& [a, b] : edges)
        if (labels[a] == labels[b]) sets.join(a, b);

    LabelComponents components;
    components.of_face.resize(labels.size());
    const double total = std::accumulate(face_area.begin(), face_area.end(), 0.0);
    for (std::uint32_t f = 0; f < labels.size(); ++f) {
        const std::uint32_t root = sets.find(f);  // the smallest face of the piece, so it comes first
        if (root == f) {
            components.of_face[f] = static_cast<std::uint32_t>(components.label.size());
            components.label.push_back(labels[f]);
            components.area_share.push_back(0);
        } else {
            components.of_face[f] = components.of_face[root];
        }
        components.area_share[components.of_face[f]] += static_cast<float>(face_area[f] / total);
    }
    return components;
}

void merge_small_components(const MeshFeatures& features, const CrfParameters& parameters,
                            std::span<const float> smallest_component, std::vector<std::int32_t>& labels) {
    if (parameters.merge_fraction <= 0) return;
    const LabelComponents pieces = label_components(features.edges, features.face_area, labels);
    std::vector<std::uint32_t> small;
    for (std::uint32_t p = 0; p < pieces.label.size(); ++p)
        if (pieces.label[p] >= 0 &&
            pieces.area_share[p] < parameters.merge_fraction * smallest_component[pieces.label[p]])
            small.push_back(p);
    std::stable_sort(small.begin(), small.end(),
                     [&](std::uint32_t a, std::uint32_t b) { return pieces.area_share[a] < pieces.area_share[b]; });

    // A merged piece counts with its new label when its neighbors are merged.
    std::vector<std::int32_t> piece_label = pieces.label;
    std::vector<std::vector<std::pair<std::uint32_t, float>>> borders(pieces.label.size());
    for (std::size_t e = 0; e < features.edges.size(); ++e) {
        const std::uint32_t a = pieces.of_face[features.edges[e][0]], b = pieces.of_face[features.edges[e][1]];
        if (a == b) continue;
        borders[a].emplace_back(b, features.edge_length[e]);
        borders[b].emplace_back(a, features.edge_length[e]);
    }
    for (const std::uint32_t p : small) {
        std::map<std::int32_t, float> border;
        for (const auto& [other, length] : borders[p])
            if (piece_label[other] != piece_label[p]) border[piece_label[other]] += length;
        if (const std::int32_t label = most_touched_label(border); label >= 0) piece_label[p] = label;
    }
    for (std::size_t f = 0; f < labels.size(); ++f) labels[f] = piece_label[pieces.of_face[f]];
}

}  // namespace exemplar
