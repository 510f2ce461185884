#include "apps/exemplar/batch/batch_shards.h"

#include <fmt/format.h>

#include <algorithm>

#include "host/core/errors.h"
#include "host/core/interrupt.h"
#include "host/data/catalog/shape_record.h"
#include "host/data/catalog/shape_scan.h"

namespace exemplar {
namespace {

namespace fs = std::filesystem;

/// Estimates the cost of labeling, in faces: each shape has a fixed cost, and large ones are simplified.
std::int64_t cost_of(const CatalogShape& shape) {
    return 500 + std::min<std::int64_t>(shape.faces, k_max_working_faces);
}

/// Calls `use` for every shape that is open.
template <typename Use>
void for_each_open(CatalogRun& run, Use&& use) {
    constexpr std::size_t k_at_a_time = 1000;
    std::int64_t last = 0;
    for (;;) {
        const std::vector<CatalogShape> shapes = run.open_shapes(k_at_a_time, last);
        if (shapes.empty()) return;
        for (const CatalogShape& shape : shapes) {
            check_interrupt();
            use(shape);
        }
        last = shapes.back().id;
    }
}

/// Returns whether a record is of the shape's file as it was when the shard was written, or as it is now.
bool is_about(const ShapeRecord& record, CatalogShape shape) {
    if (record.content == content_of(shape)) return true;
    try {
        stat_shape(shape.path);  // rejects pipes, whose reading would never end
        shape.hash = file_hash(shape.path);
    } catch (const DataError&) {  // it has vanished
        return false;
    }
    return record.content == content_of(shape);
}

/// Makes a new numbered folder.
fs::path new_folder(const fs::path& in) {
    std::error_code error;
    fs::create_directories(in, error);
    for (int number = 1;; ++number) {
        fs::path folder = in / std::to_string(number);
        if (fs::create_directory(folder, error)) return folder;
        if (error) throw DataError(fmt::format("{}: cannot be made: {}", folder.string(), error.message()));
    }
}

}  // namespace

std::vector<fs::path> write_shards(CatalogRun& run, const BatchPlan& plan, std::size_t count) {
    std::int64_t total = 0;
    for_each_open(run, [&](const CatalogShape& shape) { total += cost_of(shape); });
    if (total == 0) return {};
    const fs::path folder = new_folder(plan.out / "shards");
    const double share = static_cast<double>(total) / static_cast<double>(count);
    std::vector<fs::path> paths;
    Shard shard{plan, {}};
    const auto finish = [&] {
        if (shard.shapes.empty()) return;
        paths.push_back(folder / fmt::format("{}.shard", paths.size() + 1));
        write_shard(paths.back(), shard);
        shard.shapes.clear();
    };
    std::int64_t cost = 0;
    for_each_open(run, [&](const CatalogShape& shape) {
        shard.shapes.push_back(shape);
        cost += cost_of(shape);
        if (static_cast<double>(cost) >= share * static_cast<double>(paths.size() + 1) - 0.5) finish();
    });
    finish();
    return paths;
}

ShardWork::ShardWork(Shard shard, bool from_the_end) : shard_(std::move(shard)) {
    if (from_the_end) std::ranges::reverse(shard_.shapes);
}

std::optional<CatalogShape> ShardWork::next() {
    const std::lock_guard lock(mutex_);
    while (next_ < shard_.shapes.size()) {
        check_interrupt();
        CatalogShape shape = std::move(shard_.shapes[next_++]);
        const fs::path path = shard_.plan.out / "labeled" / (shape.name + ".json");
        std::error_code ignored;
        const bool is_there = fs::exists(fs::symlink_status(path, ignored));
        const auto record = read_record(path);
        if (record && record->run == shard_.plan.key && is_about(*record, shape)) {
            counts_.count(*record, false);
            continue;
        }
        // Removes a record that is of another run, damaged, or of an older file; not one that appeared just now.
        if (is_there) remove_record(shard_.plan.out / "labeled", shape.name);
        return shape;
    }
    return {};
}

void ShardWork::finish(const BatchShape& shape, bool is_new) {
    const std::lock_guard lock(mutex_);
    counts_.count(shape.record, is_new);
}

}  // namespace exemplar
