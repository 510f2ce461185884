#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "host/core/errors.h"
#include "host/data/corpus.h"
#include "host/labeling/inference/model.h"
#include "host/mesh/io/io.h"

namespace exemplar {

// Checks of arguments before any long work, so that a wrong name does not cost the minutes of a training.

/// Throws DataError, with the nearest name in the folder, if there is nothing at `path`.
void require_input(const std::filesystem::path& path);
/// Returns the meshes of a folder, a list or a mesh file (see list_meshes). Throws DataError if it is none of these.
std::vector<std::filesystem::path> meshes_of_argument(const std::filesystem::path& source,
                                                      MissingMeshes missing = MissingMeshes::refused);
/// The same for several sources; a mesh that is in more than one is listed once.
std::vector<std::filesystem::path> meshes_of_arguments(const std::vector<std::filesystem::path>& sources);
/// Returns a line for each defect of a mesh read from `path` and its workaround; prints them unless `quiet`. Throws
/// MeshError if the mesh cannot be labeled.
std::vector<std::string> mesh_warnings(const MeshFile& file, const std::filesystem::path& path, bool quiet);
/// Returns the result of `work` on a mesh read from `path`. Puts `path` in front of the message of a MeshError.
template <typename Work>
auto of_file(const std::filesystem::path& path, Work&& work) {
    try {
        return work();
    } catch (const MeshError& error) {
        throw MeshError(path.string() + ": " + error.what());
    }
}
/// Loads a model; throws ModelError, which tells how to make a model, if the file is none.
LabelingModel model_of_argument(const std::filesystem::path& path);
/// Throws UsageError if a file, or a folder of files, cannot be written at `path`. An empty path is no output.
void require_output_file(const std::filesystem::path& path);
void require_output_folder(const std::filesystem::path& path);
/// Throws UsageError unless a picture can be written at `path`, whose name ends in .png.
void require_output_picture(const std::filesystem::path& path);
/// Throws UsageError if writing `out` would replace one of the files that are read.
void require_not_replaced(const std::filesystem::path& out, const std::vector<std::filesystem::path>& inputs);
/// Returns the cache folder for features, or for `what`. Empty if caching is off, or if the folder cannot be written
/// (with a warning, unless `quiet`). Throws UsageError for a wrong bound (see cache_bound).
std::filesystem::path usable_cache(const std::filesystem::path& cache, bool quiet, const char* what = "features");
/// Throws UsageError if a mesh lies in the folder `out`, as results there could replace the mesh or its labels.
void require_other_folder(const std::filesystem::path& out, const std::vector<std::filesystem::path>& meshes);
/// Throws UsageError, naming two meshes, if their results, which are named after the mesh, would be the same files.
void require_distinct_names(const std::vector<std::filesystem::path>& meshes);

}  // namespace exemplar
