#pragma once

#include <filesystem>

#include "host/labeling/category/shape_descriptor.h"

namespace exemplar {

/// The descriptor of a mesh of any size, taken as it is labeled (see working_mesh), with a memory on disk: `folder`
/// keeps the descriptor, not the features, which take ten thousand times the room; but features that are there are
/// used. An empty folder turns the memory off. Throws what compute_features throws.
ShapeDescriptor cached_shape_descriptor(const TriangleMesh& mesh, const FeatureOptions& options,
                                        const std::filesystem::path& folder);

}  // namespace exemplar
