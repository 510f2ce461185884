#include "host/mesh/io/io.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "host/core/errors.h"
#include "host/core/files.h"
#include "host/core/text.h"
#include "host/mesh/io/io_formats.h"
#include "host/mesh/io/io_import.h"
#include "host/mesh/io/io_origin.h"
#include "host/mesh/io/io_text.h"

namespace exemplar {
namespace {

namespace fs = std::filesystem;

constexpr std::array<std::string_view, 10> k_extensions{".off", ".obj", ".ply", ".stl", ".gltf",
                                                        ".glb", ".fbx", ".dae", ".3mf", ".3ds"};

std::string read_content(const fs::path& path) {
    try {
        std::string content = read_file(path);
        if (mesh_io::trimmed(content).empty())
            throw MeshError(path.string() + ": the file is empty; save or copy the mesh again");
        if (content.starts_with("version https://git-lfs.github.com/spec/"))
            throw MeshError(path.string() +
                            ": is a pointer of Git LFS in place of the file; fetch it with 'git lfs pull'");
        return content;
    } catch (const DataError& error) {
        throw MeshError(error.what());
    } catch (const fs::filesystem_error& error) {
        throw MeshError(fmt::format("{}: cannot be read: {}", path.string(), error.code().message()));
    }
}

/// Returns the extension that matches the first bytes; empty if they do not tell.
std::string_view extension_of_content(std::string_view content) {
    if (content.starts_with("glTF")) return ".glb";
    if (content.starts_with("ply\n") || content.starts_with("ply\r")) return ".ply";
    if (content.starts_with("OFF") || content.starts_with("COFF") || content.starts_with("NOFF")) return ".off";
    if (mesh_io::trimmed(content.substr(0, 64)).starts_with('{')) return ".gltf";
    return {};
}

/// Throws if the file begins like one of another format. Any other trouble is left to the format's reader, which can
/// say more.
void check_extension(std::string_view extension, std::string_view content, const std::string& name) {
    const std::string_view found = extension_of_content(content);
    const auto is_gltf = [](std::string_view e) { return e == ".glb" || e == ".gltf"; };
    if (found.empty() || found == extension || (is_gltf(found) && is_gltf(extension))) return;
    mesh_io::fail(name, fmt::format("begins like a {} file; rename it to end in {}", found.substr(1), found));
}

MeshFile read_content_as(std::string_view extension, std::string_view content, const fs::path& path) {
    const std::string name = path.string();
    check_extension(extension, content, name);
    if (mesh_io::is_imported(extension))
        return mesh_io::mesh_of_import(mesh_io::run_import(path, mesh_io::ImportContent::still), name);
    if (extension != ".stl" && extension != ".glb") mesh_io::refuse_utf16(content, name);
    if (extension == ".off") return mesh_io::read_off(content, name);
    if (extension == ".obj") return mesh_io::read_obj(content, name);
    if (extension == ".ply") return mesh_io::read_ply(content, name);
    if (extension == ".stl") return mesh_io::read_stl(content, name);
    return mesh_io::read_gltf(content, name, path.parent_path());
}

}  // namespace

std::span<const std::string_view> mesh_extensions() {
    return k_extensions;
}

MeshFile read_mesh(const fs::path& path) {
    const std::string extension = lower_case(path.extension().string());
    if (std::ranges::find(k_extensions, extension) == k_extensions.end()) {
        const std::vector<std::string> known(k_extensions.begin(), k_extensions.end());
        mesh_io::fail(path.string(), fmt::format("'{}' is not a mesh format Exemplar reads; use one of {}{}", extension,
                                                 fmt::join(known, " "), suggestion(extension, known)));
    }
    const std::string content = read_content(path);
    MeshFile file = read_content_as(extension, content, path);
    for (const std::string& warning : {mesh_io::far_position_warning(file.mesh), mesh_io::degrees_warning(file.mesh)})
        if (!warning.empty()) file.warnings.push_back(warning);
    return file;
}

std::uint64_t external_buffer_bytes(const fs::path& path) {
    if (lower_case(path.extension().string()) != ".gltf") return 0;
    try {
        return mesh_io::gltf_external_buffer_bytes(read_content(path), path.string());
    } catch (const std::exception&) {  // read_mesh reports it
        return 0;
    }
}

}  // namespace exemplar
