#pragma once

#include <cstddef>
#include <optional>
#include <vector>

namespace exemplar {

/// The measured points nearest to a point along a line, before and behind it, and its place between them.
struct MeasuredNeighbors {
    std::size_t before = 0, behind = 0;
    float share = 0;  ///< 0: at `before`, 1: at `behind`
};

/// Calls body(i, between) for each point that was not measured. Beyond the outermost measured points, `before`
/// equals `behind`. Does nothing if none was measured.
template <typename Body>
void for_each_unmeasured(const std::vector<bool>& measured, Body&& body) {
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
                 MeasuredNeighbors{start, far,
                                   far == start ? 0 : static_cast<float>(i - start) / static_cast<float>(far - start)});
        --i;
    }
}

}  // namespace exemplar
