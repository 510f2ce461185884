#pragma once

#include <filesystem>
#include <vector>

#include "apps/exemplar/batch/batch_work.h"
#include "host/data/catalog/shard.h"

namespace exemplar {

/// Divides the remaining shapes of a run among `count` shards of about equal work (fewer if there are fewer shapes):
/// OUT/shards/NUMBER/1.shard and so on. Returns their paths; none if no shape is left. Throws DataError.
std::vector<std::filesystem::path> write_shards(CatalogRun& run, const BatchPlan& plan, std::size_t count);

/// The shapes of a shard. A task that a cluster has restarted begins at the end: the first copy may still be running
/// if its node has only lost its connection, so both meet in the middle.
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
