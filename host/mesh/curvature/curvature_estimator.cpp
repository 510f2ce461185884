#include "host/mesh/curvature/curvature_estimator.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "host/core/errors.h"
#include "host/core/memory_budget.h"
#include "host/core/parallel.h"
#include "host/core/statistics.h"
#include "host/mesh/curvature/face_fit.h"
#include "host/mesh/curvature/tensor_diffusion.h"

namespace exemplar {

namespace {

constexpr std::size_t k_estimator_grain = 4096;  // faces or vertices that one thread takes at a time

/// The corners at each vertex (3 x face + corner), in increasing order, as compressed rows: sums over a row give the
/// same bits on any number of threads.
struct CornerRows {
    std::vector<std::uint32_t> begin;  ///< V + 1 offsets
    std::vector<std::uint32_t> corner;
    std::span<const std::uint32_t> of(std::size_t v) const {
        return {corner.data() + begin[v], corner.data() + begin[v + 1]};
    }
};

CornerRows build_corner_rows(std::span<const Face> faces, std::size_t vertex_count) {
    CornerRows rows;
    rows.begin.assign(vertex_count + 1, 0);
    for (std::size_t f = 0; f < faces.size(); ++f)
        for (const std::uint32_t v : faces[f]) {
            if (v >= vertex_count)
                throw MeshError(
                    fmt::format("face {} names vertex {} of {}: give the mesh all its vertices", f, v, vertex_count));
            ++rows.begin[v + 1];
        }
    for (std::size_t v = 0; v < vertex_count; ++v) rows.begin[v + 1] += rows.begin[v];
    std::vector<std::uint32_t> next(rows.begin.begin(), rows.begin.end() - 1);
    rows.corner.resize(3 * faces.size());
    for (std::size_t f = 0; f < faces.size(); ++f)
        for (std::size_t i = 0; i < 3; ++i) rows.corner[next[faces[f][i]]++] = static_cast<std::uint32_t>(3 * f + i);
    return rows;
}

/// Data that only smoothing and robust fits need.
struct SmoothingData {
    VertexNeighbors neighbors;
    TensorDiffusion diffusion;
    std::unique_ptr<RobustFits> robust;
    std::vector<float> lengths;

    SmoothingData(std::span<const Face> faces, std::size_t vertex_count)
        : neighbors(build_vertex_neighbors(faces, vertex_count)), diffusion(neighbors, usable_memory() / 4) {
        lengths.reserve(neighbors.vertex.size() / 2);
    }
    double median_edge_length(std::span<const Vec3> vertices);
};

double SmoothingData::median_edge_length(std::span<const Vec3> vertices) {
    lengths.clear();
    for (std::size_t v = 0; v < vertices.size(); ++v)
        for (const std::uint32_t other : neighbors.of(v))
            if (other > v) lengths.push_back((vertices[other] - vertices[v]).squaredNorm());
    return std::sqrt(static_cast<double>(upper_median(lengths)));
}

}  // namespace

struct CurvatureEstimator::Parts {
    std::vector<Face> faces;
    CornerRows rows;
    std::unique_ptr<SmoothingData> surroundings;  ///< made when first needed
    std::vector<FaceFit> fits;
    std::vector<Form> face_forms;  ///< in the frames of the faces
    std::vector<FormDerivative> face_derivatives;
    std::vector<Vec3> normals;
    std::vector<TangentFrame> frames;
    std::vector<float> areas;
    std::vector<Form> forms;  ///< per vertex, in its frame; so are `derivatives`
    std::vector<FormDerivative> derivatives;
    VertexCurvature result;

    Parts(std::span<const Face> mesh_faces, std::size_t vertex_count)
        : faces(mesh_faces.begin(), mesh_faces.end()),
          rows(build_corner_rows(faces, vertex_count)),
          fits(faces.size()),
          face_forms(faces.size()),
          normals(vertex_count, Vec3::UnitZ()),
          frames(vertex_count),
          areas(vertex_count),
          forms(vertex_count) {
        result.k1.resize(vertex_count);
        result.k2.resize(vertex_count);
        result.e1.resize(vertex_count);
        result.e2.resize(vertex_count);
    }

