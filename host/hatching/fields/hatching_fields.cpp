#include "host/hatching/fields/hatching_fields.h"

#include <cmath>
#include <numbers>

namespace exemplar {

HatchingFields::HatchingFields(int image_width, int image_height) : width(image_width), height(image_height) {
    level.resize(size());
    for (auto* values : {&orientation[0], &orientation[1], &thickness, &intensity, &spacing, &length})
        values->resize(size());
}

float orientation_difference(float first, float second) {
    constexpr float k_pi = std::numbers::pi_v<float>;
    return std::abs(std::remainder(first - second, k_pi));
}

}  // namespace exemplar
