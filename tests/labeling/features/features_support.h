#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <string>
#include <vector>

#include "host/core/random.h"
#include "host/labeling/features/features.h"
#include "tests/support/shapes.h"

namespace exemplar::feature_tests {

inline std::size_t index_of(const FeatureMatrix& matrix, const std::string& name) {
    const auto found = std::ranges::find(matrix.names, name);
    EXPECT_NE(found, matrix.names.end()) << name;
    return found == matrix.names.end() ? 0 : static_cast<std::size_t>(found - matrix.names.begin());
}
inline std::span<const float> column(const FeatureMatrix& matrix, const std::string& name) {
    return matrix.column(index_of(matrix, name));
}

/// A lopsided torus with a bump: no symmetry, so no ties that rounding could turn.
inline TriangleMesh lopsided_torus(std::uint32_t n, std::uint32_t m) {
    Random random(5);
    return shapes::transformed(shapes::torus(1.0F, 0.4F, n, m), [&](Vec3 p) -> Vec3 {
        for (int k = 0; k < 3; ++k) p[k] += static_cast<float>(random.uniform(-0.01, 0.01));
        const float bump = std::exp(-4.0F * (p - Vec3(1.2F, 0.3F, 0.2F)).squaredNorm());
        return Vec3(1.3F * p.x() + 0.1F * p.y() * p.z(), p.y(), 0.9F * p.z()) * (1.0F + 0.4F * bump);
    });
}

/// Share of the values of `b` that differ from those of `a` by more than `tolerance` times their column's range.
/// `row_of[i]` is the row of `a` that row i of `b` stands for; the same row if empty.
inline double mismatched_share(const FeatureMatrix& a, const FeatureMatrix& b, float tolerance,
                               std::span<const std::uint32_t> row_of = {}) {
    EXPECT_EQ(a.names, b.names);
    EXPECT_EQ(a.rows, b.rows);
    if (a.names != b.names || a.rows != b.rows) return 1.0;
    std::size_t bad = 0;
    for (std::size_t k = 0; k < a.cols(); ++k) {
        const auto [low, high] = std::ranges::minmax(a.column(k));
        const float allowed = tolerance * (high - low) + 1e-5F * std::max(std::abs(low), std::abs(high)) + 1e-5F;
        for (std::size_t i = 0; i < a.rows; ++i) {
            const float x = a.column(k)[row_of.empty() ? i : row_of[i]], y = b.column(k)[i];
            if (!(std::abs(x - y) <= allowed)) ++bad;
        }
    }
    return static_cast<double>(bad) / static_cast<double>(std::max<std::size_t>(a.values.size(), 1));
}

inline void expect_finite(const MeshFeatures& features, std::size_t faces) {
    EXPECT_EQ(features.unary.rows, faces);
    EXPECT_EQ(features.unary.cols(), 678U);
    EXPECT_EQ(features.pairwise.cols(), 186U);
    EXPECT_EQ(features.pairwise.rows, features.edges.size());
    const auto finite = [](float x) { return std::isfinite(x); };
    const auto first_bad = [&](const FeatureMatrix& m) -> std::string {
        const auto bad = std::ranges::find_if_not(m.values, finite);
        return bad == m.values.end() ? "" : m.names[static_cast<std::size_t>(bad - m.values.begin()) / m.rows];
    };
    EXPECT_EQ(first_bad(features.unary), "");
    EXPECT_EQ(first_bad(features.pairwise), "");
    EXPECT_TRUE(std::ranges::all_of(features.face_area, finite));
    EXPECT_TRUE(std::ranges::all_of(features.edge_length, finite));
    EXPECT_TRUE(std::ranges::all_of(features.dihedral, finite));
    EXPECT_TRUE(std::ranges::all_of(features.context.axis_position, finite));
    EXPECT_TRUE(std::ranges::all_of(features.context.sample_area, finite));
    EXPECT_EQ(features.face_area.size(), faces);
    EXPECT_EQ(features.edge_context.begin.size(), features.edges.size() + 1);
}

}  // namespace exemplar::feature_tests
