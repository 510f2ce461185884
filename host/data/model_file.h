#pragma once

#include <string>
#include <vector>

#include "host/data/safetensors.h"
#include "host/learn/boosting/boosted_stumps.h"

/// The parts that model files of all systems share.
namespace exemplar {

/// Throws ModelError that says how the file is damaged.
[[noreturn]] void inconsistent(const TensorFile& file, const std::string& what);
/// Throws ModelError if one of the values is not finite.
void require_finite(const TensorFile& file, const std::string& name, const std::vector<float>& values);
/// Throws ModelError unless the metadata `key` is the version that this program knows; `mend` says what to do with an
/// older file.
void require_version(const TensorFile& file, const std::string& key, int known, const std::string& mend);

/// Adds a classifier as arrays called NAME.feature, NAME.threshold_above_below, ... (docs/formats.md).
void add_classifier(TensorFile& file, const std::string& name, const CalibratedStumps& classifier);
/// Reads a classifier; throws ModelError if arrays are missing, contradict each other, or name a feature or class
/// that does not exist.
CalibratedStumps get_classifier(const TensorFile& file, const std::string& name, std::size_t class_count,
                                std::size_t feature_count);

}  // namespace exemplar
