#include "host/labeling/feature_cache.h"

#include <fmt/format.h>
#include <xxhash.h>

#include <cstdlib>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <system_error>
#include <utility>

#include "host/core/errors.h"
#include "host/data/safetensors.h"

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

TensorFile to_file(const MeshFeatures& features) {
    TensorFile file;
    file.metadata["version"] = std::to_string(k_feature_version);
    file.metadata["unary"] = Json(features.unary.names).dump();
    file.metadata["pairwise"] = Json(features.pairwise.names).dump();
    file.metadata["seconds"] = Json(features.seconds).dump();
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
    file.add("face_area", {features.face_area.size()}, features.face_area);
    file.add("edges", {features.edges.size(), 2}, flatten(features.edges));
    file.add("edge_length", {features.edge_length.size()}, features.edge_length);
    file.add("dihedral", {features.dihedral.size()}, features.dihedral);
    return file;
}

/// Contextual features that later stages add without moving the others; with more labels they are moved once.
constexpr std::size_t k_unary_room = 16 * k_context_measures * k_context_bins;
constexpr std::size_t k_pairwise_room = EdgeNeighborhood::k_bins;

FeatureMatrix matrix_from(const TensorFile& file, const std::string& name, std::size_t rows, std::size_t room) {
    FeatureMatrix matrix;
    matrix.rows = rows;
    matrix.names = Json::parse(file.meta(name)).get<std::vector<std::string>>();
    matrix.values = file.get<float>(name, {matrix.cols(), rows}, room * rows);
    return matrix;
}

MeshFeatures from_file(const TensorFile& file, std::size_t faces) {
    MeshFeatures features;
    features.face_area = file.get<float>("face_area", {faces});
    const auto edges = file.get<std::uint32_t>("edges", {TensorFile::k_any, 2});
    for (std::size_t e = 0; e < edges.size(); e += 2) features.edges.push_back({edges[e], edges[e + 1]});
    const std::size_t edge_count = features.edges.size();
    features.edge_length = file.get<float>("edge_length", {edge_count});
    features.dihedral = file.get<float>("dihedral", {edge_count});
    features.unary = matrix_from(file, "unary", faces, k_unary_room);
    features.pairwise = matrix_from(file, "pairwise", edge_count, k_pairwise_room);
    features.seconds = Json::parse(file.meta("seconds")).get<std::vector<std::pair<std::string, double>>>();

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

/// The checksum of everything but itself, so that a flipped byte in the data is noticed too.
std::string checksum(const TensorFile& file) {
    const std::unique_ptr<XXH3_state_t, decltype(&XXH3_freeState)> state(XXH3_createState(), XXH3_freeState);
    XXH3_64bits_reset(state.get());
    for (const auto& [key, value] : file.metadata)
        if (key != "checksum") XXH3_64bits_update(state.get(), value.data(), value.size());
    for (const auto& [name, tensor] : file.tensors)
        XXH3_64bits_update(state.get(), tensor.bytes.data(), tensor.bytes.size());
    return fmt::format("{:016x}", XXH3_64bits_digest(state.get()));
}

}  // namespace

std::string content_hash(const TriangleMesh& mesh) {
    const std::unique_ptr<XXH3_state_t, decltype(&XXH3_freeState)> state(XXH3_createState(), XXH3_freeState);
    XXH3_128bits_reset(state.get());
    XXH3_128bits_update(state.get(), mesh.vertices.data(), mesh.vertices.size() * sizeof(Vec3));
    XXH3_128bits_update(state.get(), mesh.faces.data(), mesh.faces.size() * sizeof(Face));
    const XXH128_hash_t hash = XXH3_128bits_digest(state.get());
    return fmt::format("{:016x}{:016x}", hash.high64, hash.low64);
}

fs::path default_feature_folder() {
    if (const char* cache = std::getenv("XDG_CACHE_HOME"); cache && *cache)
        return fs::path(cache) / "exemplar" / "features";
    if (const char* home = std::getenv("HOME"); home && *home)
        return fs::path(home) / ".cache" / "exemplar" / "features";
    return {};
}

namespace {

/// The features in a cache entry; nothing if there is no entry, or one that is damaged or of another version.
std::optional<MeshFeatures> read_entry(const fs::path& path, std::size_t faces) {
    std::error_code unreadable;
    if (!fs::is_regular_file(path, unreadable)) return std::nullopt;
    try {
        const TensorFile file = map_safetensors(path);
        if (file.meta("version") != std::to_string(k_feature_version)) return std::nullopt;
        if (file.meta("checksum") != checksum(file)) return std::nullopt;
        return from_file(file, faces);
    } catch (const ModelError&) {
        return std::nullopt;
    } catch (const Json::exception&) {
        return std::nullopt;
    }
}

void write_entry(const fs::path& path, const MeshFeatures& features) {
    TensorFile file = to_file(features);
    file.metadata["checksum"] = checksum(file);
    try {
        write_safetensors(path, file);
    } catch (const DataError&) {
        // A read-only folder or a full disk must not cost the result: next time it is computed again.
    }
}

}  // namespace

MeshFeatures cached_features(const TriangleMesh& mesh, const FeatureOptions& options, const fs::path& folder) {
    if (folder.empty()) return compute_features(mesh, options);
    const fs::path path = folder / fmt::format("{}-v{}-s{}{}.safetensors", content_hash(mesh), k_feature_version,
                                               options.samples, options.orientation ? "-oriented" : "");
    if (std::optional<MeshFeatures> kept = read_entry(path, mesh.face_count())) return std::move(*kept);
    MeshFeatures features = compute_features(mesh, options);
    write_entry(path, features);
    return features;
}

}  // namespace exemplar
