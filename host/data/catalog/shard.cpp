#include "host/data/catalog/shard.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <string_view>

#include "host/core/errors.h"
#include "host/core/files.h"
#include "host/core/json_text.h"
#include "host/data/catalog/shape_record.h"

namespace exemplar {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

constexpr int k_shard_format = 1;
constexpr std::string_view k_begin = R"({"exemplar_shard":)";

Json to_json(const BatchPlan& plan) {
    return {{"exemplar_shard", k_shard_format},
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

/// Returns a whole number; throws for anything else (1e300, true), which the library would convert.
std::int64_t whole_number(const Json& json) {
    constexpr std::uint64_t k_most = std::numeric_limits<std::int64_t>::max();
    if (!json.is_number_integer() || (json.is_number_unsigned() && json.get<std::uint64_t>() > k_most))
        throw DataError("has another value where a whole number should be; write the shards again");
    return json.get<std::int64_t>();
}

/// Returns a number, at least 0. A wrong file size is noticed when the file is read.
std::int64_t count_from(const Json& json) {
    return std::max<std::int64_t>(whole_number(json), 0);
}

BatchPlan plan_from(const Json& json) {
    if (json.at("exemplar_shard") != k_shard_format)
        throw DataError("is a shard of another version of Exemplar; write the shards again");
    return {.models = to_bytes(json.at("models").get<std::string>()),
            .out = to_bytes(json.at("out").get<std::string>()),
            .key = json.at("run").get<std::string>(),
            .gltf = json.at("gltf").get<bool>(),
            .keep_small = json.at("keep_small").get<bool>()};
}

CatalogShape shape_from(const Json& json) {
    CatalogShape shape;
    shape.id = whole_number(json.at("id"));
    shape.path = to_bytes(json.at("path").get<std::string>());
    shape.name = to_bytes(json.at("name").get<std::string>());
    shape.bytes = count_from(json.at("bytes"));
    shape.hash = json.at("hash").get<std::string>();
    shape.faces = count_from(json.at("faces"));
    shape.category = to_bytes(json.at("category").get<std::string>());
    if (!is_output_name(shape.name))
        throw DataError(fmt::format("the name of shape {} leads out of the folder", shape.id));
    return shape;
}

/// Calls `use` for every line, without copying the text, which may be large.
template <typename Use>
void for_each_line(std::string_view text, Use&& use) {
    while (!text.empty()) {
        const std::size_t end = std::min(text.find('\n'), text.size());
        use(text.substr(0, end));
        text.remove_prefix(std::min(end + 1, text.size()));
    }
}

}  // namespace

void write_shard(const fs::path& path, const Shard& shard) {
    write_file_atomically(path, [&](std::ostream& out) {
        out << json_text(to_json(shard.plan)) << '\n';
        for (const CatalogShape& shape : shard.shapes) out << json_text(to_json(shape)) << '\n';
    });
}

Shard read_shard(const fs::path& path) {
    Shard shard;
    const std::string text = read_file(path);
    std::size_t number = 0;
    try {
        for_each_line(text, [&](std::string_view line) {
            const Json json = parse_shallow(line);
            if (++number == 1)
                shard.plan = plan_from(json);
            else
                shard.shapes.push_back(shape_from(json));
        });
    } catch (const Json::exception&) {
        throw DataError(fmt::format("{}:{}: is damaged; write the shards again", path.string(), number));
    } catch (const DataError& error) {
        throw DataError(fmt::format("{}:{}: {}", path.string(), number, error.what()));
    }
    if (number == 0) throw DataError(path.string() + ": is empty; write the shards again");
    return shard;
}

bool is_shard(const fs::path& path) {
    std::string begin(k_begin.size(), '\0');
    std::error_code ignored;
    if (!fs::is_regular_file(path, ignored)) return false;
    std::ifstream stream(path, std::ios::binary);
    stream.read(begin.data(), static_cast<std::streamsize>(begin.size()));
    return stream.gcount() == static_cast<std::streamsize>(k_begin.size()) && begin == k_begin;
}

}  // namespace exemplar
