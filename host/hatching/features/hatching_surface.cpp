#include "host/hatching/features/hatching_surface.h"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>

#include "host/core/errors.h"
#include "host/core/interrupt.h"
#include "host/core/parallel.h"
#include "host/core/stopwatch.h"
#include "host/hatching/features/line_directions.h"
#include "host/lines/extraction/lines.h"
#include "host/mesh/curvature/curvature_estimator.h"
#include "host/mesh/editing/validate.h"
#include "host/shape/log_bins.h"
#include "host/shape/shape_families.h"

namespace exemplar {
namespace {

constexpr std::size_t k_surface_samples = 1000;
constexpr std::size_t k_pca_scales = 3;

/// Computes means of values per face over the faces around a vertex, weighted by area.
class FacesToVertices {
  public:
    FacesToVertices(const PreparedMesh& prepared) : prepared_(prepared) {}
    template <typename ValueOf>
    float mean(std::size_t vertex, ValueOf&& value_of) const {
        float sum = 0, weight = 0;
        for (const std::uint32_t face : prepared_.topology.faces_of_vertex(static_cast<std::uint32_t>(vertex))) {
            const float share = std::max(prepared_.area_share[face], 1e-12f);
            sum += share * value_of(face);
            weight += share;
        }
        return weight > 0 ? sum / weight : 0.0f;
    }

  private:
    const PreparedMesh& prepared_;
};

/// Appends those columns of `faces` whose names `keep` accepts, as means per vertex.
template <typename Keep>
void append_at_vertices(const PreparedMesh& prepared, const FeatureMatrix& faces, Keep&& keep, FeatureMatrix& out) {
    const FacesToVertices to_vertices(prepared);
    for (std::size_t c = 0; c < faces.cols(); ++c) {
        if (!keep(faces.names[c])) continue;
        const std::span<float> column = out.add(faces.names[c]);
        const std::span<const float> values = faces.column(c);
        parallel_for(
            out.rows,
            [&](std::size_t v) { column[v] = to_vertices.mean(v, [&](std::uint32_t f) { return values[f]; }); }, 1024);
    }
}

/// Whether the thesis uses a column of shape diameter or medial distance: the means in cones of 60, 90 and 120
/// degrees, and their logarithms to 1, 2 and 4.
bool is_cone_column(const std::string& name) {
    const std::size_t at = name.find(".mean@");
    if (at == std::string::npos) return false;
    const std::string rest = name.substr(at + 6);
    const bool angle = rest.starts_with("60") || rest.starts_with("90") || rest.starts_with("120");
    return angle && !rest.ends_with("/log8");
}

struct TensorAxes {
    Vec3 first, second;
    float first_confidence, second_confidence;
};

/// Axes of largest and second largest extent, projected into the tangent plane. An axis is the more reliable, the
/// more its extent differs from the others.
TensorAxes tensor_axes(const std::array<float, 6>& c, const Vec3& normal) {
    Eigen::Matrix3f covariance;
    covariance << c[0], c[1], c[2], c[1], c[3], c[4], c[2], c[4], c[5];
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3f> solver(covariance);
    const Vec3 values = solver.eigenvalues().cwiseMax(0.0f).cwiseSqrt();
    const auto laid = [&](Eigen::Index k) {
        const Vec3 axis = solver.eigenvectors().col(k);
        return Vec3(axis - normal * normal.dot(axis));
    };
    const float first_gap = values[2] > 0 ? (values[2] - values[1]) / values[2] : 0;
    const float second_gap = values[2] > 0 ? std::min(values[2] - values[1], values[1] - values[0]) / values[2] : 0;
    const Vec3 first = laid(2), second = laid(1);
    return {first, second, direction_confidence(first_gap) * first.squaredNorm(),
            direction_confidence(second_gap) * second.squaredNorm()};
}

/// Measures curvature at all scales, and the feature size unless it is known (not 0).
void measure_curvature(HatchingSurface& surface, float known_feature_size) {
    CurvatureEstimator estimator(surface.mesh.faces, surface.mesh.vertex_count());
    CurvatureOptions options;
    options.smoothing = 1;
    surface.line_curvature = estimator.estimate(surface.mesh.vertices, options);
    surface.feature_size =
        known_feature_size > 0 ? known_feature_size : feature_size(surface.mesh.vertices, surface.line_curvature);
    options.smoothing_unit = static_cast<double>(surface.unit);
    for (std::size_t s = 0; s < k_hatching_scales.size(); ++s) {
        // The Gaussian with the variance of a disk of that radius.
        options.smoothing = k_hatching_scales[s] / 2;
        surface.curvature[s] = estimator.estimate(surface.mesh.vertices, options);
    }
}

void complete_principal(const DirectionSmoother& smoother, std::size_t scale, HatchingSurface& surface) {
    const VertexCurvature& c = surface.curvature[scale];
    std::vector<float> confidence(c.k1.size());
    for (std::size_t v = 0; v < confidence.size(); ++v) {
        // Radii of curvature above twice the median distance count as flat.
        const float largest = std::max({std::abs(c.k1[v]), std::abs(c.k2[v]), 0.5f / surface.unit});
        confidence[v] = direction_confidence((c.k1[v] - c.k2[v]) / (2 * largest));
    }
    std::vector<Vec3>& k_max = surface.directions.k_max[scale];
    std::vector<Vec3>& k_min = surface.directions.k_min[scale];
    k_max = smoother.complete(c.e1, confidence);
    k_min.resize(k_max.size());
    for (std::size_t v = 0; v < k_max.size(); ++v) k_min[v] = surface.normals[v].cross(k_max[v]);
}

/// Direction fields that follow from curvature: k_max of each scale (k_min is perpendicular to it), ridges, valleys.
constexpr std::size_t k_bending_fields = k_hatching_scales.size() + 2;
void complete_bending(const DirectionSmoother& smoother, std::size_t field, HatchingSurface& surface) {
    if (field < k_hatching_scales.size()) complete_principal(smoother, field, surface);
    if (field == k_hatching_scales.size())
        surface.directions.ridges = complete_line_directions(smoother, surface, LineType::ridges);
    if (field == k_hatching_scales.size() + 1)
        surface.directions.valleys = complete_line_directions(smoother, surface, LineType::valleys);
}

class Measurement {
  public:
    explicit Measurement(const TriangleMesh& mesh) : prepared_(prepare_mesh(mesh, k_surface_samples)) {
        surface_.mesh = mesh;
        // Faces of the prepared mesh are turned outward if need be.
        surface_.mesh.faces = prepared_.mesh.faces;
        surface_.normals = vertex_normals(surface_.mesh);
        const double prepared_size = bounding_box(prepared_.mesh).diagonal();
        const double scale = prepared_size > 0 ? bounding_box(surface_.mesh).diagonal() / prepared_size : 1.0;
        surface_.unit = prepared_.median_distance * static_cast<float>(scale);
        done("distances");
    }

