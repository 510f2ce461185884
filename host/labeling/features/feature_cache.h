#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "host/labeling/features/features.h"

namespace exemplar {

/// compute_features with a memory on disk: results are kept in `folder` under a hash of the mesh's content, the options
/// and the feature version, so that equal meshes share them whatever their names. An entry that is damaged, truncated
/// or of another version is computed again and replaced. An empty folder turns the memory off; one that cannot be
/// written is as if empty. Throws what compute_features throws.
MeshFeatures cached_features(const TriangleMesh& mesh, const FeatureOptions& options,
                             const std::filesystem::path& folder);

/// What cached_features has kept; empty if there is nothing, or nothing whole.
std::optional<MeshFeatures> remembered_features(const TriangleMesh& mesh, const FeatureOptions& options,
                                                const std::filesystem::path& folder);

/// The name of the file in which a folder remembers the features of a mesh.
std::string feature_entry_name(const TriangleMesh& mesh, const FeatureOptions& options);

/// The folder used by default, see default_cache_folder.
std::filesystem::path default_feature_folder();

}  // namespace exemplar
