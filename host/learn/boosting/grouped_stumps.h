#pragma once

#include <cstdint>
#include <vector>

#include "host/learn/boosting/boosted_stumps.h"

namespace exemplar {

/// The stumps of a classifier by the classes that share them, so that H is summed once for all classes of a group.
/// Within a group they are by feature, then by threshold; those that ask the same of the same feature are one, whose
/// answers are their sums: classifiers that are the mean of several have many of them.
struct GroupedStumps {
    struct Group {
        std::uint32_t first, end;  ///< its stumps
        std::uint64_t classes;     ///< see Stump
    };
    std::vector<Stump> stumps;
    std::vector<Group> groups;  ///< of distinct sets of classes

    explicit GroupedStumps(const BoostedStumps& classifier);
};

}  // namespace exemplar
