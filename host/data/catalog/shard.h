#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "host/data/catalog/catalog.h"

namespace exemplar {

/// The settings of a batch run, equal for all programs that work on it, wherever they run.
struct BatchPlan {
    std::filesystem::path models;  ///< a model or a folder of models, absolute
    std::filesystem::path out;     ///< absolute
    std::string key;               ///< key of the run, made from the models' content and the options
    bool gltf = false, keep_small = false;
};

/// A part of a run's shapes, to be labeled anywhere with access to the same files. In a text file: a line of JSON
/// for the plan, then one for each shape with all that labeling must know of it.
struct Shard {
    BatchPlan plan;
    std::vector<CatalogShape> shapes;
};

/// Writes a shard; throws DataError if that fails.
void write_shard(const std::filesystem::path& path, const Shard& shard);
/// Reads a shard; throws DataError if it is damaged, of another version, or has a shape whose results would lie
/// outside the output folder.
Shard read_shard(const std::filesystem::path& path);
/// Returns whether the file begins as a shard does.
bool is_shard(const std::filesystem::path& path);

}  // namespace exemplar