    void check(std::span<const Vec3> vertices) const;
    SmoothingData& around();
    const RobustFits* robust_fits(const CurvatureOptions& options);
    TensorDiffusion* prepared_diffusion(std::span<const Vec3> vertices, const CurvatureOptions& options);
    void measure(std::span<const Vec3> vertices);
    void fit_forms();
    void fit_derivatives();
    void diagonalize(bool with_derivatives);
    template <typename Tensor>
    void average(const std::vector<Tensor>& of_faces, std::vector<Tensor>& sums) const;
};

void CurvatureEstimator::Parts::check(std::span<const Vec3> vertices) const {
    if (vertices.size() != normals.size())
        throw UsageError(
            fmt::format("{} vertices for a curvature estimator of {}: give it those of the mesh it was "
                        "made for",
                        vertices.size(), normals.size()));
}

SmoothingData& CurvatureEstimator::Parts::around() {
    if (!surroundings) surroundings = std::make_unique<SmoothingData>(faces, normals.size());
    return *surroundings;
}

/// Measures the faces, then the areas, normals and frames of the vertices.
void CurvatureEstimator::Parts::measure(std::span<const Vec3> vertices) {
    parallel_for(
        faces.size(),
        [&](std::size_t f) {
            const auto& [a, b, c] = faces[f];
            measure_face({vertices[a], vertices[b], vertices[c]}, fits[f]);
        },
        k_estimator_grain);
    parallel_for(
        vertices.size(),
        [&](std::size_t v) {
            Vec3d normal = Vec3d::Zero();
            float area = 0;
            for (const std::uint32_t corner : rows.of(v)) {
                const FaceFit& fit = fits[corner / 3];
                normal += static_cast<double>(fit.normal_weight[corner % 3]) * fit.normal;
                area += fit.corner_area[corner % 3];
            }
            normals[v] = unit_or_up(normal);
            frames[v] = frame_of_normal(normals[v]);
            areas[v] = area;
        },
        k_estimator_grain);
}

void CurvatureEstimator::Parts::fit_forms() {
    parallel_for(
        faces.size(),
        [&](std::size_t f) {
            FaceFit& fit = fits[f];
            if (!fit.valid) return;
            const Face& face = faces[f];
            face_forms[f] = fit_form(fit, {normals[face[0]], normals[face[1]], normals[face[2]]});
            for (std::size_t i = 0; i < 3; ++i) {
                const TangentFrame& there = frames[face[i]];
                fit.turn[i] = rotation_to(fit.frame, there.tangent, there.normal);
            }
        },
        k_estimator_grain);
    average(face_forms, forms);
}

void CurvatureEstimator::Parts::fit_derivatives() {
    face_derivatives.resize(faces.size());
    derivatives.resize(normals.size());
    parallel_for(
        faces.size(),
        [&](std::size_t f) {
            const FaceFit& fit = fits[f];
            if (!fit.valid) return;
            std::array<Form, 3> in_face;
            for (std::size_t i = 0; i < 3; ++i)
                in_face[i] = in_rotated_frame(forms[faces[f][i]], fit.turn[i].inverse());
            face_derivatives[f] = fit_derivative(fit, in_face);
        },
        k_estimator_grain);
    average(face_derivatives, derivatives);
}

/// Averages the faces' tensors at each vertex, weighted by corner area; zero without faces. Skips degenerate faces,
/// which have no tensor.
template <typename Tensor>
void CurvatureEstimator::Parts::average(const std::vector<Tensor>& of_faces, std::vector<Tensor>& sums) const {
    parallel_for(
        sums.size(),
        [&](std::size_t v) {
            Tensor sum{};
            for (const std::uint32_t corner : rows.of(v)) {
                const FaceFit& fit = fits[corner / 3];
                if (!fit.valid) continue;
                const Tensor there = in_rotated_frame(of_faces[corner / 3], fit.turn[corner % 3]);
                const float area = fit.corner_area[corner % 3];
                for (std::size_t k = 0; k < sum.size(); ++k) sum[k] += area * there[k];
            }
            const float scale = areas[v] > 0 ? 1 / areas[v] : 0.0f;
            for (float& s : sum) s *= scale;
            sums[v] = sum;
        },
        k_estimator_grain);
}

/// Rotates the forms and derivatives into the principal frames.
void CurvatureEstimator::Parts::diagonalize(bool with_derivatives) {
    result.derivative.resize(with_derivatives ? normals.size() : 0);
    parallel_for(
        normals.size(),
        [&](std::size_t v) {
            const TangentRotation turn = principal_rotation(forms[v], result.k1[v], result.k2[v]);
            const Vec3 &u = frames[v].tangent, &w = frames[v].bitangent;
            result.e1[v] = turn.cosine * u + turn.sine * w;
            result.e2[v] = turn.cosine * w - turn.sine * u;
            if (with_derivatives) result.derivative[v] = in_rotated_frame(derivatives[v], turn);
        },
        k_estimator_grain);
}

/// Returns null for plain least squares.
const RobustFits* CurvatureEstimator::Parts::robust_fits(const CurvatureOptions& options) {
    if (options.robust == RobustEstimator::none) return nullptr;
    if (!around().robust) around().robust = std::make_unique<RobustFits>(around().neighbors);
    return around().robust.get();
}

/// Returns null without smoothing.
TensorDiffusion* CurvatureEstimator::Parts::prepared_diffusion(std::span<const Vec3> vertices,
                                                               const CurvatureOptions& options) {
    if (!(options.smoothing > 0)) return nullptr;
    const double edge = around().median_edge_length(vertices);
    const double width = options.smoothing * (options.smoothing_unit > 0 ? options.smoothing_unit : edge);
    if (!(width > 0 && std::isfinite(width))) return nullptr;
    around().diffusion.prepare(vertices, frames, areas, width, enough_near_vertices(width / edge));
    return &around().diffusion;
}

CurvatureEstimator::CurvatureEstimator(std::span<const Face> faces, std::size_t vertex_count)
    : parts_(std::make_unique<Parts>(faces, vertex_count)) {}
CurvatureEstimator::~CurvatureEstimator() = default;
CurvatureEstimator::CurvatureEstimator(CurvatureEstimator&&) noexcept = default;
CurvatureEstimator& CurvatureEstimator::operator=(CurvatureEstimator&&) noexcept = default;

const VertexCurvature& CurvatureEstimator::estimate(std::span<const Vec3> vertices, const CurvatureOptions& options) {
    Parts& parts = *parts_;
    parts.check(vertices);
    if (!(options.smoothing >= 0 && std::isfinite(options.smoothing) && options.smoothing_unit >= 0 &&
          std::isfinite(options.smoothing_unit)))
        throw UsageError(fmt::format("smoothing by {} x {}: give a width that is finite and not negative",
                                     options.smoothing, options.smoothing_unit));
    parts.measure(vertices);
    parts.fit_forms();
    const RobustFits* const robust = parts.robust_fits(options);
    if (robust) robust->fit(vertices, parts.frames, options.robust, parts.forms);
    TensorDiffusion* const diffusion = parts.prepared_diffusion(vertices, options);
    if (diffusion) diffusion->apply(parts.forms);
    if (options.derivatives) {
        parts.fit_derivatives();
        if (robust) robust->fit(vertices, parts.frames, options.robust, parts.forms, parts.derivatives);
        if (diffusion) diffusion->apply(parts.derivatives);
    }
    parts.diagonalize(options.derivatives);
    return parts.result;
}

const std::vector<Vec3>& CurvatureEstimator::normals() const {
    return parts_->normals;
}

double CurvatureEstimator::median_edge_length(std::span<const Vec3> vertices) {
    parts_->check(vertices);
    return parts_->around().median_edge_length(vertices);
}

}  // namespace exemplar
