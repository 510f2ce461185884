#pragma once

namespace exemplar {

/// What model files say of themselves (docs/formats.md).
constexpr const char* k_model_kind = "exemplar curvature";
constexpr int k_model_version = 3;

}  // namespace exemplar
