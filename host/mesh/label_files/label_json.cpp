// Labels in JSON: names with an index per face, or numbers per vertex as in 3DTeethSeg (Ben-Hamadou et al. 2023).
#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>

#include "host/core/disjoint_sets.h"
#include "host/core/errors.h"
#include "host/core/json_text.h"
#include "host/mesh/io/io_formats.h"
#include "host/mesh/io/io_text.h"
#include "host/mesh/label_files/label_formats.h"
#include "host/mesh/label_files/vertex_labels.h"
#include "host/mesh/topology.h"

namespace exemplar::label_files {
namespace {

using LabelJson = nlohmann::json;

LabelJson parse_labels(std::string_view content, const std::string& name) {
    constexpr int k_deepest = 16;
    // Only the first levels matter; deeper ones would exhaust the stack.
    const auto depth_limit = [&](int depth, LabelJson::parse_event_t, LabelJson&) {
        if (depth > k_deepest) fail(name, "the JSON is nested too deep for labels");
        return true;
    };
    try {
        LabelJson json = parse_json(mesh_io::without_mark(content), depth_limit);
        if (!json.is_object()) fail(name, "the JSON of labels must be an object with 'labels'");
        return json;
    } catch (const LabelJson::parse_error& error) {
        fail(name, fmt::format("byte {}: the JSON is malformed or cut off", error.byte));
    } catch (const LabelJson::exception&) {
        fail(name, "the JSON has a number that is too large");
    }
}

std::vector<std::int64_t> numbers_of(const LabelJson& list, const char* key, const std::string& name) {
    std::vector<std::int64_t> numbers;
    numbers.reserve(list.size());
    for (std::size_t i = 0; i < list.size(); ++i) {
        const LabelJson& value = list[i];
        if (!value.is_number_integer() || value < -1 || value > std::numeric_limits<std::int32_t>::max())
            fail(name, fmt::format("entry {} of '{}' is no label number", i, key));
        numbers.push_back(value.get<std::int64_t>());
    }
    return numbers;
}

std::vector<std::string> names_of(const LabelJson& list, const char* key, const std::string& name) {
    std::vector<std::string> names;
    names.reserve(list.size());
    for (std::size_t i = 0; i < list.size(); ++i) {
        if (!list[i].is_string() || !mesh_io::is_label_name(list[i].get_ref<const std::string&>()))
            fail(name, fmt::format("entry {} of '{}' is no name that a label can have", i, key));
        names.push_back(list[i].get<std::string>());
    }
    return names;
}

FaceLabels labels_with_names(const LabelJson& json, const TriangleMesh& mesh, const std::string& name) {
    FaceLabels labels{names_of(json["labels"], "labels", name), {}};
    const auto faces = json.find("faces");
    if (faces == json.end() || !faces->is_array()) fail(name, "has names of labels, but no list 'faces'");
    if (faces->size() != mesh_io::source_faces(mesh))
        fail(name, fmt::format("labels {} faces, but the mesh has {}", faces->size(), mesh_io::source_faces(mesh)));
    labels.label.reserve(faces->size());
    for (const std::int64_t number : numbers_of(*faces, "faces", name)) {
        if (number >= static_cast<std::int64_t>(labels.names.size()))
            fail(name, fmt::format("a face has label {}, but there are {} names", number, labels.names.size()));
        labels.label.push_back(static_cast<std::int32_t>(number));
    }
    return labels;
}

/// The connected piece of equal label of each face, numbered in order of the first face.
std::vector<std::uint32_t> pieces_of_faces(const TriangleMesh& mesh, const FaceLabels& labels) {
    DisjointSets sets(labels.label.size());
    for (const Edge& edge : build_topology(mesh).edges) {
        if (edge.is_boundary()) continue;
        const std::uint32_t a = mesh.source_of(edge.face[0]), b = mesh.source_of(edge.face[1]);
        if (labels.label[a] == labels.label[b]) sets.join(a, b);
    }
    std::vector<std::uint32_t> piece(labels.label.size());
    std::uint32_t count = 0;
    for (std::uint32_t f = 0; f < piece.size(); ++f) {
        const std::uint32_t first = sets.find(f);
        piece[f] = first == f ? count++ : piece[first];
    }
    return piece;
}

/// The values of labels in files of vertices: their names if all are numbers, else their indices.
std::vector<std::int64_t> values_of_labels(const std::vector<std::string>& names) {
    std::vector<std::int64_t> values(names.size());
    bool all_numbers = true;
    for (std::size_t i = 0; i < names.size(); ++i) {
        const auto number = mesh_io::parse_integer(names[i]);
        all_numbers = all_numbers && number && *number >= 0;
        values[i] = number.value_or(0);
    }
    for (std::size_t i = 0; i < names.size() && !all_numbers; ++i) values[i] = static_cast<std::int64_t>(i);
    return values;
}

}  // namespace

FaceLabels read_json_labels(std::string_view content, const TriangleMesh& mesh, const std::string& name) {
    const LabelJson json = parse_labels(content, name);
    const auto labels = json.find("labels");
    const bool is_list = labels != json.end() && labels->is_array();
    if (!is_list || (labels->empty() && !json.contains("faces"))) fail(name, "has no list 'labels'");
    if (labels->empty() || labels->front().is_string()) return labels_with_names(json, mesh, name);
    std::vector<std::string> names;
    if (const auto found = json.find("names"); found != json.end() && found->is_array())
        names = names_of(*found, "names", name);
    const auto is_number = [](const std::string& word) { return mesh_io::parse_integer(word).has_value(); };
    if (std::ranges::all_of(names, is_number)) names.clear();  // the labels are these numbers, not their indices
    return labels_of_numbers(numbers_of(*labels, "labels", name), names, mesh, name);
}

std::string json_of_labels(const TriangleMesh& mesh, const FaceLabels& labels) {
    const nlohmann::ordered_json json{
        {"labels", labels.names}, {"faces", labels.label}, {"instances", pieces_of_faces(mesh, labels)}};
    return ordered_json_text(json) + "\n";
}

std::string json_of_vertices(const TriangleMesh& mesh, const FaceLabels& labels) {
    const std::vector<std::int32_t> label = labels_of_vertices(mesh, labels.label);
    const std::vector<std::uint32_t> piece = pieces_of_faces(mesh, labels);
    // A vertex belongs to the piece of a face at it that has its label.
    std::vector<std::int64_t> instances(label.size(), -1), values(label.size(), -1);
    for (std::uint32_t f = 0; f < mesh.face_count(); ++f)
        for (const std::uint32_t v : mesh.faces[f])
            if (instances[v] < 0 && label[v] >= 0 && label[v] == labels.label[mesh.source_of(f)])
                instances[v] = piece[mesh.source_of(f)];
    const std::vector<std::int64_t> value = values_of_labels(labels.names);
    for (std::size_t v = 0; v < label.size(); ++v)
        if (label[v] >= 0) values[v] = value[static_cast<std::size_t>(label[v])];
    const nlohmann::ordered_json json{{"labels", values}, {"instances", instances}, {"names", labels.names}};
    return ordered_json_text(json) + "\n";
}

}  // namespace exemplar::label_files
