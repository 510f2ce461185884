#include <algorithm>
#include <cmath>

#include "host/labeling/feature_families.h"

namespace exemplar {
namespace {

constexpr std::array<const char*, k_context_axes> k_axes{"principal0", "principal1", "principal2",
                                                         "symmetry0",  "symmetry1",  "symmetry2"};

}  // namespace

FeatureMatrix position_features(const PreparedMesh& prepared, const ContextGeometry& context) {
    FeatureMatrix matrix;
    matrix.rows = prepared.face_count();
    for (std::size_t axis = 0; axis < k_axes.size(); ++axis) {
        const std::span<const float> position(context.axis_position.data() + axis * matrix.rows, matrix.rows);
        float farthest = 0.0F;
        for (const float x : position) farthest = std::max(farthest, std::abs(x));
        const float per_farthest = farthest > 0.0F ? 1.0F / farthest : 0.0F;
        std::ranges::transform(position, matrix.add(std::string("position.") + k_axes[axis]).begin(),
                               [](float x) { return std::abs(x); });
        std::ranges::transform(position, matrix.add(std::string("position.") + k_axes[axis] + "/max").begin(),
                               [=](float x) { return std::abs(x) * per_farthest; });
    }
    std::ranges::transform(prepared.center, matrix.add("position.radius").begin(),
                           [](const Vec3& center) { return center.norm(); });
    return matrix;
}

}  // namespace exemplar
