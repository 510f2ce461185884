#pragma once

#include <cstdint>
#include <vector>

#include "host/learn/boosting/boosted_stumps.h"

namespace exemplar {

/// The stumps of a classifier, grouped by the classes that share them, so that H is summed once for all classes of a
/// group. In a group they are sorted by feature, then by threshold. Stumps with the same classes, feature and
/// threshold are merged into one, whose responses are their sums: classifiers that are the mean of several have many
/// of them.
struct GroupedStumps {
    struct Group {
        std::uint32_t first, end;  ///< range of its stumps
        std::uint64_t classes;     ///< see Stump
    };
    std::vector<Stump> stumps;
    std::vector<Group> groups;  ///< one per distinct set of classes

    explicit GroupedStumps(const BoostedStumps& classifier);
};

}  // namespace exemplar
