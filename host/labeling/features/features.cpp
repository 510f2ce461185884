#include "host/labeling/features/features.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <utility>

#include "host/core/errors.h"
#include "host/core/interrupt.h"
#include "host/core/statistics.h"
#include "host/core/stopwatch.h"
#include "host/labeling/features/feature_families.h"
#include "host/mesh/editing/validate.h"

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
    double unit = static_cast<double>(upper_median(sorted));
    if (!(unit > 0.0)) {
        for (const float value : values) unit += static_cast<double>(value) / static_cast<double>(values.size());
    }
    for (float& value : result) value = unit > 0.0 ? static_cast<float>(static_cast<double>(value) / unit) : 1.0F;
    return result;
}

/// Computes the families that use the neighborhood of each face, with one search per face for all.
CurvatureFamily::FaceValues add_neighborhood_families(const PreparedMesh& prepared, FeatureMatrix& curvature,
                                                      FeatureMatrix& pca, FeatureMatrix& shape_context,
                                                      StepClock& clock) {
    CurvatureFamily curvatures(prepared);
    PcaFamily regions(prepared);
    ShapeContextFamily contexts(prepared);
    const float radius = std::max({curvatures.radius(), regions.radius(), contexts.radius()});
    for_each_neighborhood(prepared, radius, std::max(k_min_patch_faces, k_min_region_faces),
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

bool is_appended(const std::string& name) {
    return name.starts_with("context.") || name.starts_with("orientation.");
}

MeshFeatures compute_features(const TriangleMesh& mesh, const FeatureOptions& options) {
    require_usable(mesh, "mesh");
    if (options.samples == 0 || options.samples > k_max_samples)
        throw UsageError(fmt::format("features of {} samples; FeatureOptions::samples takes 1 to {}", options.samples,
                                     k_max_samples));
    MeshFeatures features;
    StepClock clock(features);
    const PreparedMesh prepared = prepare_mesh(mesh, options.samples);
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
    using Family = std::reference_wrapper<const FeatureMatrix>;
    for (const Family family : {Family(curvature), Family(pca), Family(diameter), Family(medial), Family(geodesic),
                                Family(shape_context), Family(spin)}) {
        features.unary.append(family);
    }
    features.context = context_geometry(prepared);
    clock.done("context");
    features.unary.append(region_features(prepared, features.unary));
    clock.done("regions");
    FeatureMatrix orientation = orientation_features(prepared);
    if (options.orientation) features.unary.append(orientation);
    features.position = std::move(orientation.values);
    features.face_area = in_median_units(prepared.area_share);
    return features;
}

}  // namespace exemplar
