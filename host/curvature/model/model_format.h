#pragma once

namespace exemplar {

/// Kind and format version in the metadata of a model file (docs/formats.md).
constexpr const char* k_model_kind = "exemplar curvature";
constexpr int k_model_version = 3;

}  // namespace exemplar
