#include "apps/exemplar/batch_shards.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "host/core/errors.h"
#include "host/core/files.h"
#include "host/core/interrupt.h"
#include "host/data/shape_record.h"
#include "host/data/shape_scan.h"

namespace exemplar {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

constexpr int k_format = 1;
constexpr std::string_view k_begin = R"({"exemplar_shard":)";

Json to_json(const BatchPlan& plan) {
    return {{"exemplar_shard", k_format},
            {"models", to_text(plan.models.string())},
            {"out", to_text(plan.out.string())},
            {"run", plan.key},
            {"gltf", plan.gltf},
            {"keep_small", plan.keep_small}};
}

Json to_json(const CatalogShape& shape) {
    return {{"id", shape.id},
            {"path", to_text(shape.path.string())},
            {"name", to_text(shape.name)},
            {"bytes", shape.bytes},
            {"hash", shape.hash},
            {"faces", shape.faces},
            {"category", to_text(shape.category)}};
}

BatchPlan plan_from(const Json& json) {
    if (json.at("exemplar_shard") != k_format)
        throw DataError("is a shard of another version of Exemplar; write the shards again");
    return {.models = to_bytes(json.at("models").get<std::string>()),
            .out = to_bytes(json.at("out").get<std::string>()),
            .key = json.at("run").get<std::string>(),
            .gltf = json.at("gltf").get<bool>(),
            .keep_small = json.at("keep_small").get<bool>()};
}

CatalogShape shape_from(const Json& json) {
    CatalogShape shape;
    shape.id = json.at("id").get<std::int64_t>();
    shape.path = to_bytes(json.at("path").get<std::string>());
    shape.name = to_bytes(json.at("name").get<std::string>());
    shape.bytes = json.at("bytes").get<std::int64_t>();
    shape.hash = json.at("hash").get<std::string>();
    shape.faces = std::max<std::int64_t>(json.at("faces").get<std::int64_t>(), 0);
    shape.category = to_bytes(json.at("category").get<std::string>());
    if (!is_output_name(shape.name))
        throw DataError(fmt::format("the name of shape {} leads out of the folder", shape.id));
    return shape;
}

/// What labeling costs, in faces: some time goes by for every shape, and large ones are simplified.
std::int64_t cost_of(const CatalogShape& shape) {
    return 500 + std::min<std::int64_t>(shape.faces, k_most_working_faces);
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

/// Whether a record is about a shape as it was when the shard was written, or as it is now.
bool is_about(const ShapeRecord& record, CatalogShape shape) {
    if (record.content == content_of(shape)) return true;
    try {
        shape.hash = file_hash(shape.path);
    } catch (const DataError&) {  // it has vanished
        return false;
    }
    return record.content == content_of(shape);
}

/// A folder that nobody else has.
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
    std::ostringstream lines;
    const auto finish = [&] {
        if (lines.view().empty()) return;
        const fs::path path = folder / fmt::format("{}.shard", paths.size() + 1);
        write_file_atomically(path, [&](std::ostream& out) { out << to_json(plan).dump() << '\n' << lines.view(); });
        paths.push_back(path);
        lines.str({});
    };
    std::int64_t cost = 0;
    for_each_open(run, [&](const CatalogShape& shape) {
        lines << to_json(shape).dump() << '\n';
        cost += cost_of(shape);
        if (static_cast<double>(cost) >= share * static_cast<double>(paths.size() + 1) - 0.5) finish();
    });
    finish();
    return paths;
}

bool is_shard(const fs::path& path) {
    std::string begin(k_begin.size(), '\0');
    std::error_code ignored;
    if (!fs::is_regular_file(path, ignored)) return false;
    std::ifstream stream(path, std::ios::binary);
    stream.read(begin.data(), static_cast<std::streamsize>(begin.size()));
    return stream.gcount() == static_cast<std::streamsize>(k_begin.size()) && begin == k_begin;
}

Shard read_shard(const fs::path& path) {
    Shard shard;
    std::istringstream lines(read_file(path));
    std::string line;
    std::size_t number = 0;
    try {
        while (std::getline(lines, line)) {
            if (++number == 1)
                shard.plan = plan_from(Json::parse(line));
            else
                shard.shapes.push_back(shape_from(Json::parse(line)));
        }
    } catch (const Json::exception&) {
        throw DataError(fmt::format("{}:{}: is damaged; write the shards again", path.string(), number));
    } catch (const DataError& error) {
        throw DataError(fmt::format("{}:{}: {}", path.string(), number, error.what()));
    }
    return shard;
}

ShardWork::ShardWork(Shard shard, bool from_the_end) : shard_(std::move(shard)) {
    if (from_the_end) std::ranges::reverse(shard_.shapes);
}

std::optional<CatalogShape> ShardWork::next() {
    const std::lock_guard lock(mutex_);
    while (next_ < shard_.shapes.size()) {
        CatalogShape shape = std::move(shard_.shapes[next_++]);
        const fs::path path = shard_.plan.out / "labeled" / (shape.name + ".json");
        std::error_code ignored;
        const bool is_there = fs::exists(fs::symlink_status(path, ignored));
        const auto record = read_record(path);
        if (record && record->run == shard_.plan.key && is_about(*record, shape)) {
            counts_.count(*record, false);
            continue;
        }
        // One of another run, a damaged one, or of the file before it changed; not one that has come this moment.
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
