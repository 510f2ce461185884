#pragma once

#include <cstddef>
#include <optional>
#include <vector>

namespace exemplar {

/// For each of some points along a line the nearest measured ones before and behind it, and how far between it is.
struct BetweenMeasured {
    std::size_t before = 0, behind = 0;
    float share = 0;  ///< 0: at `before`, 1: at `behind`
};

/// Calls body(i, between) for each point that was not measured; beyond the outermost measured ones `before` is
/// `behind`. Calls nothing if none was measured.
template <typename Body>
void between_measured(const std::vector<bool>& measured, Body&& body) {
    std::optional<std::size_t> before;
    for (std::size_t i = 0; i < measured.size(); ++i) {
        if (measured[i]) {
            before = i;
            continue;
        }
        std::size_t behind = i;
        while (behind < measured.size() && !measured[behind]) ++behind;
        const bool last = behind == measured.size();
        if (last && !before) return;
        const std::size_t end = behind, start = before.value_or(end);
        const std::size_t far = last ? start : end;
        for (; i < end; ++i)
            body(i,
                 BetweenMeasured{start, far,
                                 far == start ? 0 : static_cast<float>(i - start) / static_cast<float>(far - start)});
        --i;
    }
}

}  // namespace exemplar
