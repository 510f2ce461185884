#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "host/core/parallel.h"
#include "host/shape/log_bins.h"
#include "host/shape/sample_cells.h"
#include "host/shape/shape_families.h"

namespace exemplar {
namespace {

constexpr std::size_t k_rings = ShapeContextFamily::k_rings, k_sectors = ShapeContextFamily::k_sectors;

/// Rings that are summed over all faces, as they hold too few samples. They are about as wide as the other families'
/// searches.
constexpr std::size_t k_near_rings = 3;

/// Arc cosine to within 7e-5 (Abramowitz & Stegun 4.4.45); the compiler vectorizes it.
inline float fast_acos(float x) {
    const float y = std::abs(x);
    const float angle =
        std::sqrt(std::max(1.0F - y, 0.0F)) * (1.5707288F + y * (-0.2121144F + y * (0.0742610F - 0.0187293F * y)));
    return x < 0.0F ? std::numbers::pi_v<float> - angle : angle;
}

/// Returns the position of the angle between `normal` and `offset` among the sectors' centers, in [-0.5, k_sectors -
/// 0.5]. The face itself (offset zero) is at a right angle, in its own plane.
inline float sector_position(float nx, float ny, float nz, float x, float y, float z) {
    const float square = x * x + y * y + z * z;
    const float cosine = square > 1e-20F ? (nx * x + ny * y + nz * z) / std::sqrt(square) : 0.0F;
    return fast_acos(cosine) * (static_cast<float>(k_sectors) / std::numbers::pi_v<float>)-0.5F;
}

/// Adds to a ring's sectors. The two nearest sectors share the weight: flat surfaces lie exactly on the edge between
/// two, and rounding must not decide between them.
inline void add_to_sectors(float* ring, float position, float weight) {
    const float lower = std::floor(position), upper_share = position - lower;
    const int sector = static_cast<int>(lower), last = static_cast<int>(k_sectors) - 1;
    ring[std::max(sector, 0)] += weight * (1.0F - upper_share);
    ring[std::min(sector + 1, last)] += weight * upper_share;
}

/// Sums fine bins to `rings` x `sectors` coarse ones, one column each.
void add_histogram(FeatureMatrix& matrix, const std::vector<float>& fine, std::size_t rings, std::size_t sectors) {
    const std::size_t first = matrix.cols(), per_ring = k_rings / rings, per_sector = k_sectors / sectors;
    for (std::size_t r = 0; r < rings; ++r) {
        for (std::size_t a = 0; a < sectors; ++a)
            matrix.add(fmt::format("shape_context.{}x{}.d{}a{}", rings, sectors, r, a));
    }
    parallel_for(
        matrix.rows,
        [&](std::size_t f) {
            const float* bins = fine.data() + f * k_rings * k_sectors;
            for (std::size_t k = 0; k < rings * sectors; ++k) {
                const std::size_t r = k / sectors, a = k % sectors;
                float sum = 0.0F;
                for (std::size_t i = r * per_ring; i < (r + 1) * per_ring; ++i) {
                    for (std::size_t j = a * per_sector; j < (a + 1) * per_sector; ++j) sum += bins[i * k_sectors + j];
                }
                matrix.column(first + k)[f] = sum;
            }
        },
        64);
}

/// Sample centers as arrays, for vector loops.
struct SampleArrays {
    std::vector<float> x, y, z, weight, radius;
    explicit SampleArrays(const PreparedMesh& prepared)
        : weight(prepared.samples.area_share), radius(sample_cell_radii(prepared)) {
        for (const std::uint32_t face : prepared.samples.face) {
            x.push_back(prepared.center[face].x());
            y.push_back(prepared.center[face].y());
            z.push_back(prepared.center[face].z());
        }
    }
};

/// Adds the share of a sample's cell in each ring beyond `near`: the cell covers distances within its radius.
void add_sample(float* bins, const std::array<float, k_rings + 1>& edges, float near, float distance, float radius,
                float position, float weight) {
    const float low = std::max(distance - radius, near), high = distance + radius;
    std::size_t ring = 0;
    while (ring < k_rings && edges[ring + 1] <= low) ++ring;
    if (ring == k_rings) return;
    if (radius == 0.0F) {
        if (distance >= near) add_to_sectors(bins + ring * k_sectors, position, weight);
        return;
    }
    for (; ring < k_rings && edges[ring] < high; ++ring) {
        const float covered = std::min(high, edges[ring + 1]) - std::max(low, edges[ring]);
        if (covered > 0.0F) add_to_sectors(bins + ring * k_sectors, position, weight * covered / (2.0F * radius));
    }
}

}  // namespace

ShapeContextFamily::ShapeContextFamily(const PreparedMesh& prepared)
    : prepared_(&prepared),
      edges_(log_bin_edges<k_rings>(prepared.far_distance)),
      near_radius_(prepared.samples_are_all_faces() ? 0.0F : edges_[k_near_rings]),
      near_(prepared.face_count(), near_radius_),
      fine_(prepared.face_count() * k_rings * k_sectors, 0.0F) {}

void ShapeContextFamily::measure(std::uint32_t face, Neighborhood neighborhood) {
    float* bins = fine_.data() + face * k_rings * k_sectors;
    const Vec3 &normal = prepared_->normal[face], &center = prepared_->center[face];
    near_[face] = std::min(near_radius_, neighborhood.complete_distance);
    std::size_t ring = 0;
    for (const auto& [near, distance] : neighborhood.faces) {
        if (distance >= near_[face]) break;
        while (edges_[ring + 1] <= distance) ++ring;
        const Vec3 offset = prepared_->center[near] - center;
        const float position = sector_position(normal.x(), normal.y(), normal.z(), offset.x(), offset.y(), offset.z());
        add_to_sectors(bins + ring * k_sectors, position, prepared_->area_share[near]);
    }
}

void ShapeContextFamily::measure_far() {
    const SampleArrays samples(*prepared_);
    const std::size_t count = samples.x.size();
    parallel_ranges(prepared_->face_count(), 64, [&](std::size_t begin, std::size_t end) {
        std::vector<float> distance, position(count);
        gather_distances(*prepared_, begin, end, distance);
        for (std::size_t f = begin; f < end; ++f) {
            const float nx = prepared_->normal[f].x(), ny = prepared_->normal[f].y(), nz = prepared_->normal[f].z();
            const float cx = prepared_->center[f].x(), cy = prepared_->center[f].y(), cz = prepared_->center[f].z();
            for (std::size_t s = 0; s < count; ++s) {
                position[s] = sector_position(nx, ny, nz, samples.x[s] - cx, samples.y[s] - cy, samples.z[s] - cz);
            }
            float* bins = fine_.data() + f * k_rings * k_sectors;
            const float* of_face = distance.data() + (f - begin) * count;
            for (std::size_t s = 0; s < count; ++s) {
                add_sample(bins, edges_, near_[f], of_face[s], samples.radius[s], position[s], samples.weight[s]);
            }
        }
    });
}

FeatureMatrix ShapeContextFamily::take() {
    FeatureMatrix matrix;
    matrix.rows = prepared_->face_count();
    for (const std::size_t rings : {5U, 10U}) {
        for (const std::size_t sectors : {4U, 6U, 8U}) add_histogram(matrix, fine_, rings, sectors);
    }
    fine_ = {};
    return matrix;
}

FeatureMatrix ShapeContextFamily::take(std::size_t rings, std::size_t sectors) {
    FeatureMatrix matrix;
    matrix.rows = prepared_->face_count();
    add_histogram(matrix, fine_, rings, sectors);
    fine_ = {};
    return matrix;
}

}  // namespace exemplar
