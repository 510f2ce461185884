#include "host/hatching/features/surface_cache.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "host/core/json_text.h"
#include "host/core/parallel.h"
#include "host/data/result_cache.h"

namespace exemplar {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

// Ranges of distances take up most of an entry. As digits of a number, three of them fit into a byte.
constexpr std::uint32_t k_range_values = k_context_ranges + 1;
constexpr std::size_t k_ranges_per_byte = 3;
static_assert(k_range_values * k_range_values * k_range_values <= 256);
constexpr std::size_t k_block = 1 << 16;  // bytes per task

std::size_t packed_size(std::size_t ranges) {
    return (ranges + k_ranges_per_byte - 1) / k_ranges_per_byte;
}

std::vector<std::uint8_t> packed_ranges(std::span<const std::uint8_t> ranges) {
    std::vector<std::uint8_t> packed(packed_size(ranges.size()));
    const auto digit = [&](std::size_t i) { return i < ranges.size() ? std::uint32_t{ranges[i]} : 0U; };
    parallel_for(
        packed.size(),
        [&](std::size_t b) {
            const std::size_t i = b * k_ranges_per_byte;
            packed[b] =
                static_cast<std::uint8_t>(digit(i) + k_range_values * (digit(i + 1) + k_range_values * digit(i + 2)));
        },
        k_block);
    return packed;
}

std::vector<std::uint8_t> unpacked_ranges(std::span<const std::uint8_t> packed, std::size_t count) {
    std::array<std::array<std::uint8_t, k_ranges_per_byte>, 256> digits{};
    for (std::uint32_t byte = 0; byte < digits.size(); ++byte)
        for (std::uint32_t k = 0, rest = byte; k < k_ranges_per_byte; ++k, rest /= k_range_values)
            digits[byte][k] = static_cast<std::uint8_t>(rest % k_range_values);
    std::vector<std::uint8_t> ranges(packed.size() * k_ranges_per_byte);
    parallel_for(
        packed.size(),
        [&](std::size_t b) {
            std::ranges::copy(digits[packed[b]], ranges.begin() + static_cast<std::ptrdiff_t>(b * k_ranges_per_byte));
        },
        k_block);
    ranges.resize(count);
    return ranges;
}

/// The type of the numbers that a row holds: a vector, an array, or a number itself.
template <typename Row>
struct Components {
    using Type = Row;
};
template <>
struct Components<Vec3> {
    using Type = float;
};
template <typename T, std::size_t N>
struct Components<std::array<T, N>> {
    using Type = T;
};
template <typename Row>
constexpr std::size_t k_width = sizeof(Row) / sizeof(typename Components<Row>::Type);

/// Adds arrays to an entry.
struct EntryWriter {
    template <typename Row>
    void rows(const std::string& name, const std::vector<Row>& values, std::size_t /*count*/) {
        using T = typename Components<Row>::Type;
        file.add(name, {values.size(), k_width<Row>},
                 std::span<const T>(reinterpret_cast<const T*>(values.data()), values.size() * k_width<Row>));
    }
    TensorFile& file;
};

/// Reads arrays of `count` rows from an entry; throws ModelError if one has another number of rows.
struct EntryReader {
    template <typename Row>
    void rows(const std::string& name, std::vector<Row>& values, std::size_t count) {
        using T = typename Components<Row>::Type;
        const std::vector<T> numbers = file.get<T>(name, {count, k_width<Row>});
        values.resize(numbers.size() / k_width<Row>);
        if (!values.empty()) std::memcpy(static_cast<void*>(values.data()), numbers.data(), numbers.size() * sizeof(T));
    }
    const TensorFile& file;
};

template <typename Entry, typename Curvature>
void transfer_curvature(Entry& entry, const std::string& name, Curvature& c, std::size_t vertices) {
    entry.rows(name + ".k1", c.k1, vertices);
    entry.rows(name + ".k2", c.k2, vertices);
    entry.rows(name + ".e1", c.e1, vertices);
    entry.rows(name + ".e2", c.e2, vertices);
    entry.rows(name + ".derivative", c.derivative, vertices);
}

/// Transfers all arrays but the ranges of distances. Writing and reading share this code, so that neither forgets
/// one.
template <typename Entry, typename Surface>
void transfer_arrays(Entry& entry, Surface& surface, std::size_t faces, std::size_t vertices) {
    entry.rows("faces", surface.mesh.faces, faces);
    entry.rows("normals", surface.normals, vertices);
    entry.rows("neighbors", surface.neighbors, faces);
    entry.rows("descriptors", surface.descriptors.values, surface.descriptors.cols() * vertices);
    entry.rows("occlusion.ambient", surface.occlusion.ambient, vertices);
    entry.rows("occlusion.visibility", surface.occlusion.visibility, vertices);
    entry.rows("occlusion.transfer", surface.occlusion.transfer, vertices);
    entry.rows("sample_face", surface.sample_face, TensorFile::k_any);
    entry.rows("face_sample", surface.face_sample, faces);
    transfer_curvature(entry, "line_curvature", surface.line_curvature, vertices);
    for (std::size_t s = 0; s < surface.curvature.size(); ++s)
        transfer_curvature(entry, fmt::format("curvature.{}", s), surface.curvature[s], vertices);
    auto& directions = surface.directions;
    for (std::size_t s = 0; s < directions.k_max.size(); ++s) {
        entry.rows(fmt::format("k_max.{}", s), directions.k_max[s], vertices);
        entry.rows(fmt::format("k_min.{}", s), directions.k_min[s], vertices);
    }
    for (std::size_t s = 0; s < directions.e_a.size(); ++s) {
        entry.rows(fmt::format("e_a.{}", s), directions.e_a[s], vertices);
        entry.rows(fmt::format("e_b.{}", s), directions.e_b[s], vertices);
    }
    entry.rows("ridges", directions.ridges, vertices);
    entry.rows("valleys", directions.valleys, vertices);
}

TensorFile to_file(const HatchingSurface& surface) {
    TensorFile file;
    file.metadata["descriptors"] = json_text(Json(surface.descriptors.names));
    file.metadata["seconds"] = json_text(Json(surface.seconds));
    EntryWriter writer{file};
    transfer_arrays(writer, surface, surface.mesh.face_count(), surface.mesh.vertex_count());
    file.add("sizes", {2}, std::vector<float>{surface.unit, surface.feature_size});
    const std::vector<std::uint8_t> packed = packed_ranges(surface.sample_bin);
    file.add("sample_bin", {packed.size()}, packed);
    return file;
}

/// Takes the vertices from `mesh`, whose hash is in the entry's name.
HatchingSurface from_file(const TensorFile& file, const TriangleMesh& mesh) {
    HatchingSurface surface;
    surface.mesh = mesh;
    const std::size_t faces = mesh.face_count(), vertices = mesh.vertex_count();
    surface.descriptors.rows = vertices;
    surface.descriptors.names = parse_json(file.meta("descriptors")).get<std::vector<std::string>>();
    surface.seconds = parse_json(file.meta("seconds")).get<std::vector<std::pair<std::string, double>>>();
    EntryReader reader{file};
    transfer_arrays(reader, surface, faces, vertices);
    const std::vector<float> sizes = file.get<float>("sizes", {2});
    surface.unit = sizes[0];
    surface.feature_size = sizes[1];
    const std::size_t ranges = surface.sample_face.size() * faces;
    surface.sample_bin = unpacked_ranges(file.get<std::uint8_t>("sample_bin", {packed_size(ranges)}), ranges);
    return surface;
}

}  // namespace

fs::path default_surface_folder() {
    return default_cache_folder("surfaces");
}

HatchingSurface cached_surface(const TriangleMesh& mesh, const fs::path& folder) {
    if (folder.empty()) return measure_surface(mesh);
    const fs::path path = folder / fmt::format("{}-v{}.safetensors", content_hash(mesh), k_surface_version);
    HatchingSurface surface;
    if (read_cache_entry(path, k_surface_version, [&](const TensorFile& file) { surface = from_file(file, mesh); }))
        return surface;
    surface = measure_surface(mesh);
    write_cache_entry(path, k_surface_version, to_file(surface));
    return surface;
}

}  // namespace exemplar
