#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <string>
#include <vector>

#include "host/core/errors.h"
#include "host/data/corpus.h"
#include "host/labeling/inference/model.h"
#include "host/mesh/io/io.h"

namespace exemplar {

// What the user typed, checked before any long work: a wrong name should not cost the minutes of a training.

/// A check for options: a whole number from `least` to `most`.
CLI::Validator whole_number(std::uint64_t least, std::uint64_t most = std::numeric_limits<std::uint64_t>::max());

/// Throws DataError if nothing is at `path`, with the nearest name in its folder.
void require_input(const std::filesystem::path& path);
/// The meshes of a folder, a list or a mesh file (see list_meshes). Throws DataError if it is none of them.
std::vector<std::filesystem::path> meshes_of_argument(const std::filesystem::path& source,
                                                      MissingMeshes missing = MissingMeshes::refused);
/// The same of several sources; a mesh that is in more than one comes once.
std::vector<std::filesystem::path> meshes_of_arguments(const std::vector<std::filesystem::path>& sources);
/// What is unusual about a mesh read from `path`, a line each, and how it is worked around; printed unless `quiet`.
/// Throws MeshError if it cannot be labeled.
std::vector<std::string> mesh_warnings(const MeshFile& file, const std::filesystem::path& path, bool quiet);
/// Calls `work`, which works on a mesh read from `path`. Throws MeshError that begins with it.
template <typename Work>
auto of_file(const std::filesystem::path& path, Work&& work) {
    try {
        return work();
    } catch (const MeshError& error) {
        throw MeshError(path.string() + ": " + error.what());
    }
}
/// load_model for a file that may be anything; throws ModelError saying what makes a model.
LabelingModel model_of_argument(const std::filesystem::path& path);
/// Throws UsageError if a file, or a folder of files, cannot be written at `path`. An empty path is no output.
void require_output_file(const std::filesystem::path& path);
void require_output_folder(const std::filesystem::path& path);
/// Throws UsageError unless a picture can be written at `path`, whose name ends in .png.
void require_output_picture(const std::filesystem::path& path);
/// Throws UsageError if writing `out` would replace one of the files that are read.
void require_not_replaced(const std::filesystem::path& out, const std::vector<std::filesystem::path>& inputs);
/// The folder that remembers features, or what else it is to remember; empty, with a warning, where it cannot be
/// written. Empty, too, if nothing is to be remembered, and throws UsageError for a wrong bound (see cache_bound).
std::filesystem::path usable_cache(const std::filesystem::path& cache, bool quiet, const char* what = "features");
/// Results beside a mesh could replace the labels, or the mesh, that they were made from: throws UsageError if a mesh
/// lies in the folder `out`.
void require_other_folder(const std::filesystem::path& out, const std::vector<std::filesystem::path>& meshes);
/// Results are named after the mesh: throws UsageError naming two meshes that would write the same files.
void require_distinct_names(const std::vector<std::filesystem::path>& meshes);

}  // namespace exemplar
