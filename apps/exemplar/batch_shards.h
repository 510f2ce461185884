#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "apps/exemplar/batch_work.h"

namespace exemplar {

/// How a batch run labels: the same for all programs that are at work on it, wherever they run.
struct BatchPlan {
    std::filesystem::path models;  ///< a model or a folder of models, absolute
    std::filesystem::path out;     ///< absolute
    std::string key;               ///< of the run: names the models' content and the options
    bool gltf = false, keep_small = false;
};

/// A part of a run's shapes, to be labeled anywhere that sees the same files: a text file, a line of JSON for the plan,
/// then one for each shape.
struct Shard {
    BatchPlan plan;
    std::vector<CatalogShape> shapes;
};

/// Divides the shapes that a run has still to label among `count` shards of about equal work (fewer if there are fewer
/// shapes): OUT/shards/NUMBER/1.shard and so on. Returns their paths, none if nothing is left. Throws DataError.
std::vector<std::filesystem::path> write_shards(CatalogRun& run, const BatchPlan& plan, std::size_t count);

/// Whether the file begins as a shard does.
bool is_shard(const std::filesystem::path& path);
/// Throws DataError: damaged, of another version, or with a shape whose results would lie outside the output folder.
Shard read_shard(const std::filesystem::path& path);

/// The shapes of a shard. A task that a cluster starts a second time begins at the other end: the first may still be at
/// work where its node has only lost touch, and so they meet in the middle.
class ShardWork final : public BatchWork {
  public:
    ShardWork(Shard shard, bool from_the_end);
    std::optional<CatalogShape> next() override;
    void finish(const BatchShape& shape, bool is_new) override;
    std::size_t total() override { return shard_.shapes.size(); }

  private:
    Shard shard_;
    std::size_t next_ = 0;
};

}  // namespace exemplar
