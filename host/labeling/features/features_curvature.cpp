#include <algorithm>
#include <cmath>

#include "host/labeling/features/cubic_patch.h"
#include "host/labeling/features/feature_families.h"

namespace exemplar {
namespace {

constexpr std::array<const char*, 9> k_functions{"k1",      "|k1|", "k2",     "|k2|", "k1*k2",
                                                 "|k1*k2|", "mean", "|mean|", "k1-k2"};

std::array<float, 9> curvature_functions(float k1, float k2) {
    const float mean = 0.5F * (k1 + k2);
    return {k1, std::abs(k1), k2, std::abs(k2), k1 * k2, std::abs(k1 * k2), mean, std::abs(mean), k1 - k2};
}

}  // namespace

CurvatureFamily::CurvatureFamily(const PreparedMesh& prepared) : prepared_(&prepared) {
    unary_.rows = prepared.face_count();
    for (const double radius : k_radii) {
        for (const char* function : k_functions) unary_.add(at_radius(std::string("curvature.") + function, radius));
    }
    for (auto& values : pairwise_) values.resize(prepared.face_count());
}

float CurvatureFamily::radius() const {
    return static_cast<float>(k_radii.back()) * prepared_->median_distance;
}

void CurvatureFamily::measure(std::uint32_t face, Neighborhood neighborhood) {
    const float median = prepared_->median_distance;
    // No patch resolves radii of curvature far below its own radius. Such values come from folds and would dwarf all
    // others.
    const float limit = 2.0F / (static_cast<float>(k_radii.front()) * median);
    CubicPatch patch(prepared_->center[face], prepared_->normal[face], radius());
    std::size_t added = 0;
    const auto patch_of = [&](double share) {
        const std::size_t end = count_within(neighborhood, static_cast<float>(share) * median, k_min_patch_faces);
        for (; added < end; ++added) {
            const std::uint32_t near = neighborhood.faces[added].face;
            patch.add(prepared_->center[near], prepared_->normal[near], prepared_->area_share[near]);
        }
        PatchCurvature result = patch.solve();
        result.k1 = std::clamp(result.k1, -limit, limit);
        result.k2 = std::clamp(result.k2, -limit, limit);
        result.dk1 = std::min(result.dk1, limit * limit);
        result.dk2 = std::min(result.dk2, limit * limit);
        return result;
    };
    const auto write_pairwise = [&](std::size_t scale, const PatchCurvature& p) {
        pairwise_[scale][face] = {p.k1, p.k2, p.dk1, p.dk2};
    };
    const auto write_unary = [&](std::size_t scale, const PatchCurvature& p) {
        const auto values = curvature_functions(p.k1, p.k2);
        for (std::size_t k = 0; k < values.size(); ++k) unary_.column(scale * values.size() + k)[face] = values[k];
    };
    // Radii in rising order, as a patch only grows: 0.5, 1, 2, 4, 5 and 10%.
    write_pairwise(0, patch_of(k_pairwise_radii[0]));
    for (std::size_t scale = 0; scale < 2; ++scale) {
        const PatchCurvature shared = patch_of(k_radii[scale]);
        write_unary(scale, shared);
        write_pairwise(scale + 1, shared);
    }
    write_pairwise(3, patch_of(k_pairwise_radii[3]));
    for (std::size_t scale = 2; scale < 4; ++scale) write_unary(scale, patch_of(k_radii[scale]));
}

}  // namespace exemplar
