#pragma once

#include <array>
#include <cstddef>
#include <map>
#include <span>
#include <string>

#include "host/hatching/style/hatching_style.h"

namespace exemplar {

/// What features are selected for (thesis Figs. 4.15, 4.16).
enum class FeatureUse { orientation, level, thickness, intensity, spacing, length, segment };
constexpr std::size_t k_feature_uses = 7;
/// Returns "orientation" and so on.
const char* name_of(FeatureUse use);

/// Returns how often features of each type are among the first three that are selected for a use, as shares that sum to
/// 1, or nothing if none is. Types are those of the thesis, e.g. "k_max, k_min", "radial curvature", "shape contexts".
/// Styles count alike; within a style, the rules of orientation weigh as much as their segments have strokes, and the
/// first stage of the segments' cascade is asked, as later ones see contextual features first of all.
std::map<std::string, double> selected_features(std::span<const HatchingStyle> styles, FeatureUse use);

}  // namespace exemplar
