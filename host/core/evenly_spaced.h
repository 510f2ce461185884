#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace exemplar {

/// Returns at most `count` of the items, evenly spaced in their order, the first one included.
template <typename T>
std::vector<T> evenly_spaced(const std::vector<T>& items, std::size_t count) {
    count = std::min(count, items.size());
    std::vector<T> chosen;
    chosen.reserve(count);
    for (std::size_t i = 0; i < count; ++i) chosen.push_back(items[i * items.size() / count]);
    return chosen;
}

}  // namespace exemplar