    HatchingSurface run() {
        measure_curvature(surface_, 0);
        surface_.neighbors = build_face_neighbors(surface_.mesh.faces, surface_.mesh.vertices);
        done("curvature");
        surface_.descriptors = descriptors();
        done("descriptors");
        surface_.occlusion = measure_self_occlusion(surface_.mesh, surface_.normals);
        done("self-occlusion");
        complete_directions();
        done("directions");
        keep_context();
        done("context");
        return std::move(surface_);
    }

    /// Measures the shape descriptors; needs no step before it.
    FeatureMatrix descriptors() {
        FeatureMatrix at_vertices;
        at_vertices.rows = surface_.mesh.vertex_count();
        const auto all = [](const std::string&) { return true; };
        PcaFamily pca(prepared_, k_pca_scales);
        pca.keep_covariances();
        ShapeContextFamily contexts(prepared_);
        for_each_neighborhood(prepared_, std::max(pca.radius(), contexts.radius()), k_min_region_faces,
                              [&](std::uint32_t face, Neighborhood neighborhood) {
                                  pca.measure(face, neighborhood);
                                  contexts.measure(face, neighborhood);
                              });
        pca.measure_large_radii();
        contexts.measure_far();
        append_at_vertices(prepared_, pca.take(), all, at_vertices);
        covariances_ = pca.take_covariances();
        const RayScene scene(prepared_.mesh);
        const InwardRays rays = cast_inward_rays(prepared_, scene);
        append_at_vertices(prepared_, diameter_features(prepared_, rays), is_cone_column, at_vertices);
        append_at_vertices(prepared_, medial_features(prepared_, scene, rays), is_cone_column, at_vertices);
        append_at_vertices(prepared_, geodesic_features(prepared_), all, at_vertices);
        append_at_vertices(prepared_, contexts.take(5, 6), all, at_vertices);
        return at_vertices;
    }

  private:
    void done(const char* step) {
        surface_.seconds.emplace_back(step, watch_.wall());
        watch_ = Stopwatch();
        check_interrupt();
    }

    void complete_directions() {
        const DirectionSmoother smoother(surface_.mesh, surface_.normals);
        SurfaceDirections& out = surface_.directions;
        parallel_for(6 + k_bending_fields, [&](std::size_t field) {
            const std::size_t scale = field % 3;
            if (field < 3) out.e_a[scale] = complete_axis(smoother, scale, true);
            if (field >= 3 && field < 6) out.e_b[scale] = complete_axis(smoother, scale, false);
            if (field >= 6) complete_bending(smoother, field - 6, surface_);
        });
    }

    std::vector<Vec3> complete_axis(const DirectionSmoother& smoother, std::size_t scale, bool first) const {
        std::vector<Vec3> axis(surface_.mesh.vertex_count());
        std::vector<float> confidence(axis.size());
        const FacesToVertices to_vertices(prepared_);
        for (std::size_t v = 0; v < axis.size(); ++v) {
            std::array<float, 6> covariance{};
            for (std::size_t k = 0; k < 6; ++k)
                covariance[k] = to_vertices.mean(v, [&](std::uint32_t f) { return covariances_[scale][f][k]; });
            const TensorAxes axes = tensor_axes(covariance, surface_.normals[v]);
            axis[v] = first ? axes.first : axes.second;
            confidence[v] = first ? axes.first_confidence : axes.second_confidence;
        }
        return smoother.complete(axis, confidence);
    }

