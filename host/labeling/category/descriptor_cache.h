#pragma once

#include <filesystem>

#include "host/labeling/category/shape_descriptor.h"

namespace exemplar {

/// Returns the descriptor of a mesh of any size, computed on its working mesh (see working_mesh), and caches it in
/// `folder`. Only the descriptor is cached, as features take ten thousand times the space; but cached features are
/// used if they exist. An empty `folder` turns the cache off. Throws what compute_features throws.
ShapeDescriptor cached_shape_descriptor(const TriangleMesh& mesh, const FeatureOptions& options,
                                        const std::filesystem::path& folder);

}  // namespace exemplar
