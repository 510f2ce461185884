#include "host/learn/boosting/grouped_stumps.h"

#include <algorithm>
#include <tuple>

namespace exemplar {
namespace {

/// Returns whether two stumps can be merged into one.
bool asks_the_same(const Stump& a, const Stump& b) {
    return a.classes == b.classes && a.feature == b.feature && a.threshold == b.threshold;
}

std::vector<Stump> merged(std::vector<Stump> stumps) {
    const auto key = [](const Stump& stump) { return std::tuple(stump.classes, stump.feature, stump.threshold); };
    std::ranges::stable_sort(stumps, [&](const Stump& a, const Stump& b) { return key(a) < key(b); });
    std::vector<Stump> result;
    for (const Stump& stump : stumps) {
        if (result.empty() || !asks_the_same(result.back(), stump)) {
            result.push_back(stump);
        } else {
            result.back().above += stump.above;
            result.back().below += stump.below;
        }
    }
    return result;
}

}  // namespace

GroupedStumps::GroupedStumps(const BoostedStumps& classifier) : stumps(merged(classifier.stumps)) {
    for (std::uint32_t m = 0; m < stumps.size(); ++m) {
        if (groups.empty() || groups.back().classes != stumps[m].classes) groups.push_back({m, m, stumps[m].classes});
        ++groups.back().end;
    }
}

}  // namespace exemplar