    void keep_context() {
        const std::size_t faces = prepared_.face_count(), samples = prepared_.sample_count();
        float largest = 0;
        for (const float d : prepared_.distance) largest = std::isfinite(d) ? std::max(largest, d) : largest;
        const auto edges = log_bin_edges<k_context_ranges>(largest > 0 ? largest : 1);
        surface_.sample_face = prepared_.samples.face;
        surface_.sample_bin.assign(samples * faces, k_context_ranges);
        parallel_for(samples, [&](std::size_t s) {
            for (std::size_t f = 0; f < faces; ++f) {
                const float d = prepared_.distance[s * faces + f];
                if (!std::isfinite(d)) continue;
                std::uint8_t range = 0;
                while (range + 1 < k_context_ranges && edges[range + 1] <= d) ++range;
                surface_.sample_bin[s * faces + f] = range;
            }
        });
        surface_.face_sample.resize(faces);
        parallel_for(
            faces,
            [&](std::size_t f) {
                std::size_t nearest = 0;
                for (std::size_t s = 1; s < samples; ++s) {
                    if (prepared_.distance[s * faces + f] < prepared_.distance[nearest * faces + f]) nearest = s;
                }
                surface_.face_sample[f] = static_cast<std::uint32_t>(nearest);
            },
            256);
    }

    Stopwatch watch_;
    PreparedMesh prepared_;
    HatchingSurface surface_;
    std::vector<std::vector<std::array<float, 6>>> covariances_;
};

/// Rotates tangent directions with the faces: in each face around a vertex, expresses the direction by two edges
/// before the move, and combines the same edges after it; then takes the mean over the faces.
class TurningDirections {
  public:
    TurningDirections(const TriangleMesh& mesh, std::span<const Vec3> before) : mesh_(mesh), before_(before) {
        around_.resize(mesh.vertex_count());
        for (std::uint32_t f = 0; f < mesh.face_count(); ++f) {
            for (const std::uint32_t v : mesh.faces[f]) around_[v].push_back(f);
        }
    }

    void turn(std::span<Vec3> directions, std::span<const Vec3> normals) const {
        parallel_for(
            directions.size(),
            [&](std::size_t v) {
                Vec3 sum = Vec3::Zero();
                for (const std::uint32_t f : around_[v]) sum += turned(f, directions[v]);
                sum -= normals[v] * normals[v].dot(sum);
                directions[v] = sum.norm() > 0 ? Vec3(sum.normalized()) : Vec3(Vec3::Zero());
            },
            1024);
    }

  private:
    /// Returns the direction after the move, weighted by the area that the face had before.
    Vec3 turned(std::uint32_t f, const Vec3& direction) const {
        const auto& [a, b, c] = mesh_.faces[f];
        const Vec3 p = before_[b] - before_[a], q = before_[c] - before_[a], normal = p.cross(q);
        const float square = normal.squaredNorm();
        if (!(square > 0)) return Vec3::Zero();
        const float along_p = direction.cross(q).dot(normal) / square,
                    along_q = p.cross(direction).dot(normal) / square;
        const std::vector<Vec3>& now = mesh_.vertices;
        return std::sqrt(square) * (along_p * (now[b] - now[a]) + along_q * (now[c] - now[a]));
    }

    const TriangleMesh& mesh_;
    std::span<const Vec3> before_;
    std::vector<std::vector<std::uint32_t>> around_;
};

}  // namespace

std::vector<std::string> descriptor_names() {
    // The families of descriptors name their columns as they measure them, for all meshes alike.
    TriangleMesh mesh;
    mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    mesh.faces = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
    mesh.source_face_count = 4;
    return Measurement(mesh).descriptors().names;
}

HatchingSurface measure_surface(const TriangleMesh& mesh) {
    require_drawable(mesh, "mesh");
    return Measurement(mesh).run();
}

void move_surface(HatchingSurface& surface, std::span<const Vec3> vertices) {
    if (vertices.size() != surface.mesh.vertex_count())
        throw UsageError(fmt::format("a surface of {} vertices cannot move to {} places", surface.mesh.vertex_count(),
                                     vertices.size()));
    for (const Vec3& vertex : vertices)
        if (!vertex.allFinite()) throw MeshError("a vertex has moved to a place that is not finite");
    const std::vector<Vec3> before = std::exchange(surface.mesh.vertices, {vertices.begin(), vertices.end()});
    surface.normals = vertex_normals(surface.mesh);
    measure_curvature(surface, surface.feature_size);
    surface.occlusion = measure_self_occlusion(surface.mesh, surface.normals);
    const TurningDirections turning(surface.mesh, before);
    SurfaceDirections& directions = surface.directions;
    for (auto* axes : {&directions.e_a, &directions.e_b})
        for (std::vector<Vec3>& axis : *axes) turning.turn(axis, surface.normals);
    const DirectionSmoother smoother(surface.mesh, surface.normals);
    parallel_for(k_bending_fields, [&](std::size_t field) { complete_bending(smoother, field, surface); });
}

}  // namespace exemplar
