#include "apps/exemplar/arguments.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <fstream>
#include <map>
#include <set>
#include <string>

#include "host/core/errors.h"
#include "host/core/files.h"
#include "host/data/cache_bound.h"
#include "host/data/corpus.h"
#include "host/labeling/inference/mesh_labeling.h"

namespace exemplar {
namespace {

namespace fs = std::filesystem;

/// The first bytes of a file; fewer if it is shorter, none if it cannot be read.
std::string first_bytes(const fs::path& path) {
    std::array<char, 4096> bytes{};
    std::ifstream stream(path, std::ios::binary);
    stream.read(bytes.data(), bytes.size());
    return {bytes.data(), static_cast<std::size_t>(stream.gcount())};
}

/// Returns what is wrong with a folder to write into, or "".
std::string why_not_writable(fs::path folder) {
    if (folder.empty()) folder = ".";
    std::error_code error;
    while (!fs::exists(folder, error)) {  // missing folders are made in the nearest one that exists
        const fs::path parent = folder.parent_path();
        if (parent == folder) break;
        folder = parent.empty() ? fs::path(".") : parent;
    }
    if (!fs::is_directory(folder, error)) return fmt::format("'{}' is no folder", folder.string());
    if (access(folder.c_str(), W_OK | X_OK) != 0) return fmt::format("folder '{}' is not writable", folder.string());
    return {};
}

}  // namespace

void require_input(const fs::path& path) {
    std::error_code ignored;  // for names that the system refuses there is no file
    if (fs::exists(path, ignored)) return;
    throw DataError(fmt::format("{}: no such file or folder{}", path.string(), suggest_file(path)));
}

std::vector<fs::path> meshes_of_argument(const fs::path& source, MissingMeshes missing) {
    require_input(source);
    const auto known = mesh_extensions();
    if (!is_mesh_file(source) && fs::is_regular_file(source) && first_bytes(source).find('\0') != std::string::npos)
        throw DataError(fmt::format("{}: is neither a mesh ({}) nor a list of meshes (text, a path a line)",
                                    source.string(), fmt::join(known, " ")));
    return list_meshes(source, missing);
}

std::vector<fs::path> meshes_of_arguments(const std::vector<fs::path>& sources) {
    std::vector<fs::path> meshes;
    std::set<fs::path> known;
    for (const auto& source : sources)
        for (const auto& mesh : meshes_of_argument(source))
            if (known.insert(fs::weakly_canonical(mesh)).second) meshes.push_back(mesh);
    return meshes;
}

std::vector<std::string> mesh_warnings(const MeshFile& file, const fs::path& path, bool quiet) {
    std::vector<std::string> warnings = file.warnings;
    for (std::string& message : labeling_warnings(file.mesh, path.string())) warnings.push_back(std::move(message));
    if (!quiet)
        for (const std::string& message : warnings) fmt::print(stderr, "warning: {}: {}\n", path.string(), message);
    return warnings;
}

LabelingModel model_of_argument(const fs::path& path) {
    require_input(path);
    // A safetensors file is the length of a JSON object, 8 bytes, and that object; the length is checked by the reader.
    if (const std::string begin = first_bytes(path); fs::is_directory(path) || begin.size() < 9 || begin[8] != '{')
        throw ModelError(
            fmt::format("{}: is no Exemplar model; make one with 'exemplar label train', and give it before the meshes",
                        path.string()));
    return load_model(path);
}

void require_output_file(const fs::path& path) {
    if (path.empty()) return;
    if (fs::is_directory(path) || !path.has_filename())
        throw UsageError(fmt::format("{}: is a folder; give the name of a file to write", path.string()));
    if (const std::string why = why_not_writable(path.parent_path()); !why.empty())
        throw UsageError(fmt::format("{}: cannot be written: {}", path.string(), why));
}

void require_output_folder(const fs::path& path) {
    if (path.empty()) throw UsageError("--out is empty; give a folder to write to");
    if (const std::string why = why_not_writable(path); !why.empty())
        throw UsageError(fmt::format("{}: cannot be written to: {}", path.string(), why));
}

void require_output_picture(const fs::path& path) {
    if (path.extension() != ".png")
        throw UsageError(fmt::format("{}: pictures are written as PNG; give a name that ends in .png", path.string()));
    require_output_file(path);
}

void require_not_replaced(const fs::path& out, const std::vector<fs::path>& inputs) {
    for (const fs::path& input : inputs) {
        std::error_code ignored;  // what does not exist yet replaces nothing
        if (fs::equivalent(out, input, ignored))
            throw UsageError(fmt::format("{}: is read, and would be replaced; give another name", out.string()));
    }
}

fs::path usable_cache(const fs::path& cache, bool quiet, const char* what) {
    if (cache.empty() || cache_bound() == 0) return {};
    const std::string why = why_not_writable(cache);
    if (why.empty()) return cache;
    if (!quiet) fmt::print(stderr, "warning: {} are not remembered: {}; --cache FOLDER gives another\n", what, why);
    return {};
}

void require_other_folder(const fs::path& out, const std::vector<fs::path>& meshes) {
    for (const auto& path : meshes) {
        std::error_code ignored;  // a folder that does not exist yet holds no mesh
        if (fs::equivalent(out, fs::absolute(path).parent_path(), ignored))
            throw UsageError(
                fmt::format("{}: is the folder of {}, whose labels could be replaced; give another folder to write to",
                            out.string(), path.filename().string()));
    }
}

void require_distinct_names(const std::vector<fs::path>& meshes) {
    std::map<std::string, fs::path> seen;
    for (const auto& path : meshes) {
        const auto [it, fresh] = seen.emplace(path.stem().string(), path);
        if (!fresh)
            throw UsageError(
                fmt::format("{} and {} would write the same files; rename one, or give them to different calls",
                            it->second.string(), path.string()));
    }
}

}  // namespace exemplar
