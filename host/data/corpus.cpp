#include "host/data/corpus.h"

#include <fmt/format.h>

#include <algorithm>
#include <climits>
#include <map>
#include <optional>
#include <set>
#include <sstream>

#include "host/core/errors.h"
#include "host/core/files.h"
#include "host/core/parallel.h"
#include "host/core/text.h"
#include "host/mesh/editing/validate.h"
#include "host/mesh/io/io_text.h"
#include "host/mesh/label_files/label_files.h"

namespace exemplar {
namespace {

namespace fs = std::filesystem;

/// Returns whether a file exists; false for names that the system refuses, for example because they are too long.
bool is_there(const fs::path& path) {
    std::error_code ignored;
    return fs::exists(path, ignored);
}

std::vector<fs::path> meshes_of_folder(const fs::path& folder) {
    std::vector<fs::path> paths;
    for (const auto& entry : fs::directory_iterator(folder))
        if (entry.is_regular_file() && is_mesh_file(entry.path())) paths.push_back(entry.path());
    std::ranges::sort(paths, natural_less, [](const fs::path& path) { return path.string(); });
    return paths;
}

/// Returns where the comment of a line begins: at a # that is first in the line or after a space, as no name could
/// have it.
std::size_t comment_begin(const std::string& line) {
    for (std::size_t i = 0; i < line.size(); ++i)
        if (line[i] == '#' && (i == 0 || line[i - 1] == ' ' || line[i - 1] == '\t')) return i;
    return line.size();
}

std::vector<fs::path> meshes_of_list(const fs::path& list, MissingMeshes missing) {
    std::vector<fs::path> paths;
    const std::string content = read_file(list);
    std::istringstream lines(content);
    const char line_end = content.find('\n') == std::string::npos ? '\r' : '\n';
    std::string line;
    for (int number = 1; std::getline(lines, line, line_end); ++number) {
        line.erase(0, line.find_first_not_of(" \t\r"));
        line.erase(comment_begin(line));
        line.erase(line.find_last_not_of(" \t\r") + 1);
        if (line.empty()) continue;
        if (line.size() >= PATH_MAX)  // checked first, since splitting a path takes a hundred bytes per character
            throw DataError(fmt::format("{}:{}: no such mesh: {} (names of files have less than {} bytes)",
                                        list.string(), number, mesh_io::printable(line, 200), PATH_MAX));
        fs::path path = line;
        if (path.is_relative() && !is_there(path)) path = list.parent_path() / path;
        if (missing == MissingMeshes::refused && !is_there(path))
            throw DataError(fmt::format("{}:{}: no such mesh: {}{}", list.string(), number,
                                        mesh_io::printable(line, 200), suggest_file(path)));
        paths.push_back(path);
    }
    return paths;
}

/// Returns for each name of `labels` that has faces its index in `names`; throws for a name that is not among them.
std::vector<std::int32_t> map_names(const FaceLabels& labels, const std::vector<std::string>& names,
                                    const fs::path& path) {
    std::vector<std::int32_t> index(labels.names.size(), -1);
    std::vector<bool> used(labels.names.size(), false);
    for (const std::int32_t label : labels.label)
        if (label >= 0) used[label] = true;
    for (std::size_t i = 0; i < labels.names.size(); ++i) {
        if (!used[i]) continue;
        const auto found = std::find(names.begin(), names.end(), labels.names[i]);
        if (found == names.end())
            throw DataError(fmt::format("{}: unknown label '{}'{}", path.string(), labels.names[i],
                                        suggestion(labels.names[i], names)));
        index[i] = static_cast<std::int32_t>(found - names.begin());
    }
    return index;
}

struct Loaded {
    MeshFile file;
    FaceLabels labels;
    std::vector<std::string> warnings;
};

Loaded load_one(const fs::path& path, const fs::path& labels_folder) {
    Loaded loaded{read_mesh(path), {}, {}};
    loaded.labels = labels_of_mesh(path, loaded.file, labels_folder);
    const MeshReport report = require_usable(loaded.file.mesh, path.string());
    for (const std::string& message : loaded.file.warnings) loaded.warnings.push_back(path.string() + ": " + message);
    for (const std::string& message : report.messages()) loaded.warnings.push_back(path.string() + ": " + message);
    return loaded;
}

}  // namespace

bool is_mesh_file(const fs::path& path) {
    const std::string extension = lower_case(path.extension().string());
    const auto known = mesh_extensions();
    return std::find(known.begin(), known.end(), extension) != known.end();
}

std::vector<fs::path> list_meshes(const fs::path& source, MissingMeshes missing) {
    if (!is_there(source))
        throw DataError(fmt::format("{}: no such folder or list{}", source.string(), suggest_file(source)));
    std::vector<fs::path> paths;
    if (fs::is_directory(source))
        paths = meshes_of_folder(source);
    else if (is_mesh_file(source))
        paths = {source};
    else
        paths = meshes_of_list(source, missing);
    if (paths.empty())
        throw DataError(fmt::format("{}: holds no meshes ({})", source.string(), fmt::join(mesh_extensions(), " ")));
    return paths;
}

fs::path labels_path(const fs::path& mesh, const fs::path& labels_folder) {
    return (labels_folder.empty() ? mesh.parent_path() : labels_folder) / (mesh.stem().string() + "_labels.txt");
}

FaceLabels labels_of_mesh(const fs::path& path, const MeshFile& file, const fs::path& labels_folder) {
    const fs::path labels = labels_path(path, labels_folder);
    if (is_there(labels)) return read_labels_txt(labels, file.mesh.source_face_count);
    if (!labels_folder.empty())
        throw DataError(fmt::format("{}: no such file; it should hold the labels of {}{}", labels.string(),
                                    path.string(), suggest_file(labels)));
    if (file.labels) return *file.labels;
    if (std::optional<FaceLabels> others = find_other_labels(path, file.mesh)) return std::move(*others);
    throw DataError(fmt::format("{}: no labels: give {} beside it, or a PLY with a per-face 'label' property",
                                path.string(), labels.filename().string()));
}

LabeledCorpus load_corpus(const std::vector<fs::path>& paths, const std::vector<std::string>& names,
                          const fs::path& labels_folder) {
    std::vector<Loaded> loaded(paths.size());
    parallel_for(paths.size(), [&](std::size_t i) { loaded[i] = load_one(paths[i], labels_folder); });

    LabeledCorpus corpus;
    corpus.names = names;
    if (names.empty()) {
        std::set<std::string> used;
        for (const Loaded& item : loaded)
            for (const std::int32_t label : item.labels.label)
                if (label >= 0) used.insert(item.labels.names[label]);
        corpus.names.assign(used.begin(), used.end());
    }
    for (std::size_t i = 0; i < paths.size(); ++i) {
        corpus.warnings.insert(corpus.warnings.end(), loaded[i].warnings.begin(), loaded[i].warnings.end());
        const std::vector<std::int32_t> index = map_names(loaded[i].labels, corpus.names, paths[i]);
        LabeledMesh item{paths[i].stem().string(), paths[i], std::move(loaded[i].file.mesh), {}};
        item.label.resize(item.mesh.face_count());
        for (std::uint32_t f = 0; f < item.mesh.face_count(); ++f) {
            const std::int32_t label = loaded[i].labels.label[item.mesh.source_of(f)];
            item.label[f] = label < 0 ? -1 : index[label];
        }
        corpus.meshes.push_back(std::move(item));
    }
    return corpus;
}

namespace {

/// Gives polygons without a triangle (fewer than three corners) the label of the polygon before them in the file,
/// or, at its beginning, that of the one after: the benchmark's label files cannot leave a face out.
template <typename Votes>
void label_cornerless(const std::vector<Votes>& votes, std::vector<std::int32_t>& label) {
    for (std::size_t s = 1; s < label.size(); ++s)
        if (votes[s].empty()) label[s] = label[s - 1];
    for (std::size_t s = label.size(); s-- > 1;)
        if (votes[s - 1].empty() && label[s - 1] < 0) label[s - 1] = label[s];
}

}  // namespace

LabeledCorpus with_label_order(LabeledCorpus corpus, std::vector<std::string> names) {
    std::vector<std::int32_t> position;
    for (const std::string& name : corpus.names) {
        const auto found = std::find(names.begin(), names.end(), name);
        position.push_back(static_cast<std::int32_t>(found - names.begin()));
        if (found == names.end()) names.push_back(name);
    }
    for (LabeledMesh& mesh : corpus.meshes)
        for (std::int32_t& label : mesh.label)
            if (label >= 0) label = position[static_cast<std::size_t>(label)];
    corpus.names = std::move(names);
    return corpus;
}

std::vector<std::int32_t> to_source_faces(const TriangleMesh& mesh, std::span<const std::int32_t> triangle_label) {
    if (mesh.source_face.empty()) return {triangle_label.begin(), triangle_label.end()};
    const std::vector<float> area = face_areas(mesh);
    std::vector<std::map<std::int32_t, float>> votes(mesh.source_face_count);
    for (std::uint32_t f = 0; f < mesh.face_count(); ++f)
        votes[mesh.source_of(f)][triangle_label[f]] += area[f] + 1e-30F;
    std::vector<std::int32_t> label(mesh.source_face_count, -1);
    for (std::size_t s = 0; s < votes.size(); ++s)
        for (float best = -1; const auto& [candidate, weight] : votes[s])
            if (weight > best) best = weight, label[s] = candidate;
    label_cornerless(votes, label);
    return label;
}

}  // namespace exemplar
