#include <algorithm>

#include "host/core/parallel.h"
#include "host/labeling/features/feature_families.h"
#include "host/shape/sample_cells.h"

namespace exemplar {
namespace {

constexpr std::array<double, 3> k_radii{0.1, 0.2, 0.4};

bool is_averaged(const std::string& name) {
    if (name.find('/') != std::string::npos) return false;
    return name == "geodesic.mean" || name.starts_with("diameter.mean@") || name.starts_with("medial.median@") ||
           name == "curvature.k1@0.1" || name == "curvature.k2@0.1";
}

/// Returns the columns' values at the samples, samples x columns: the face of a sample represents its cell.
std::vector<float> values_at_samples(const PreparedMesh& prepared, const FeatureMatrix& unary,
                                     const std::vector<std::size_t>& source) {
    std::vector<float> values;
    values.reserve(prepared.sample_count() * source.size());
    for (const std::uint32_t face : prepared.samples.face)
        for (const std::size_t column : source) values.push_back(unary.column(column)[face]);
    return values;
}

/// Sums over one face's region: weight and weighted values.
struct RegionSums {
    double weight = 0.0;
    std::vector<double> values;
};

/// Adds the samples near a face to the sums of all radii.
void add_region_samples(const PreparedMesh& prepared, std::span<const float> distance,
                        std::span<const float> cell_radius, std::span<const float> values,
                        std::array<RegionSums, k_radii.size()>& regions) {
    const std::size_t columns = regions[0].values.size();
    for (std::size_t s = 0; s < distance.size(); ++s) {
        SampleCell cell;
        cell.radius = cell_radius[s];
        for (std::size_t r = k_radii.size(); r-- > 0;) {
            const float limit = static_cast<float>(k_radii[r]) * prepared.median_distance;
            const float share = cell.share_within(distance[s], limit);
            if (!(share > 0.0F)) break;  // the smaller regions are inside this one
            const double weight = static_cast<double>(share * prepared.samples.area_share[s]);
            regions[r].weight += weight;
            for (std::size_t k = 0; k < columns; ++k)
                regions[r].values[k] += weight * static_cast<double>(values[s * columns + k]);
        }
    }
}

}  // namespace

FeatureMatrix region_features(const PreparedMesh& prepared, const FeatureMatrix& unary) {
    std::vector<std::size_t> source;
    for (std::size_t k = 0; k < unary.cols(); ++k)
        if (is_averaged(unary.names[k])) source.push_back(k);
    FeatureMatrix matrix;
    matrix.rows = unary.rows;
    for (const double radius : k_radii)
        for (const std::size_t k : source) {
            matrix.add(at_radius("region.mean." + unary.names[k], radius));
            matrix.add(at_radius("region.difference." + unary.names[k], radius));
        }
    const std::vector<float> values = values_at_samples(prepared, unary, source);
    const std::vector<float> cell_radius = sample_cell_radii(prepared);
    const std::size_t samples = prepared.sample_count();
    parallel_ranges(matrix.rows, 64, [&](std::size_t begin, std::size_t end) {
        std::vector<float> distance;
        gather_distances(prepared, begin, end, distance);
        std::array<RegionSums, k_radii.size()> regions;
        for (std::size_t f = begin; f < end; ++f) {
            for (RegionSums& region : regions) region = {0.0, std::vector<double>(source.size(), 0.0)};
            const std::span<const float> of_face(distance.data() + (f - begin) * samples, samples);
            add_region_samples(prepared, of_face, cell_radius, values, regions);
            std::size_t column = 0;
            for (const RegionSums& region : regions)
                for (std::size_t k = 0; k < source.size(); ++k) {
                    const float own = unary.column(source[k])[f];
                    const float mean = region.weight > 0.0 ? static_cast<float>(region.values[k] / region.weight) : own;
                    matrix.column(column++)[f] = mean;
                    matrix.column(column++)[f] = own - mean;
                }
        }
    });
    return matrix;
}

}  // namespace exemplar
