#include "host/labeling/features.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "host/core/errors.h"
#include "host/core/interrupt.h"
#include "host/core/stopwatch.h"
#include "host/labeling/feature_families.h"
#include "host/labeling/log_bins.h"
#include "host/mesh/axes.h"
#include "host/mesh/validate.h"

namespace exemplar {
namespace {

/// Runs one step after another and notes the wall time of each.
class StepClock {
  public:
    explicit StepClock(MeshFeatures& features) : features_(&features) {}
    void done(const char* step) {
        features_->seconds.emplace_back(step, watch_.wall());
        watch_ = Stopwatch();
        check_interrupt();
    }

  private:
    MeshFeatures* features_;
    Stopwatch watch_;
};

/// Values in units of their median; of their mean where the median is zero; 1 where all are zero.
std::vector<float> in_median_units(std::span<const float> values) {
    std::vector<float> result(values.begin(), values.end());
    if (result.empty()) return result;
    std::vector<float> sorted = result;
    std::ranges::nth_element(sorted, sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2));
    double unit = static_cast<double>(sorted[sorted.size() / 2]);
    if (!(unit > 0.0)) {
        for (const float value : values) unit += static_cast<double>(value) / static_cast<double>(values.size());
    }
    for (float& value : result) value = unit > 0.0 ? static_cast<float>(static_cast<double>(value) / unit) : 1.0F;
    return result;
}

/// The inner edges of k_context_bins ranges over [0, maximum]; any positive range serves where all distances are zero.
std::array<float, k_context_bins - 1> inner_edges(float maximum) {
    const auto edges = log_bin_edges<k_context_bins>(maximum > 0.0F ? maximum : 1.0F);
    std::array<float, k_context_bins - 1> inner{};
    std::copy_n(edges.begin() + 1, inner.size(), inner.begin());
    return inner;
}

/// Largest difference between a sample's and a face's position.
float largest_difference(std::span<const float> position, std::span<const std::uint32_t> samples) {
    const auto [low, high] = std::ranges::minmax(position);
    float largest = 0.0F;
    for (const std::uint32_t face : samples) largest = std::max({largest, position[face] - low, high - position[face]});
    return largest;
}

ContextGeometry context_geometry(const PreparedMesh& prepared) {
    ContextGeometry context;
    context.faces = prepared.face_count();
    context.sample_face = prepared.samples.face;
    context.sample_area = prepared.samples.area_share;
    context.axis_position.resize(k_context_axes * context.faces);
    const auto set_axis = [&](std::size_t axis, const Vec3& origin, const Vec3& direction) {
        const std::span<float> position(context.axis_position.data() + axis * context.faces, context.faces);
        for (std::size_t f = 0; f < context.faces; ++f)
            position[f] = std::abs(direction.dot(prepared.center[f] - origin));
        context.edges[1 + axis] = inner_edges(largest_difference(position, context.sample_face));
    };
    const PrincipalAxes axes = principal_axes(prepared.mesh);
    for (std::size_t k = 0; k < 3; ++k) set_axis(k, axes.center, axes.axis[k]);
    const std::vector<SymmetryPlane> planes = symmetry_planes(prepared.mesh, 3);
    for (std::size_t k = 0; k < 3; ++k) set_axis(3 + k, planes[k].point, planes[k].normal);
    float largest = 0.0F;
    for (const float d : prepared.distance) {
        if (std::isfinite(d)) largest = std::max(largest, d);
    }
    context.edges[0] = inner_edges(largest);
    return context;
}

/// The families that look around each face share one search per face.
CurvatureFamily::FaceValues add_neighborhood_families(const PreparedMesh& prepared, FeatureMatrix& curvature,
                                                      FeatureMatrix& pca, FeatureMatrix& shape_context,
                                                      StepClock& clock) {
    CurvatureFamily curvatures(prepared);
    PcaFamily regions(prepared);
    ShapeContextFamily contexts(prepared);
    const float radius = std::max({curvatures.radius(), regions.radius(), contexts.radius()});
    for_each_neighborhood(prepared, radius, std::max(k_least_patch, k_least_region),
                          [&](std::uint32_t face, Neighborhood neighborhood) {
                              curvatures.measure(face, neighborhood);
                              regions.measure(face, neighborhood);
                              contexts.measure(face, neighborhood);
                          });
    clock.done("neighborhoods");
    regions.measure_large_radii();
    clock.done("pca");
    contexts.measure_far();
    shape_context = contexts.take();
    clock.done("shape context");
    curvature = curvatures.take_unary();
    pca = regions.take();
    return curvatures.take_pairwise();
}

void add_pairwise(const PreparedMesh& prepared, const CurvatureFamily::FaceValues& curvature,
                  const FeatureMatrix& diameter, const FeatureMatrix& medial, MeshFeatures& features) {
    InteriorEdges edges = interior_edges(prepared);
    features.pairwise.rows = edges.face.size();
    features.pairwise.append(dihedral_features(prepared, edges, features.edge_context));
    features.pairwise.append(edge_curvature_features(prepared, edges, curvature));
    features.pairwise.append(difference_features(edges, diameter));
    features.pairwise.append(difference_features(edges, medial));
    features.edge_length = in_median_units(edges.length);
    features.dihedral = std::move(edges.dihedral);
    features.edges = std::move(edges.face);
}

}  // namespace

MeshFeatures compute_features(const TriangleMesh& mesh, const FeatureOptions& options) {
    require_usable(mesh, "mesh");
    if (options.samples == 0)
        throw UsageError("features need at least one sample; set FeatureOptions::samples to 1 or more");
    MeshFeatures features;
    StepClock clock(features);
    PreparedMesh prepared = prepare_mesh(mesh, options.samples);
    clock.done("distances");

    FeatureMatrix curvature, pca, shape_context;
    const auto face_curvature = add_neighborhood_families(prepared, curvature, pca, shape_context, clock);
    const FeatureMatrix geodesic = geodesic_features(prepared);
    clock.done("geodesic");
    const FeatureMatrix spin = spin_features(prepared);
    clock.done("spin");
    const RayScene scene(prepared.mesh);
    const InwardRays rays = cast_inward_rays(prepared, scene);
    const FeatureMatrix diameter = diameter_features(prepared, rays);
    clock.done("diameter");
    const FeatureMatrix medial = medial_features(prepared, scene, rays);
    clock.done("medial");
    add_pairwise(prepared, face_curvature, diameter, medial, features);
    clock.done("pairwise");

    features.unary.rows = prepared.face_count();
    for (const FeatureMatrix* family : {&curvature, &pca, &diameter, &medial, &geodesic, &shape_context, &spin}) {
        features.unary.append(*family);
    }
    if (options.orientation) features.unary.append(orientation_features(prepared));
    features.face_area = in_median_units(prepared.area_share);
    features.context = context_geometry(prepared);
    features.context.geodesic = std::move(prepared.distance);
    clock.done("context");
    return features;
}

}  // namespace exemplar
