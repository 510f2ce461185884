#include "host/mesh/skin.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "host/core/errors.h"

namespace exemplar {
namespace {

double weight_sum(const std::vector<Influence>& row) {
    double sum = 0;
    for (const Influence& influence : row) sum += influence.weight;
    return sum;
}

/// Scales weights that sum to `sum` so that they sum to one; leaves them if only rounding is off.
void scale_weights(std::vector<Influence>& row, double sum) {
    constexpr double k_same = 1e-6;
    const double scale = std::abs(sum - 1) > k_same ? 1 / sum : 1;
    for (Influence& influence : row) influence.weight = std::min(static_cast<float>(influence.weight * scale), 1.0f);
}

/// Sorts the row by bone and adds up the weights of each bone.
void merge_bones(std::vector<Influence>& row) {
    std::ranges::stable_sort(row, {}, &Influence::bone);
    std::size_t kept = 0;
    for (const Influence& influence : row) {
        if (kept > 0 && row[kept - 1].bone == influence.bone)
            row[kept - 1].weight += influence.weight;
        else
            row[kept++] = influence;
    }
    row.resize(kept);
}

/// Drops weights too small to be visible and scales the rest to sum to one; returns the previous sum.
double normalize_row(std::vector<Influence>& row) {
    constexpr float k_min_weight = 1e-4f;
    std::erase_if(row, [](const Influence& influence) { return influence.weight <= 0; });
    const double before = weight_sum(row);
    if (row.empty()) return before;
    scale_weights(row, before);
    merge_bones(row);
    std::erase_if(row, [&](const Influence& influence) { return influence.weight < k_min_weight; });
    scale_weights(row, weight_sum(row));
    return before;
}

}  // namespace

void clean_influences(Skin& skin, const std::string& name, std::vector<std::string>& warnings) {
    constexpr double k_visible = 1e-3;
    std::vector<std::uint32_t> begin{0};
    std::vector<Influence> influences;
    std::size_t unbound = 0, uneven = 0;
    double largest = 0;
    const std::size_t vertex_count = skin.influence_begin.empty() ? 0 : skin.influence_begin.size() - 1;
    for (std::size_t v = 0; v < vertex_count; ++v) {
        const std::span<const Influence> before = skin.influences_of(v);
        for (const Influence& influence : before) {
            if (influence.bone >= skin.bones.size())
                throw MeshError(
                    fmt::format("{}: vertex {} is bound to bone {} of {}", name, v, influence.bone, skin.bones.size()));
            if (!std::isfinite(influence.weight))
                throw MeshError(fmt::format("{}: vertex {} has a weight that is not finite", name, v));
        }
        std::vector<Influence> row(before.begin(), before.end());
        const double sum = normalize_row(row);
        if (row.empty()) {
            ++unbound;
            row.push_back({before.empty() ? 0 : before.front().bone, 1.0f});
        } else if (std::abs(sum - 1) > k_visible) {
            ++uneven;
            largest = std::max(largest, std::abs(sum - 1));
        }
        influences.insert(influences.end(), row.begin(), row.end());
        begin.push_back(static_cast<std::uint32_t>(influences.size()));
    }
    skin.influence_begin = std::move(begin);
    skin.influences = std::move(influences);
    if (unbound)
        warnings.push_back(fmt::format("{} vertices have no weight; they were bound to the first joint", unbound));
    if (uneven)
        warnings.push_back(fmt::format(
            "the weights of {} vertices did not sum to one (off by up to {:.3g}); they were scaled", uneven, largest));
}

void morph(const Skin& skin, std::span<const Vec3> rest, std::span<const float> weights, std::vector<Vec3>& out) {
    out.assign(rest.begin(), rest.end());
    for (std::size_t t = 0; t < skin.targets.size(); ++t) {
        if (weights[t] == 0) continue;
        const MorphTarget& target = skin.targets[t];
        for (std::size_t i = 0; i < target.vertices.size(); ++i)
            out[target.vertices[i]] += weights[t] * target.offsets[i];
    }
}

template <typename Scalar>
void skin_vertices(const Skin& skin, const std::vector<AffineOf<Scalar>>& bones, std::vector<Vec3>& vertices) {
    for (std::size_t v = 0; v < vertices.size(); ++v) {
        Eigen::Matrix<Scalar, 3, 4> blended = Eigen::Matrix<Scalar, 3, 4>::Zero();
        for (const Influence& influence : skin.influences_of(v))
            blended += static_cast<Scalar>(influence.weight) * bones[influence.bone].matrix();
        vertices[v] = (blended * vertices[v].cast<Scalar>().homogeneous()).template cast<float>();
    }
}

template void skin_vertices(const Skin&, const std::vector<AffineOf<float>>&, std::vector<Vec3>&);
template void skin_vertices(const Skin&, const std::vector<AffineOf<double>>&, std::vector<Vec3>&);

}  // namespace exemplar
