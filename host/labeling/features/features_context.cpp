#include <algorithm>
#include <cmath>

#include "host/core/parallel.h"
#include "host/labeling/features/feature_families.h"
#include "host/mesh/queries/axes.h"
#include "host/shape/log_bins.h"

namespace exemplar {
namespace {

using InnerEdges = std::array<float, k_context_bins - 1>;

/// The inner edges of the ranges over [0, maximum]; any positive range serves where all distances are zero.
InnerEdges inner_edges(float maximum) {
    const auto edges = log_bin_edges<k_context_bins>(maximum > 0.0F ? maximum : 1.0F);
    InnerEdges inner{};
    std::copy_n(edges.begin() + 1, inner.size(), inner.begin());
    return inner;
}

/// Largest distance between a sample and a face along an axis.
float largest_difference(std::span<const float> position, std::span<const std::uint32_t> samples) {
    const auto [low, high] = std::ranges::minmax(position);
    float largest = 0.0F;
    for (const std::uint32_t face : samples) largest = std::max({largest, position[face] - low, high - position[face]});
    return largest;
}

std::vector<std::uint8_t> geodesic_bins(const PreparedMesh& prepared) {
    const std::size_t faces = prepared.face_count();
    float largest = 0.0F;
    for (const float d : prepared.distance) {
        if (std::isfinite(d)) largest = std::max(largest, d);
    }
    const InnerEdges edges = inner_edges(largest);
    std::vector<std::uint8_t> bins(prepared.distance.size());
    parallel_for(prepared.sample_count(), [&](std::size_t s) {
        for (std::size_t i = s * faces; i < (s + 1) * faces; ++i) {
            int bin = 0;
            for (const float edge : edges) bin += edge <= prepared.distance[i] ? 1 : 0;
            bins[i] = std::isfinite(prepared.distance[i]) ? static_cast<std::uint8_t>(bin) : k_no_bin;
        }
    });
    return bins;
}

}  // namespace

ContextGeometry context_geometry(const PreparedMesh& prepared) {
    ContextGeometry context;
    context.faces = prepared.face_count();
    context.sample_face = prepared.samples.face;
    context.sample_area = prepared.samples.area_share;
    context.geodesic_bin = geodesic_bins(prepared);
    context.axis_position.resize(k_context_axes * context.faces);
    const auto set_axis = [&](std::size_t axis, const Vec3& origin, const Vec3& direction, bool sides_alike) {
        const std::span<float> position(context.axis_position.data() + axis * context.faces, context.faces);
        for (std::size_t f = 0; f < context.faces; ++f) {
            const float x = direction.dot(prepared.center[f] - origin);
            position[f] = sides_alike ? std::abs(x) : x;
        }
        context.axis_edges[axis] = inner_edges(largest_difference(position, context.sample_face));
    };
    const PrincipalAxes axes = principal_axes(prepared.mesh);
    for (std::size_t k = 0; k < 3; ++k) set_axis(k, axes.center, axes.axis[k], false);
    const std::vector<SymmetryPlane> planes = symmetry_planes(prepared.mesh, 3);
    for (std::size_t k = 0; k < 3; ++k) set_axis(3 + k, planes[k].point, planes[k].normal, true);
    return context;
}

}  // namespace exemplar
