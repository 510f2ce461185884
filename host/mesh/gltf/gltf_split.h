#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace exemplar {

/// A .glb file and what could not be kept of the file that it was made from, a line each.
struct SplitGltf {
    std::string bytes;
    std::vector<std::string> warnings;
};

/// Divides the meshes of a glTF file into parts. `part_of_face` has a number below part_names.size() for each triangle
/// of read_mesh(path), in its order. Each node with a mesh keeps its name, transform and children, and gets a child
/// per part of its mesh, named after the part (followed by the node's name, if other nodes have faces of that part,
/// too). The child has the node's skin and morph weights, and a mesh whose primitives share the vertex attributes,
/// morph targets and materials of the original; only indices are new. Animations of morph weights move all of the
/// children. Everything else, with images, extras and unknown extensions, stays as it is; all buffers and the images
/// beside the file become part of the .glb file. Compressed geometry is expanded. Throws MeshError for a file that
/// read_mesh refuses, UsageError if the numbers do not fit, and MeshError for instances (EXT_mesh_gpu_instancing),
/// which share one mesh.
SplitGltf split_gltf(const std::filesystem::path& path, std::span<const std::uint32_t> part_of_face,
                     std::span<const std::string> part_names);

/// Returns whether split_gltf reads such files, by the ending of the name.
bool is_gltf_file(const std::filesystem::path& path);

}  // namespace exemplar
