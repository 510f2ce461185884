#pragma once

#include <filesystem>
#include <vector>

namespace exemplar {

/// Returns the folder itself if it holds meshes, as its subfolders may be results of a model. Otherwise returns its
/// subfolders with labeled meshes, or with any meshes if `labels` names another folder of labels. Throws UsageError
/// if `folder` is no folder.
std::vector<std::filesystem::path> category_folders(const std::filesystem::path& folder,
                                                    const std::filesystem::path& labels = {});

/// Returns an absolute path whose last part is a name.
std::filesystem::path without_trailing_slash(const std::filesystem::path& path);

}  // namespace exemplar
