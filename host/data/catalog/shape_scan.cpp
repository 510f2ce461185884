#include "host/data/catalog/shape_scan.h"

#include <fmt/format.h>
#include <xxhash.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <fstream>
#include <memory>
#include <new>
#include <vector>

#include "host/core/errors.h"
#include "host/core/interrupt.h"
#include "host/core/text.h"
#include "host/data/catalog/worker_folder.h"
#include "host/data/corpus.h"
#include "host/mesh/editing/validate.h"
#include "host/mesh/editing/weld.h"
#include "host/mesh/io/io.h"

namespace exemplar {
namespace {

namespace fs = std::filesystem;

/// Text takes more memory while it is parsed than as a file; binary files take less.
constexpr std::size_t k_memory_per_byte = 12;

bool is_hidden(const fs::path& path) {
    return path.filename().string().starts_with('.');
}

/// Returns whether a link in `root` or below leads to a file there.
bool stays_inside(const fs::path& link, const fs::path& root) {
    std::error_code error;
    const fs::path target = fs::canonical(link, error);
    if (error) return false;
    const fs::path relative = target.lexically_relative(fs::canonical(root, error));
    return !error && !relative.empty() && *relative.begin() != "..";
}

/// Returns whether batch labeling has written to a folder: its results are no shapes to label.
bool is_output_folder(const fs::path& folder) {
    std::error_code ignored;
    return fs::exists(folder / k_output_mark, ignored);
}

std::vector<fs::directory_entry> entries_of(const fs::path& folder, std::error_code& error) {
    std::vector<fs::directory_entry> entries;
    for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error))
        if (!is_hidden(it->path())) entries.push_back(*it);
    std::ranges::sort(entries, natural_less, [](const fs::directory_entry& entry) { return entry.path().string(); });
    return entries;
}

/// Returns whether an entry of a folder is a mesh to read. Does not follow links to folders, which may lead in
/// circles.
bool is_shape(const fs::directory_entry& entry, const fs::path& root, const SkipHandler& left_out) {
    std::error_code ignored;
    if (!is_mesh_file(entry.path()) || !entry.is_regular_file(ignored)) return false;
    if (!entry.is_symlink(ignored) || stays_inside(entry.path(), root)) return true;
    left_out(entry.path(), "leads out of the folder");
    return false;
}

/// Fills in everything that is known only from reading the mesh.
void describe(const fs::path& path, CatalogShape& shape) {
    const MeshFile file = read_mesh(path);
    shape.vertices = static_cast<std::int64_t>(file.mesh.vertex_count());
    shape.faces = static_cast<std::int64_t>(file.mesh.source_face_count);
    const MeshReport report = require_usable(welded(file.mesh), path.string());
    shape.components = static_cast<std::int64_t>(report.components);
    std::vector<std::string> warnings = file.warnings;
    for (std::string& message : report.messages()) warnings.push_back(std::move(message));
    shape.warnings = fmt::format("{}", fmt::join(warnings, "\n"));
}

}  // namespace

void find_shapes(const fs::path& folder, const std::function<void(const FoundShape&)>& found,
                 const SkipHandler& left_out) {
    const fs::path root = fs::absolute(folder).lexically_normal();
    if (is_output_folder(root))
        throw DataError(
            fmt::format("{}: was written to by batch labeling, and results are no shapes; if it holds shapes as well, "
                        "remove {} from it",
                        folder.string(), k_output_mark));
    std::vector<fs::path> open{root};
    while (!open.empty()) {
        check_interrupt();
        const fs::path here = std::move(open.back());
        open.pop_back();
        if (is_output_folder(here)) continue;
        std::vector<fs::path> below;
        std::error_code error;
        const std::vector<fs::directory_entry> entries = entries_of(here, error);
        const std::string why = error ? "cannot be read: " + error.message() : "";
        if (error && here == root) throw DataError(fmt::format("{}: {}", folder.string(), why));
        if (error) left_out(here, why);
        for (const fs::directory_entry& entry : entries) {
            std::error_code ignored;
            if (entry.is_directory(ignored) && !entry.is_symlink(ignored))
                below.push_back(entry.path());
            else if (is_shape(entry, root, left_out))
                found({entry.path(), entry.path().lexically_relative(root)});
        }
        open.insert(open.end(), below.rbegin(), below.rend());  // the first is searched next
    }
}

std::string file_hash(const fs::path& path) {
    const std::unique_ptr<XXH3_state_t, decltype(&XXH3_freeState)> state(XXH3_createState(), XXH3_freeState);
    XXH3_128bits_reset(state.get());
    errno = 0;
    std::ifstream file(path, std::ios::binary);
    std::vector<char> piece(std::size_t{1} << 20);
    while (file) {
        check_interrupt();
        file.read(piece.data(), static_cast<std::streamsize>(piece.size()));
        XXH3_128bits_update(state.get(), piece.data(), static_cast<std::size_t>(file.gcount()));
    }
    if (!file.eof())
        throw DataError(fmt::format("{}: cannot be read: {}", path.string(), std::strerror(errno ? errno : EIO)));
    const XXH128_hash_t hash = XXH3_128bits_digest(state.get());
    return fmt::format("{:016x}{:016x}", hash.high64, hash.low64);
}

std::size_t reading_memory(std::uint64_t file_bytes) {
    return k_memory_per_byte * file_bytes;
}

std::uint64_t bytes_to_read(const fs::path& path, std::size_t max_memory) {
    auto bytes = static_cast<std::uint64_t>(stat_shape(path).bytes);
    if (reading_memory(bytes) <= max_memory) bytes += external_buffer_bytes(path);
    if (reading_memory(bytes) > max_memory)
        throw MeshError(
            fmt::format("{}: {:.1f} GB are more than can be read in {:.1f} GB of memory; --memory allows more",
                        path.string(), 1e-9 * static_cast<double>(bytes), 1e-9 * static_cast<double>(max_memory)));
    return bytes;
}

CatalogShape stat_shape(const fs::path& path) {
    std::error_code error;
    CatalogShape shape;
    shape.path = path;
    const bool regular = fs::is_regular_file(path, error);
    if (!error && !regular) throw DataError(path.string() + ": is no file");
    const auto modified = error ? fs::file_time_type() : fs::last_write_time(path, error);
    const auto bytes = error ? 0 : fs::file_size(path, error);
    if (error) throw DataError(fmt::format("{}: cannot be read: {}", path.string(), error.message()));
    shape.bytes = static_cast<std::int64_t>(bytes);
    shape.modified = std::chrono::duration_cast<std::chrono::nanoseconds>(modified.time_since_epoch()).count();
    return shape;
}

CatalogShape describe_shape(const fs::path& path, std::size_t max_memory) {
    CatalogShape shape;
    shape.path = path;
    try {
        shape = stat_shape(path);
        bytes_to_read(path, max_memory);
        shape.hash = file_hash(path);
        describe(path, shape);
    } catch (const std::bad_alloc&) {
        shape.problem = path.string() + ": there is not enough memory to read it";
    } catch (const Interrupted&) {
        throw;
    } catch (const Error& error) {
        shape.problem = error.what();
    }
    return shape;
}

}  // namespace exemplar
