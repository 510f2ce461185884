#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "host/data/catalog/catalog.h"

namespace exemplar {

/// How a batch run labels: the same for all programs that are at work on it, wherever they run.
struct BatchPlan {
    std::filesystem::path models;  ///< a model or a folder of models, absolute
    std::filesystem::path out;     ///< absolute
    std::string key;               ///< of the run: names the models' content and the options
    bool gltf = false, keep_small = false;
};

/// A part of a run's shapes, to be labeled anywhere that sees the same files: a text file, a line of JSON for the plan,
/// then one for each shape, with what labeling has to know of it.
struct Shard {
    BatchPlan plan;
    std::vector<CatalogShape> shapes;
};

/// Throws DataError where it cannot write.
void write_shard(const std::filesystem::path& path, const Shard& shard);
/// Throws DataError: damaged, of another version, or with a shape whose results would lie outside the output folder.
Shard read_shard(const std::filesystem::path& path);
/// Whether the file begins as a shard does.
bool is_shard(const std::filesystem::path& path);

}  // namespace exemplar
