#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <ostream>
#include <string>
#include <vector>

#include "host/core/errors.h"
#include "host/core/files.h"
#include "host/mesh/io/io.h"
#include "tests/support/temporary_folder.h"

/// Files and file contents for the tests of readers and writers.
namespace exemplar::mesh_files {

using exemplar::TemporaryFolder;

inline void write_bytes(const std::filesystem::path& path, const std::string& bytes) {
    std::ofstream(path, std::ios::binary) << bytes;
}

/// What read_mesh makes of a file with this name and content.
inline MeshFile read_as(const std::string& file_name, const std::string& bytes) {
    const TemporaryFolder folder;
    write_bytes(folder / file_name, bytes);
    return read_mesh(folder / file_name);
}

/// The message of the E that `action` throws; a note, and a failure of the test, if it throws none.
template <typename E, typename Action>
std::string error_of(Action&& action) {
    try {
        action();
    } catch (const E& error) {
        return error.what();
    } catch (const std::exception& error) {
        ADD_FAILURE() << "another exception: " << error.what();
        return "another exception";
    }
    ADD_FAILURE() << "no exception";
    return "no exception";
}

/// The bytes of a value, last byte first if `big_endian`.
template <typename T>
std::string bytes_of(T value, bool big_endian = false) {
    std::string bytes(sizeof(T), '\0');
    std::memcpy(bytes.data(), &value, sizeof(T));
    if (big_endian) std::reverse(bytes.begin(), bytes.end());
    return bytes;
}

/// A .glb file of a JSON text and, unless empty, a binary chunk; both are padded as the format asks.
inline std::string glb_of(std::string json, std::string binary) {
    json.resize((json.size() + 3) / 4 * 4, ' ');
    binary.resize((binary.size() + 3) / 4 * 4, '\0');
    std::string chunks = bytes_of(static_cast<std::uint32_t>(json.size())) + "JSON" + json;
    if (!binary.empty())
        chunks += bytes_of(static_cast<std::uint32_t>(binary.size())) + std::string("BIN\0", 4) + binary;
    return "glTF" + bytes_of(2u) + bytes_of(static_cast<std::uint32_t>(12 + chunks.size())) + chunks;
}

/// `text` with every ' turned into ", for JSON in string literals.
inline std::string json_text(std::string text) {
    std::replace(text.begin(), text.end(), '\'', '"');
    return text;
}

/// Four corners of a unit tetrahedron as glTF positions, and its faces as 16-bit indices.
inline std::string tetrahedron_positions() {
    std::string bytes;
    for (float x : {0.f, 0.f, 0.f, 1.f, 0.f, 0.f, 0.f, 1.f, 0.f, 0.f, 0.f, 1.f}) bytes += bytes_of(x);
    return bytes;
}
inline std::string tetrahedron_indices() {
    std::string bytes;
    for (int i : {0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3}) bytes += bytes_of(static_cast<std::uint16_t>(i));
    return bytes;
}
/// A glTF document of that tetrahedron; `buffer` is the inside of its buffer object before byteLength, `nodes` its
/// nodes.
inline std::string tetrahedron_gltf(const std::string& buffer, const std::string& nodes = "[{'mesh':0}]") {
    return json_text(
        "{'asset':{'version':'2.0'},'scene':0,'scenes':[{'nodes':[0]}],'nodes':" + nodes +
        ",'meshes':[{'primitives':[{'attributes':{'POSITION':0},'indices':1}]}],"
        "'accessors':[{'bufferView':0,'componentType':5126,'count':4,'type':'VEC3','min':[0,0,0],'max':[1,1,1]},"
        "{'bufferView':1,'componentType':5123,'count':12,'type':'SCALAR'}],"
        "'bufferViews':[{'buffer':0,'byteLength':48},{'buffer':0,'byteOffset':48,'byteLength':24}],"
        "'buffers':[{" +
        buffer + "'byteLength':72}]}");
}

/// A binary PLY of two labeled triangles and an extra list property, in either byte order.
inline std::string binary_ply(bool big_endian) {
    std::string bytes = std::string("ply\nformat binary_") + (big_endian ? "big" : "little") +
                        "_endian 1.0\ncomment label 0 left\ncomment label 1 right side\nelement vertex 4\n"
                        "property double x\nproperty float y\nproperty short z\nproperty uchar quality\n"
                        "element face 2\nproperty list ushort float weights\nproperty list uchar uint vertex_index\n"
                        "property uchar label\nend_header\n";
    for (int v = 0; v < 4; ++v)
        bytes += bytes_of(double(v % 2), big_endian) + bytes_of(v < 2 ? 0.0f : 1.0f, big_endian) +
                 bytes_of(std::int16_t(-v), big_endian) + bytes_of(std::uint8_t(v));
    for (int f = 0; f < 2; ++f) {
        bytes += bytes_of(std::uint16_t(f), big_endian);
        if (f == 1) bytes += bytes_of(0.5f, big_endian);
        bytes += bytes_of(std::uint8_t(3));
        for (int i = 0; i < 3; ++i) bytes += bytes_of(std::uint32_t(f + i), big_endian);
        bytes += bytes_of(std::uint8_t(f));
    }
    return bytes;
}

/// A binary STL of the given triangles, nine coordinates each.
inline std::string binary_stl(const std::vector<std::array<float, 9>>& triangles) {
    std::string bytes(80, 's');
    bytes += bytes_of(static_cast<std::uint32_t>(triangles.size()));
    for (const auto& triangle : triangles) {
        bytes += std::string(12, '\0');
        for (float x : triangle) bytes += bytes_of(x);
        bytes += std::string(2, '\0');
    }
    return bytes;
}

struct Sample {
    std::string file_name, bytes;
};
/// How GoogleTest shows a sample.
inline void PrintTo(const Sample& sample, std::ostream* out) {
    *out << sample.file_name;
}
/// A small valid file of every format and encoding.
inline std::vector<Sample> samples() {
    return {
        {"plain.off", "OFF\n4 4 6\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n"},
        {"colored.off",
         "COFF # colors\n5 2 0\n0 0 0 255 0 0 255\n2 0 0 1 1 1 1\n2 2 0 0 0 0 1\n1 0.5 0 0 0 0 1\n0 2 0 0 0 0 1\n"
         "5 0 1 2 3 4 0.1 0.2 0.3\n3 0 1 2\n"},
        {"quads.obj",
         "# box\nmtllib x.mtl\no thing\nv 0 0 0\nv 1.5 0 0 1.0\nv 1.5 1e0 0\nv 0 1 0 0.5 0.5 0.5\nvt 0 0\nvn 0 0 1\n"
         "g a b\nusemtl m\ns 1\nf 1/1/1 2/1/1 3/1/1 4/1/1\nf -4//1 -3//1 \\\n -2//1\nl 1 2\n"},
        {"ascii.ply",
         "ply\nformat ascii 1.0\ncomment label 3 head\nobj_info none\nelement vertex 4\nproperty float x\nproperty "
         "float y\n"
         "property float z\nelement face 2\nproperty list uchar int vertex_indices\nproperty int label\n"
         "element edge 1\nproperty int vertex1\nproperty int vertex2\nend_header\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n"
         "4 0 1 2 3 3\n3 0 1 2 -1\n0 1\n"},
        {"little.ply", binary_ply(false)},
        {"big.ply", binary_ply(true)},
        {"strips.ply",
         "ply\nformat binary_little_endian 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
         "property float z\nelement tristrips 1\nproperty list int int vertex_indices\nend_header\n" +
             tetrahedron_positions() + bytes_of(8) + bytes_of(0) + bytes_of(1) + bytes_of(2) + bytes_of(3) +
             bytes_of(-1) + bytes_of(2) + bytes_of(1) + bytes_of(0)},
        {"ascii.stl",
         "solid part one\n facet normal 0 0 1\n  outer loop\n   vertex 0 0 0\n   vertex 1 0 0\n   vertex 0 1 0\n"
         "  endloop\n endfacet\n facet normal 0 0 1\n  outer loop\n   vertex 1 0 0\n   vertex 1.0 1.0e0 0\n"
         "   vertex 0 1 -0\n  endloop\n endfacet\nendsolid part one\n"},
        {"binary.stl", binary_stl({{0, 0, 0, 1, 0, 0, 0, 1, 0}, {1, 0, 0, 1, 1, 0, 0, 1, -0.0f}})},
        {"chunk.glb", glb_of(tetrahedron_gltf("",
                                              "[{'children':[1],'rotation':[0,0,1,0]},{'mesh':0,'scale':[1,-1,2],"
                                              "'translation':[1,2,3]}]"),
                             tetrahedron_positions() + tetrahedron_indices())},
        {"sparse.glb",
         glb_of(
             json_text("{'asset':{'version':'2.0'},'scene':0,'scenes':[{'nodes':[0]}],'nodes':[{'mesh':0}],"
                       "'meshes':[{'primitives':[{'attributes':{'POSITION':0}}]}],'accessors':[{'componentType':5126,"
                       "'count':3,'type':'VEC3','sparse':{'count':2,'indices':{'bufferView':0,'componentType':5121},"
                       "'values':{'bufferView':1}}}],'bufferViews':[{'buffer':0,'byteLength':2},"
                       "{'buffer':0,'byteOffset':4,'byteLength':24}],'buffers':[{'byteLength':28}]}"),
             std::string("\1\2\0\0", 4) + tetrahedron_positions().substr(12, 24))},
        {"embedded.gltf",
         tetrahedron_gltf(
             "'uri':'data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAAAAAA"
             "AAAAAAAAAIA/AAACAAEAAAABAAMAAAADAAIAAQACAAMA',")}};
}

}  // namespace exemplar::mesh_files
