#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <vector>

#include "host/data/corpus.h"
#include "host/graphcut/alpha_expansion.h"
#include "host/learn/boosting/boosted_stumps.h"
#include "host/learn/feature_matrix.h"
#include "host/mesh/mesh.h"

namespace exemplar {

// Generated data for `exemplar bench` if the user gives none. Equal calls give equal data.

/// Splits every triangle into four at the midpoints of its edges, `times` times: the same surface of 4^times as many
/// faces.
TriangleMesh refine(TriangleMesh mesh, std::size_t times);

/// Generates quadrupeds of about `faces` faces with their true labels, for seeds 1 to `count`.
LabeledCorpus generated_fourlegs(std::size_t count, std::size_t faces);

/// A labeling energy on the faces of a mesh.
struct CutProblem {
    std::size_t labels = 0;
    std::vector<std::array<std::uint32_t, 2>> edges;
    std::vector<float> unary;
    std::vector<double> weight, compatibility;
    LabelingEnergy energy() const { return {unary, weight, compatibility}; }
};
/// Makes a typical problem for the graph cut: `labels` regions around distant points of the surface, unary costs
/// -log of probabilities that err in patches of all sizes, and Potts terms in proportion to the lengths of edges.
CutProblem make_cut_problem(const TriangleMesh& mesh, std::size_t labels);

/// Returns the energy that iterated conditional modes reach from the cheapest labels: each node takes the label of
/// minimum cost given its neighbors, until none changes. It is the simplest minimizer; any good method does better.
double energy_of_conditional_modes(const CutProblem& problem);

/// Training data of overlapping classes: normal values whose means differ by class, 30% of them zero, as in
/// histograms.
struct BoostingData {
    FeatureMatrix features;
    std::vector<std::int32_t> labels;
    std::vector<float> weights;
};
BoostingData make_boosting_data(std::size_t rows, std::size_t columns, std::size_t classes);

/// Makes a classifier of random stumps that are shared by 40 sets of classes, as after training.
BoostedStumps random_stumps(std::size_t stumps, std::size_t columns, std::size_t classes);

}  // namespace exemplar
