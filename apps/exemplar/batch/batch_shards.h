#pragma once

#include <filesystem>
#include <vector>

#include "apps/exemplar/batch/batch_work.h"
#include "host/data/catalog/shard.h"

namespace exemplar {

/// Divides the shapes that a run has still to label among `count` shards of about equal work (fewer if there are fewer
/// shapes): OUT/shards/NUMBER/1.shard and so on. Returns their paths, none if nothing is left. Throws DataError.
std::vector<std::filesystem::path> write_shards(CatalogRun& run, const BatchPlan& plan, std::size_t count);

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
