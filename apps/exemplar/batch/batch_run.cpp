#include "apps/exemplar/batch/batch_run.h"

#include <fmt/format.h>

#include <algorithm>

#include "host/core/interrupt.h"
#include "host/core/progress.h"
#include "host/core/stopwatch.h"
#include "host/core/text.h"

namespace exemplar {
namespace {

using Json = nlohmann::json;

Json describe_stage(const StageStatistics& stage) {
    return {{"stage", stage.name},   {"workers", stage.workers}, {"shapes", stage.items},
            {"calls", stage.groups}, {"busy", stage.busy},       {"load", stage.load}};
}

void print_stages(const std::vector<StageStatistics>& stages) {
    for (const StageStatistics& stage : stages)
        fmt::print("{:>10}: {} busy {:3.0f} % of the time, {:.3f} s per shape{}\n", stage.name,
                   counted(stage.workers, "worker"), 100 * stage.load,
                   stage.items ? stage.busy / static_cast<double>(stage.items) : 0.0,
                   stage.groups < stage.items ? fmt::format(", {:.1f} at a time", static_cast<double>(stage.items) /
                                                                                      static_cast<double>(stage.groups))
                                              : "");
}

/// Shows progress: shapes per second and the time left.
class BatchProgress {
  public:
    explicit BatchProgress(std::size_t total) : progress_("labeling", total) {}
    void advance(const std::string& name) {
        ++done_;
        progress_.advance(1, fmt::format("{:.1f} a second, {}", static_cast<double>(done_) / watch_.wall(), name));
    }
    void finish() { progress_.finish(); }

  private:
    Progress progress_;
    Stopwatch watch_;
    std::size_t done_ = 0;
};

}  // namespace

BatchResult run_work(BatchWork& work, const BatchWriter& writer, const BatchModels& models, DeviceBackend& backend,
                     const BatchOptions& options) {
    const Stopwatch watch;
    BatchResult result;
    BatchProgress progress(work.total());
    const auto next = [&] {
        check_interrupt();
        return work.next();
    };
    const auto write = [&](BatchShape& shape) {
        check_interrupt();
        const bool is_new = writer.write(shape);
        work.finish(shape, is_new);
        progress.advance(shape.shape.path.filename().string());
    };
    result.stages = label_batch(next, write, models, backend.labeling(), options);
    progress.finish();
    result.counts = work.counts();
    result.wall = watch.wall();
    result.cpu = watch.cpu();
    return result;
}

void print_result(const BatchResult& result) {
    const BatchCounts& counts = result.counts;
    fmt::print("{} labeled, {} of unknown category, {} failed in {} ({:.1f} a second)\n", counted(counts.done, "shape"),
               counts.unknown, counts.failed, format_seconds(result.wall),
               static_cast<double>(counts.all() - counts.taken_over) / std::max(result.wall, 1e-9));
    if (counts.taken_over > 0)
        fmt::print("{} of earlier or other programs taken over\n", counted(counts.taken_over, "result"));
    if (result.stages.empty() || counts.all() == counts.taken_over) return;
    print_stages(result.stages);
    const auto slowest = std::ranges::max_element(result.stages, {}, &StageStatistics::load);
    fmt::print("slowest stage: {}\n", slowest->name);
}

Json describe(const BatchResult& result) {
    Json stages = Json::array();
    for (const StageStatistics& stage : result.stages) stages.push_back(describe_stage(stage));
    const auto slowest = std::ranges::max_element(result.stages, {}, &StageStatistics::load);
    return {{"labeled", result.counts.done},
            {"unknown", result.counts.unknown},
            {"failed", result.counts.failed},
            {"taken_over", result.counts.taken_over},
            {"stages", stages},
            {"slowest_stage", slowest == result.stages.end() ? Json(nullptr) : Json(slowest->name)},
            {"seconds", {{"all", result.wall}, {"cpu", result.cpu}}}};
}

}  // namespace exemplar
