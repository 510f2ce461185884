#pragma once

#include <array>
#include <string_view>

#include "host/core/random.h"
#include "host/synth/modeling/sculptor.h"

namespace exemplar {

// One function per kind of shape. Part indices are positions in the list of names above it.

constexpr std::array<std::string_view, 9> k_human_parts{"head", "neck",      "torso",     "upper_arm", "lower_arm",
                                                        "hand", "upper_leg", "lower_leg", "foot"};
ShapeModel sculpt_human(Random& random);

constexpr std::array<std::string_view, 6> k_fourleg_parts{"head", "neck", "torso", "leg", "tail", "ear"};
ShapeModel sculpt_fourleg(Random& random);

constexpr std::array<std::string_view, 2> k_cup_parts{"body", "handle"};
ShapeModel sculpt_cup(Random& random);

constexpr std::array<std::string_view, 3> k_chair_parts{"seat", "back", "leg"};
ShapeModel sculpt_chair(Random& random);

constexpr std::array<std::string_view, 2> k_table_parts{"top", "leg"};
ShapeModel sculpt_table(Random& random);

constexpr std::array<std::string_view, 2> k_octopus_parts{"head", "tentacle"};
ShapeModel sculpt_octopus(Random& random);

constexpr std::array<std::string_view, 3> k_glasses_parts{"frame", "lens", "temple"};
ShapeModel sculpt_glasses(Random& random);

}  // namespace exemplar
