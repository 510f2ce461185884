#include "host/data/result_cache.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <xxhash.h>

#include <cstdlib>
#include <memory>
#include <nlohmann/json.hpp>
#include <system_error>
#include <utility>

#include "host/core/errors.h"

namespace exemplar {
namespace {

namespace fs = std::filesystem;

using HashState = std::unique_ptr<XXH3_state_t, decltype(&XXH3_freeState)>;

HashState new_state() {
    return {XXH3_createState(), XXH3_freeState};
}

/// Returns the checksum of everything but itself; it detects even one changed byte of the data.
std::string checksum(const TensorFile& file) {
    const HashState state = new_state();
    XXH3_64bits_reset(state.get());
    for (const auto& [key, value] : file.metadata)
        if (key != "checksum") XXH3_64bits_update(state.get(), value.data(), value.size());
    for (const auto& [name, tensor] : file.tensors)
        XXH3_64bits_update(state.get(), tensor.bytes.data(), tensor.bytes.size());
    return fmt::format("{:016x}", XXH3_64bits_digest(state.get()));
}

/// Sets the time of last use to now. Has no effect in a read-only folder or one that others own.
void mark_as_used(const fs::path& path) {
    utimensat(AT_FDCWD, path.c_str(), nullptr, 0);
}

std::uint64_t bytes_of(const TensorFile& file) {
    std::uint64_t bytes = 0;
    for (const auto& [name, tensor] : file.tensors) bytes += tensor.bytes.size();
    return bytes;
}

/// Returns whether to trim the folder after this entry.
bool is_time_to_trim(const fs::path& path, std::uint64_t bytes, std::uint64_t max_bytes) {
    const std::string name = path.filename().string();
    return bytes >= max_bytes / 100 || XXH3_64bits(name.data(), name.size()) % 16 == 0;
}

}  // namespace

fs::path default_cache_folder(std::string_view kind) {
    if (const char* cache = std::getenv("XDG_CACHE_HOME"); cache && *cache) return fs::path(cache) / "exemplar" / kind;
    if (const char* home = std::getenv("HOME"); home && *home) return fs::path(home) / ".cache" / "exemplar" / kind;
    return {};
}

std::string content_hash(const TriangleMesh& mesh) {
    const HashState state = new_state();
    XXH3_128bits_reset(state.get());
    XXH3_128bits_update(state.get(), mesh.vertices.data(), mesh.vertices.size() * sizeof(Vec3));
    XXH3_128bits_update(state.get(), mesh.faces.data(), mesh.faces.size() * sizeof(Face));
    const XXH128_hash_t hash = XXH3_128bits_digest(state.get());
    return fmt::format("{:016x}{:016x}", hash.high64, hash.low64);
}

bool read_cache_entry(const fs::path& path, int version, const std::function<void(const TensorFile&)>& parse) {
    std::error_code unreadable;
    if (!fs::is_regular_file(path, unreadable)) return false;
    try {
        const TensorFile file = map_safetensors(path);
        if (file.meta("version") != std::to_string(version)) return false;
        if (file.meta("checksum") != checksum(file)) return false;
        parse(file);
        mark_as_used(path);
        return true;
    } catch (const ModelError&) {
        return false;
    } catch (const nlohmann::json::exception&) {
        return false;
    }
}

void write_cache_entry(const fs::path& path, int version, TensorFile file, std::uint64_t max_bytes) {
    const std::uint64_t bytes = bytes_of(file);
    if (bytes > max_bytes || max_bytes == 0) return;
    file.metadata["version"] = std::to_string(version);
    file.metadata["checksum"] = checksum(file);
    try {
        write_safetensors(path, file);
    } catch (const DataError&) {
        return;  // it is computed again next time
    }
    if (is_time_to_trim(path, bytes, max_bytes)) trim_cache(path.parent_path(), max_bytes, path);
}

}  // namespace exemplar
