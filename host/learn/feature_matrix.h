#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace exemplar {

/// Values of named features for a number of items (faces, edges, pixels). Feature-major: all items of feature 0, then
/// of feature 1, ..., so that a feature is contiguous for boosting and coalesced on a GPU.
struct FeatureMatrix {
    std::size_t rows = 0;            ///< items
    std::vector<std::string> names;  ///< one per feature; "family.detail", e.g. "curvature.k1@0.05"
    std::vector<float> values;       ///< names.size() x rows

    std::size_t cols() const { return names.size(); }
    std::span<const float> column(std::size_t feature) const { return {values.data() + feature * rows, rows}; }
    std::span<float> column(std::size_t feature) { return {values.data() + feature * rows, rows}; }
    /// Adds a feature of zeros and returns it; earlier spans become invalid.
    std::span<float> add(std::string name) {
        names.push_back(std::move(name));
        values.resize(names.size() * rows);
        return column(names.size() - 1);
    }
    /// Appends all features of `other`, which has the same number of rows.
    void append(const FeatureMatrix& other) {
        names.insert(names.end(), other.names.begin(), other.names.end());
        values.insert(values.end(), other.values.begin(), other.values.end());
    }
};

}  // namespace exemplar
