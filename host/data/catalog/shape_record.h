#pragma once

#include <filesystem>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>

namespace exemplar {

/// Used instead of a category if no model knows the shape's category.
constexpr std::string_view k_unknown_category = "unknown";

/// The result of one shape in one run. It is written after the shape's other files: if it exists, they are complete.
struct ShapeRecord {
    std::string run;      ///< key of the run: models and options
    std::string content;  ///< what was labeled (see content_of)
    std::string worker;   ///< id of the worker that labeled it
    std::string error;    ///< why it could not be labeled; empty if it was
    std::string model;    ///< name of the model that labeled it
    std::string model_hash;
    std::string category;                                                    ///< given or recognized; empty if neither
    double category_probability = std::numeric_limits<double>::quiet_NaN();  ///< NaN unless recognized
    double confidence = std::numeric_limits<double>::quiet_NaN();            ///< mean over the surface, in [0, 1]
    std::string features;                                                    ///< name of the entry in the feature
                                                                             ///< cache
    nlohmann::json labels = nlohmann::json::array();    ///< per label that occurs: area share, faces, confidence
    nlohmann::json seconds = nlohmann::json::object();  ///< per stage
    double finished = 0;                                ///< seconds since 1970

    /// Returns "done", "failed", or "unknown" (no model knows the category).
    std::string state() const;
    /// Returns the seconds of all stages together.
    double seconds_all() const;
};

/// Converts bytes of any encoding to UTF-8 for JSON: each byte becomes a code point.
std::string to_text(const std::string& bytes);
/// Reverses to_text. Throws DataError if the text has other code points.
std::string to_bytes(const std::string& text);
nlohmann::json to_json(const ShapeRecord& record);
/// Parses foreign JSON without values that are nested deeper than in any record, since deep recursion would exhaust
/// the stack; returns a discarded value if it is malformed.
nlohmann::json parse_shallow(std::string_view text);
/// Reads the record at `path`; returns nothing if it is missing or damaged.
std::optional<ShapeRecord> read_record(const std::filesystem::path& path);
/// Moves the file `written` to `path` unless a file is there: if several processes do so at once, on one machine or
/// several, one succeeds. Returns whether it did; `written` is gone either way. Throws DataError.
bool commit_file(const std::filesystem::path& written, const std::filesystem::path& path);

}  // namespace exemplar
