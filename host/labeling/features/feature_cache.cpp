#include "host/labeling/features/feature_cache.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <string>
#include <utility>

#include "host/core/json_text.h"
#include "host/data/result_cache.h"

namespace exemplar {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

template <typename T>
std::vector<T> flatten(const std::vector<std::array<T, 2>>& pairs) {
    std::vector<T> flat;
    flat.reserve(2 * pairs.size());
    for (const auto& pair : pairs) flat.insert(flat.end(), pair.begin(), pair.end());
    return flat;
}

TensorFile features_to_file(const MeshFeatures& features) {
    TensorFile file;
    file.metadata["unary"] = json_text(Json(features.unary.names));
    file.metadata["pairwise"] = json_text(Json(features.pairwise.names));
    file.metadata["seconds"] = json_text(Json(features.seconds));
    file.add("unary", {features.unary.cols(), features.unary.rows}, features.unary.values);
    file.add("pairwise", {features.pairwise.cols(), features.pairwise.rows}, features.pairwise.values);
    const ContextGeometry& context = features.context;
    file.add("context.sample_face", {context.sample_face.size()}, context.sample_face);
    file.add("context.sample_area", {context.sample_area.size()}, context.sample_area);
    file.add("context.geodesic_bin", {context.sample_face.size(), context.faces}, context.geodesic_bin);
    file.add("context.axis_position", {k_context_axes, context.faces}, context.axis_position);
    file.add("context.axis_edges", {k_context_axes, k_context_bins - 1},
             std::span<const float>(context.axis_edges.front().data(), k_context_axes * (k_context_bins - 1)));
    file.add("edge_context.begin", {features.edge_context.begin.size()}, features.edge_context.begin);
    file.add("edge_context.edge", {features.edge_context.edge.size()}, features.edge_context.edge);
    file.add("edge_context.bin", {features.edge_context.bin.size()}, features.edge_context.bin);
    file.add("position", {3, features.unary.rows}, features.position);
    file.add("face_area", {features.face_area.size()}, features.face_area);
    file.add("edges", {features.edges.size(), 2}, flatten(features.edges));
    file.add("edge_length", {features.edge_length.size()}, features.edge_length);
    file.add("dihedral", {features.dihedral.size()}, features.dihedral);
    return file;
}

/// Room for the coordinates and contextual features that later stages append without moving the others; with more
/// labels they are moved once.
constexpr std::size_t k_unary_room = 3 + 16 * k_context_measures * k_context_bins;
constexpr std::size_t k_pairwise_room = EdgeNeighborhood::k_bins;

FeatureMatrix matrix_from(const TensorFile& file, const std::string& name, std::size_t rows, std::size_t room) {
    FeatureMatrix matrix;
    matrix.rows = rows;
    matrix.names = parse_json(file.meta(name)).get<std::vector<std::string>>();
    matrix.values = file.get<float>(name, {matrix.cols(), rows}, room * rows);
    return matrix;
}

MeshFeatures features_from_file(const TensorFile& file, std::size_t faces) {
    MeshFeatures features;
    features.face_area = file.get<float>("face_area", {faces});
    features.position = file.get<float>("position", {3, faces});
    const auto edges = file.get<std::uint32_t>("edges", {TensorFile::k_any, 2});
    for (std::size_t e = 0; e < edges.size(); e += 2) features.edges.push_back({edges[e], edges[e + 1]});
    const std::size_t edge_count = features.edges.size();
    features.edge_length = file.get<float>("edge_length", {edge_count});
    features.dihedral = file.get<float>("dihedral", {edge_count});
    features.unary = matrix_from(file, "unary", faces, k_unary_room);
    features.pairwise = matrix_from(file, "pairwise", edge_count, k_pairwise_room);
    features.seconds = parse_json(file.meta("seconds")).get<std::vector<std::pair<std::string, double>>>();

    ContextGeometry& context = features.context;
    context.faces = faces;
    context.sample_face = file.get<std::uint32_t>("context.sample_face", {TensorFile::k_any});
    const std::size_t samples = context.sample_face.size();
    context.sample_area = file.get<float>("context.sample_area", {samples});
    context.geodesic_bin = file.get<std::uint8_t>("context.geodesic_bin", {samples, faces});
    context.axis_position = file.get<float>("context.axis_position", {k_context_axes, faces});
    const auto axis_edges = file.get<float>("context.axis_edges", {k_context_axes, k_context_bins - 1});
    std::copy(axis_edges.begin(), axis_edges.end(), context.axis_edges.front().data());

    features.edge_context.begin = file.get<std::uint32_t>("edge_context.begin", {edge_count + 1});
    const std::size_t neighbors = features.edge_context.begin.back();
    features.edge_context.edge = file.get<std::uint32_t>("edge_context.edge", {neighbors});
    features.edge_context.bin = file.get<std::uint8_t>("edge_context.bin", {neighbors});
    return features;
}

}  // namespace

fs::path default_feature_folder() {
    return default_cache_folder("features");
}

std::string feature_entry_name(const TriangleMesh& mesh, const FeatureOptions& options) {
    return fmt::format("{}-v{}-s{}{}.safetensors", content_hash(mesh), k_feature_version, options.samples,
                       options.orientation ? "-oriented" : "");
}

std::optional<MeshFeatures> find_cached_features(const TriangleMesh& mesh, const FeatureOptions& options,
                                                 const fs::path& folder) {
    MeshFeatures features;
    const auto parse = [&](const TensorFile& file) { features = features_from_file(file, mesh.face_count()); };
    if (folder.empty() || !read_cache_entry(folder / feature_entry_name(mesh, options), k_feature_version, parse))
        return {};
    return features;
}

MeshFeatures cached_features(const TriangleMesh& mesh, const FeatureOptions& options, const fs::path& folder) {
    if (folder.empty()) return compute_features(mesh, options);
    if (std::optional<MeshFeatures> known = find_cached_features(mesh, options, folder)) return std::move(*known);
    MeshFeatures features = compute_features(mesh, options);
    write_cache_entry(folder / feature_entry_name(mesh, options), k_feature_version, features_to_file(features));
    return features;
}

}  // namespace exemplar
