#include "host/labeling/painting/painting_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <ostream>

#include "host/core/errors.h"
#include "host/core/files.h"
#include "host/learn/boosting/boosted_stumps.h"
#include "host/mesh/color_text.h"

namespace exemplar {
namespace {

constexpr const char* k_painting_kind = "exemplar painting";
constexpr int k_painting_version = 1;
constexpr std::size_t k_max_name = 100;

[[noreturn]] void damaged(const std::filesystem::path& path, const std::string& what) {
    throw DataError(fmt::format("{}: {}; remove the file to begin anew", path.string(), what));
}

/// Returns the painted faces of each label as [first, count] runs of neighbors.
std::vector<nlohmann::json> runs_of(const Painting& painting) {
    std::vector<nlohmann::json> runs(painting.palette.size(), nlohmann::json::array());
    for (std::size_t f = 0; f < painting.label.size();) {
        std::size_t end = f + 1;
        while (end < painting.label.size() && painting.label[end] == painting.label[f]) ++end;
        if (painting.label[f] >= 0) runs[static_cast<std::size_t>(painting.label[f])].push_back({f, end - f});
        f = end;
    }
    return runs;
}

/// Paints the runs of one label.
void add_runs(const std::filesystem::path& path, const nlohmann::json& runs, std::int32_t label, Painting& painting) {
    const std::size_t faces = painting.label.size();
    for (const nlohmann::json& run : runs) {
        const auto first = run.at(0).get<std::size_t>(), count = run.at(1).get<std::size_t>();
        if (first >= faces || count > faces - first)
            damaged(path, fmt::format("faces {} + {} of a mesh with {} faces", first, count, faces));
        std::fill_n(painting.label.begin() + static_cast<std::ptrdiff_t>(first), count, label);
    }
}

}  // namespace

std::filesystem::path painting_path(const std::filesystem::path& mesh) {
    return mesh.parent_path() / (mesh.stem().string() + "_painting.json");
}

void save_painting(const std::filesystem::path& path, const Painting& painting) {
    const std::vector<nlohmann::json> runs = runs_of(painting);
    nlohmann::json labels = nlohmann::json::array();
    for (std::size_t c = 0; c < painting.palette.size(); ++c)
        labels.push_back({{"name", painting.palette[c].name},
                          {"color", hex_of_color(painting.palette[c].color)},
                          {"faces", runs[c]}});
    const nlohmann::json json{{"kind", k_painting_kind},
                              {"format_version", k_painting_version},
                              {"faces", painting.label.size()},
                              {"labels", labels}};
    write_file_atomically(path, [&](std::ostream& out) { out << json.dump(1) << '\n'; });
}

Painting load_painting(const std::filesystem::path& path, std::size_t faces) {
    const std::string text = read_file(path);
    Painting painting;
    painting.label.assign(faces, k_unpainted);
    try {
        const nlohmann::json json = nlohmann::json::parse(text);
        if (json.at("kind") != k_painting_kind) damaged(path, "this is no painting");
        if (json.at("format_version") != k_painting_version) damaged(path, "this painting is of another version");
        if (json.at("faces").get<std::size_t>() != faces)
            damaged(path, fmt::format("it was painted on a mesh with {} faces, and this one has {}",
                                      json.at("faces").get<std::size_t>(), faces));
        const nlohmann::json& labels = json.at("labels");
        if (labels.size() > k_max_classes) damaged(path, fmt::format("more than {} labels", k_max_classes));
        for (std::size_t c = 0; c < labels.size(); ++c) {
            const std::optional<Color> color = color_of_hex(labels[c].at("color").get<std::string>());
            painting.palette.push_back(
                {checked_label_name(labels[c].at("name").get<std::string>()), color.value_or(label_color(c))});
            add_runs(path, labels[c].at("faces"), static_cast<std::int32_t>(c), painting);
        }
    } catch (const nlohmann::json::exception& error) {
        damaged(path, fmt::format("it is damaged ({})", std::string(error.what()).substr(0, 60)));
    } catch (const UsageError& error) {
        damaged(path, error.what());
    }
    return painting;
}

std::string checked_label_name(const std::string& name) {
    const auto first = name.find_first_not_of(' '), last = name.find_last_not_of(' ');
    if (first == std::string::npos) throw UsageError("a label needs a name");
    std::string trimmed = name.substr(first, last - first + 1);
    if (trimmed.size() > k_max_name)
        throw UsageError(
            fmt::format("the name of a label has at most {} bytes; this one has {}", k_max_name, trimmed.size()));
    if (std::ranges::any_of(trimmed, [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; }))
        throw UsageError("the name of a label has a line break or another control character");
    return trimmed;
}

}  // namespace exemplar
