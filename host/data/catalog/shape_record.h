#pragma once

#include <filesystem>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>

namespace exemplar {

/// In the place of a category that no model knows.
constexpr std::string_view k_unknown_category = "unknown";

/// What was made of one shape by one run. It is the last of the shape's files to be written: where it is, the others
/// are, and whole.
struct ShapeRecord {
    std::string run;      ///< key of the run: models and options
    std::string content;  ///< what was labeled, see content_of
    std::string worker;   ///< who did it
    std::string error;    ///< why it could not be labeled; empty if it was
    std::string model;    ///< name of the model that labeled it
    std::string model_hash;
    std::string category;                                                    ///< given or recognized; empty if neither
    double category_probability = std::numeric_limits<double>::quiet_NaN();  ///< NaN unless recognized
    double confidence = std::numeric_limits<double>::quiet_NaN();            ///< mean over the surface, in [0, 1]
    std::string features;                                                    ///< entry in the cache of features
    nlohmann::json labels = nlohmann::json::array();    ///< per label that occurs: share of the area, faces, confidence
    nlohmann::json seconds = nlohmann::json::object();  ///< per stage
    double finished = 0;                                ///< seconds since 1970

    /// "done", "failed", or "unknown": a shape of no category that there is a model of.
    std::string state() const;
    /// Of all stages.
    double seconds_all() const;
};

/// Bytes of any encoding as JSON, which is UTF-8: each byte a code point.
std::string to_text(const std::string& bytes);
/// The bytes that to_text was given. Throws DataError where the text is of no bytes.
std::string to_bytes(const std::string& text);
nlohmann::json to_json(const ShapeRecord& record);
/// JSON of strangers, without what is nested deeper than any record, as going through that would exhaust the stack; a
/// discarded value if it is damaged.
nlohmann::json parse_shallow(std::string_view text);
/// The record at `path`; nothing if there is none, or a damaged one.
std::optional<ShapeRecord> read_record(const std::filesystem::path& path);
/// Moves the file `written` to `path` unless a file is there: of several processes that do so at once, on one machine
/// or on several, one succeeds. Returns whether it did; `written` is gone either way. Throws DataError.
bool commit_file(const std::filesystem::path& written, const std::filesystem::path& path);

}  // namespace exemplar
