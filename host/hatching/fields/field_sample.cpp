#include "host/hatching/fields/field_sample.h"

#include <cmath>

namespace exemplar {

float sample_hatched(const HatchingFields& fields, const std::vector<float>& values, const Vec2& at) {
    const float x = at.x() - 0.5f, y = at.y() - 0.5f;
    const int left = static_cast<int>(std::floor(x)), top = static_cast<int>(std::floor(y));
    float sum = 0, total = 0;
    for (int j = top; j <= top + 1; ++j)
        for (int i = left; i <= left + 1; ++i) {
            if (i < 0 || j < 0 || i >= fields.width || j >= fields.height) continue;
            const std::size_t pixel = fields.index(i, j);
            if (fields.level[pixel] == k_no_hatching) continue;
            const float weight = (1 - std::abs(x - static_cast<float>(i))) * (1 - std::abs(y - static_cast<float>(j)));
            sum += weight * values[pixel];
            total += weight;
        }
    return total > 0 ? sum / total : 0;
}

}  // namespace exemplar
