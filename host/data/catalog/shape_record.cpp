#include "host/data/catalog/shape_record.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstring>

#include "host/core/errors.h"
#include "host/core/files.h"
#include "host/core/json_text.h"

namespace exemplar {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

constexpr int k_deepest = 8;                      ///< maximum nesting: a record has three levels
constexpr std::uintmax_t k_max_bytes = 16 << 20;  ///< maximum size of a record: far more than it ever has

Json number(double value) {
    return std::isfinite(value) ? Json(value) : Json(nullptr);
}

double number_of(const Json& json) {
    return json.is_null() ? std::numeric_limits<double>::quiet_NaN() : json.get<double>();
}

ShapeRecord from_json(const Json& json) {
    ShapeRecord record;
    json.at("run").get_to(record.run);
    record.content = to_bytes(json.at("content").get<std::string>());  // contains the category, which may have any
                                                                       // encoding
    json.at("worker").get_to(record.worker);
    json.at("error").get_to(record.error);
    json.at("model").get_to(record.model);
    json.at("model_hash").get_to(record.model_hash);
    json.at("category").get_to(record.category);
    record.category_probability = number_of(json.at("category_probability"));
    record.confidence = number_of(json.at("confidence"));
    json.at("features").get_to(record.features);
    record.labels = json.at("labels").get<Json::array_t>();
    record.seconds = json.at("seconds").get<Json::object_t>();
    record.finished = number_of(json.at("finished"));
    record.seconds_all();  // throws unless they are numbers
    return record;
}

}  // namespace

std::string ShapeRecord::state() const {
    if (error.empty()) return "done";
    return category == k_unknown_category ? "unknown" : "failed";
}

double ShapeRecord::seconds_all() const {
    double all = 0;
    for (const auto& stage : seconds) all += stage.get<double>();
    return all;
}

Json parse_shallow(std::string_view text) {
    const auto is_kept = [](int depth, Json::parse_event_t, Json&) { return depth <= k_deepest; };
    return parse_json(text, is_kept, false);
}

std::string to_text(const std::string& bytes) {
    std::string text;
    for (const char c : bytes) {
        const auto byte = static_cast<unsigned char>(c);
        if (byte < 0x80) {
            text += c;
        } else {
            text += static_cast<char>(0xc0 | (byte >> 6));
            text += static_cast<char>(0x80 | (byte & 0x3f));
        }
    }
    return text;
}

std::string to_bytes(const std::string& text) {
    std::string bytes;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const auto lead = static_cast<unsigned char>(text[i]);
        if (lead < 0x80) {
            bytes += text[i];
        } else if (lead <= 0xc3 && i + 1 < text.size()) {
            bytes += static_cast<char>((lead << 6) | (static_cast<unsigned char>(text[++i]) & 0x3f));
        } else {
            throw DataError("text holds what is no byte");
        }
    }
    return bytes;
}

Json to_json(const ShapeRecord& record) {
    return {{"run", record.run},
            {"content", to_text(record.content)},
            {"worker", record.worker},
            {"error", record.error},
            {"model", record.model},
            {"model_hash", record.model_hash},
            {"category", record.category},
            {"category_probability", number(record.category_probability)},
            {"confidence", number(record.confidence)},
            {"features", record.features},
            {"labels", record.labels},
            {"seconds", record.seconds},
            {"finished", record.finished}};
}

std::optional<ShapeRecord> read_record(const fs::path& path) {
    std::error_code ignored;
    if (!fs::is_regular_file(path, ignored) || fs::file_size(path, ignored) > k_max_bytes) return {};
    try {
        return from_json(parse_shallow(read_file(path)));
    } catch (const Json::exception&) {
        return {};
    } catch (const DataError&) {
        return {};  // it is being replaced at this moment
    }
}

bool commit_file(const fs::path& written, const fs::path& path) {
    // Creating a link, unlike renaming, never replaces a file, and only one of several processes succeeds, on
    // network file systems, too. Some file systems have no links, but a rename that does not replace.
    int failed = link(written.c_str(), path.c_str());
    if (failed != 0 && errno != EEXIST)
        failed = renameat2(AT_FDCWD, written.c_str(), AT_FDCWD, path.c_str(), RENAME_NOREPLACE);
    const int reason = errno;
    unlink(written.c_str());
    if (failed != 0 && reason != EEXIST)
        throw DataError(fmt::format("{}: cannot be written: {}", path.string(), std::strerror(reason)));
    return failed == 0;
}

}  // namespace exemplar
