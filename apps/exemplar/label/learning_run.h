#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>

#include "apps/exemplar/label/evaluation_run.h"

namespace exemplar {

/// Measures how the rate of a task grows with the number of labeled shapes: trains on 1, 2, 3, 4, 6, 8, ... of its
/// training meshes, nested and drawn at random, with the options of suggestion_training(), and tests each model on all
/// test meshes. Returns `points` (`shapes`, `recognition_rate`), `expected_gain` of three more shapes by the power law
/// fitted to them (absent with fewer than three points), and `label_next`, the test mesh that helps most if it is
/// labeled.
nlohmann::json learning_curve_of(const EvaluationTask& task, DeviceBackend& backend, const std::filesystem::path& cache,
                                 std::uint64_t seed);

/// Returns a learning curve in one line of words.
std::string learning_curve_text(const nlohmann::json& curve);

}  // namespace exemplar
