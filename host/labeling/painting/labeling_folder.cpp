#include "host/labeling/painting/labeling_folder.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>
#include <ostream>
#include <set>

#include "host/core/errors.h"
#include "host/core/files.h"
#include "host/data/corpus.h"
#include "host/labeling/painting/painting_file.h"
#include "host/learn/boosting/boosted_stumps.h"
#include "host/mesh/color_text.h"
#include "host/mesh/label_files/label_files.h"

namespace exemplar {
namespace {

namespace fs = std::filesystem;

constexpr const char* k_palette_file = "palette.json";

std::optional<fs::file_time_type> time_of(const fs::path& path) {
    std::error_code error;
    const fs::file_time_type time = fs::last_write_time(path, error);
    return error ? std::nullopt : std::optional(time);
}

std::vector<PaletteEntry> read_palette(const fs::path& path) {
    std::vector<PaletteEntry> palette;
    try {
        const nlohmann::json json = nlohmann::json::parse(read_file(path));
        for (const nlohmann::json& entry : json.at("labels")) {
            const std::optional<Color> color = color_of_hex(entry.value("color", std::string()));
            palette.push_back(
                {checked_label_name(entry.at("name").get<std::string>()), color.value_or(label_color(palette.size()))});
        }
    } catch (const nlohmann::json::exception&) {
        throw DataError(fmt::format("{}: it is damaged, and its names and colors are not used", path.string()));
    } catch (const UsageError& error) {
        throw DataError(fmt::format("{}: {}", path.string(), error.what()));
    }
    return palette;
}

/// Returns the names in a label file: every other line that is not empty.
std::vector<std::string> names_in(const fs::path& path) {
    std::ifstream file(path);
    std::vector<std::string> names;
    std::string line;
    for (bool is_name = true; std::getline(file, line);) {
        while (!line.empty() && (line.back() == '\r' || line.back() == ' ')) line.pop_back();
        if (line.empty()) continue;
        if (is_name) names.push_back(line);
        is_name = !is_name;
    }
    return names;
}

void require_palette(const std::vector<PaletteEntry>& palette) {
    if (palette.size() > k_max_classes) throw UsageError(fmt::format("at most {} labels are possible", k_max_classes));
    std::set<std::string> names;
    for (const PaletteEntry& entry : palette)
        if (!names.insert(checked_label_name(entry.name)).second)
            throw UsageError(fmt::format("there are two labels '{}'", entry.name));
}

}  // namespace

LabelingFolder::LabelingFolder(const fs::path& source)
    : folder_(fs::is_directory(source) ? source : source.parent_path()) {
    for (const fs::path& path : list_meshes(source)) shapes_.push_back({path});
    seen_.resize(shapes_.size());
    if (fs::exists(folder_ / k_palette_file)) {
        try {
            palette_ = read_palette(folder_ / k_palette_file);
        } catch (const DataError& error) {
            warnings_.emplace_back(error.what());
        }
    }
    for (std::size_t s = 0; s < shapes_.size(); ++s) {
        note_version(s);
        shapes_[s].begun = fs::exists(painting_path(shapes_[s].path));
        shapes_[s].verified = seen_[s].has_value();
        if (!shapes_[s].verified) continue;
        for (const std::string& name : names_in(labels_file(s)))
            if (std::ranges::find(palette_, name, &PaletteEntry::name) == palette_.end() &&
                palette_.size() < k_max_classes)
                palette_.push_back({name, label_color(palette_.size())});
    }
}

fs::path LabelingFolder::labels_file(std::size_t shape) const {
    return labels_path(shapes_[shape].path);
}

void LabelingFolder::note_version(std::size_t shape) {
    seen_[shape] = time_of(labels_file(shape));
}

std::size_t LabelingFolder::verified_count() const {
    return static_cast<std::size_t>(std::ranges::count(shapes_, true, &FolderShape::verified));
}

void LabelingFolder::set_palette(std::vector<PaletteEntry> palette) {
    require_palette(palette);
    palette_ = std::move(palette);
    nlohmann::json labels = nlohmann::json::array();
    for (const PaletteEntry& entry : palette_)
        labels.push_back({{"name", entry.name}, {"color", hex_of_color(entry.color)}});
    write_file_atomically(folder_ / k_palette_file, [&](std::ostream& out) {
        out << nlohmann::json{{"labels", labels}}.dump(1) << '\n';
    });
}

std::vector<std::int32_t> LabelingFolder::in_palette(const FaceLabels& labels) {
    std::vector<std::int32_t> index;
    index.reserve(labels.names.size());
    for (const std::string& name : labels.names) {
        const auto place = std::ranges::find(palette_, name, &PaletteEntry::name);
        index.push_back(static_cast<std::int32_t>(place - palette_.begin()));
        if (place == palette_.end()) palette_.push_back({name, label_color(palette_.size())});
    }
    std::vector<std::int32_t> result;
    result.reserve(labels.label.size());
    for (const std::int32_t label : labels.label)
        result.push_back(label < 0 ? k_unpainted : index[static_cast<std::size_t>(label)]);
    return result;
}

std::vector<std::int32_t> LabelingFolder::read_labels(std::size_t shape, std::size_t faces) {
    note_version(shape);
    return in_palette(read_labels_txt(labels_file(shape), faces));
}

std::optional<std::vector<std::int32_t>> LabelingFolder::read_other_labels(std::size_t shape, const MeshFile& file) {
    if (file.labels) return in_palette(*file.labels);
    const std::optional<FaceLabels> labels = find_other_labels(shapes_[shape].path, file.mesh);
    return labels ? std::optional(in_palette(*labels)) : std::nullopt;
}

std::optional<std::vector<std::int32_t>> LabelingFolder::read_strokes(std::size_t shape, std::size_t faces) {
    const fs::path path = painting_path(shapes_[shape].path);
    if (!fs::exists(path)) return std::nullopt;
    const Painting painting = load_painting(path, faces);
    FaceLabels labels;
    for (const PaletteEntry& entry : painting.palette) labels.names.push_back(entry.name);
    labels.label = painting.label;
    return in_palette(labels);
}

void LabelingFolder::save_strokes(std::size_t shape, std::vector<std::int32_t> label) {
    save_painting(painting_path(shapes_[shape].path), {palette_, std::move(label)});
    shapes_[shape].begun = true;
}

void LabelingFolder::save_labels(std::size_t shape, std::vector<std::int32_t> label) {
    const fs::path path = labels_file(shape);
    if (time_of(path) != seen_[shape]) {
        note_version(shape);
        throw DataError(fmt::format("{} was changed by another program since it was read; save again to replace it",
                                    path.string()));
    }
    FaceLabels labels;
    for (const PaletteEntry& entry : palette_) labels.names.push_back(entry.name);
    labels.label = std::move(label);
    write_labels_txt(path, labels);
    note_version(shape);
    std::error_code ignored;
    fs::remove(painting_path(shapes_[shape].path), ignored);
    shapes_[shape].verified = true;
    shapes_[shape].begun = false;
}

}  // namespace exemplar
