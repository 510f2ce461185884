#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "host/labeling/features/features.h"

namespace exemplar {

/// Returns the features of a mesh, from the cache in `folder` if they are there, otherwise from compute_features.
/// Entries are named by a hash of the mesh's content, the options and the feature version, so that equal meshes share
/// them whatever their names. An entry that is damaged, truncated or of another version is computed again and
/// replaced. An empty `folder` turns the cache off; a folder that cannot be written keeps no results. Throws what
/// compute_features throws.
MeshFeatures cached_features(const TriangleMesh& mesh, const FeatureOptions& options,
                             const std::filesystem::path& folder);

/// Returns the features in the cache; nullopt if there is no valid entry.
std::optional<MeshFeatures> find_cached_features(const TriangleMesh& mesh, const FeatureOptions& options,
                                                 const std::filesystem::path& folder);

/// Returns the file name of a mesh's features in the cache.
std::string feature_entry_name(const TriangleMesh& mesh, const FeatureOptions& options);

/// Returns the default folder of the cache, see default_cache_folder.
std::filesystem::path default_feature_folder();

}  // namespace exemplar
