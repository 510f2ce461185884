#include "host/parts/splitting/part_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <set>

#include "host/core/errors.h"
#include "host/mesh/io/io.h"

namespace exemplar {
namespace {

constexpr std::array<std::string_view, 4> k_part_formats{"obj", "ply", "stl", "glb"};

/// Returns the part's name without characters that are unsafe in file names, different from all in `taken`.
std::string file_name_of_part(const std::string& name, std::set<std::string>& taken) {
    std::string safe;
    for (const char c : name) {
        const bool is_letter = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
        safe += is_letter || (c >= '0' && c <= '9') || c == '-' || c == '.' || c == '_' ? c : '_';
    }
    constexpr std::size_t k_longest = 100;
    safe = safe.substr(0, k_longest);
    std::string found = safe;
    for (int i = 2; !taken.insert(found).second; ++i) found = fmt::format("{}_{}", safe, i);
    return found;
}

void write_part(const std::filesystem::path& path, const std::string& format, const TriangleMesh& mesh) {
    if (format == "obj") return write_obj(path, mesh);
    if (format == "ply") return write_ply(path, mesh);
    write_stl(path, mesh);
}

}  // namespace

std::span<const std::string_view> part_formats() {
    return k_part_formats;
}

std::vector<std::filesystem::path> write_parts(const std::filesystem::path& stem, const std::string& format,
                                               const MeshParts& names, std::span<const PartMesh> parts) {
    if (std::ranges::find(k_part_formats, format) == k_part_formats.end())
        throw UsageError(fmt::format("parts are written as {}, not as {}", fmt::join(k_part_formats, ", "), format));
    if (format == "glb") {
        const std::filesystem::path path = stem.string() + ".glb";
        write_parts_gltf(path, names, parts);
        return {path};
    }
    std::vector<std::filesystem::path> files;
    std::set<std::string> taken;
    for (std::size_t p = 0; p < parts.size(); ++p) {
        const std::string name = file_name_of_part(names.names[p], taken);
        files.emplace_back(fmt::format("{}_{}.{}", stem.string(), name, format));
        write_part(files.back(), format, parts[p].mesh);
    }
    return files;
}

}  // namespace exemplar
