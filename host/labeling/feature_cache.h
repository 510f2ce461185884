#pragma once

#include <filesystem>

#include "host/labeling/features.h"

namespace exemplar {

/// compute_features with a memory on disk: results are kept in `folder` under a hash of the mesh's content, the options
/// and the feature version, so that equal meshes share them whatever their names. An entry that is damaged, truncated
/// or of another version is computed again and replaced. An empty folder turns the memory off; one that cannot be
/// written is as if empty. Throws what compute_features throws.
MeshFeatures cached_features(const TriangleMesh& mesh, const FeatureOptions& options,
                             const std::filesystem::path& folder);

/// The folder used by default, see default_cache_folder.
std::filesystem::path default_feature_folder();

}  // namespace exemplar
