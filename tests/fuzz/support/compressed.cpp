#include "tests/fuzz/support/compressed.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "tests/support/mesh_files.h"

namespace exemplar::fuzz {
namespace {

/// Takes one byte; 0 if there is none.
unsigned take_byte(std::string_view& content) {
    if (content.empty()) return 0;
    const auto byte = static_cast<unsigned char>(content.front());
    content.remove_prefix(1);
    return byte;
}

unsigned take_short(std::string_view& content) {
    const unsigned low = take_byte(content);
    return low | take_byte(content) << 8;
}

}  // namespace

std::string glb_of_draco(std::string_view content) {
    const unsigned vertices = take_short(content), triangles = take_short(content);
    const std::string json = fmt::format(
        "{{'asset':{{'version':'2.0'}},'extensionsRequired':['KHR_draco_mesh_compression'],'nodes':[{{'mesh':0}}],"
        "'meshes':[{{'primitives':[{{'attributes':{{'POSITION':0}},'indices':1,'extensions':"
        "{{'KHR_draco_mesh_compression':{{'bufferView':0,'attributes':{{'POSITION':0}}}}}}}}]}}],"
        "'accessors':[{{'componentType':5126,'count':{},'type':'VEC3'}},{{'componentType':5125,'count':{},'type':'"
        "SCALAR'}}],"
        "'bufferViews':[{{'buffer':0,'byteLength':{}}}],'buffers':[{{'byteLength':{}}}]}}",
        vertices, 3 * triangles, content.size(), content.size());
    return mesh_files::glb_of(mesh_files::json_text(json), std::string(content));
}

std::string glb_of_meshopt(std::string_view content) {
    constexpr std::array<std::string_view, 4> k_filters{"NONE", "EXPONENTIAL", "OCTAHEDRAL", "QUATERNION"};
    const unsigned vertices = take_byte(content), triangles = take_byte(content), length = take_byte(content);
    const unsigned how = take_byte(content), filter = how & 3U, index_size = how & 8U ? 4 : 2;
    const bool shorts = filter >= 2;  // the last two filters make four shorts of a position
    const unsigned stride = shorts ? 8 : 12;
    const std::size_t packed_positions = std::min<std::size_t>(length, content.size());
    const std::size_t packed_indices = content.size() - packed_positions;
    const std::string json = fmt::format(
        "{{'asset':{{'version':'2.0'}},'extensionsRequired':['EXT_meshopt_compression','KHR_mesh_quantization'],"
        "'nodes':[{{'mesh':0}}],'meshes':[{{'primitives':[{{'attributes':{{'POSITION':0}},'indices':1}}]}}],"
        "'accessors':[{{'bufferView':0,'componentType':{},'normalized':{},'count':{},'type':'VEC3'}},"
        "{{'bufferView':1,'componentType':{},'count':{},'type':'SCALAR'}}],"
        "'bufferViews':[{{'buffer':1,'byteLength':{},'byteStride':{},'extensions':{{'EXT_meshopt_compression':{{'"
        "buffer':0,"
        "'byteLength':{},'byteStride':{},'mode':'ATTRIBUTES','filter':'{}','count':{}}}}}}},"
        "{{'buffer':1,'byteLength':{},'extensions':{{'EXT_meshopt_compression':{{'buffer':0,'byteOffset':{},"
        "'byteLength':{},'byteStride':{},'mode':'{}','count':{}}}}}}}],"
        "'buffers':[{{'byteLength':{}}},{{'byteLength':65536,'extensions':{{'EXT_meshopt_compression':{{'fallback':"
        "true}}}}}}]}}",
        shorts ? 5122 : 5126, shorts, vertices, index_size == 2 ? 5123 : 5125, 3 * triangles, stride * vertices, stride,
        packed_positions, stride, k_filters[filter], vertices, 3 * index_size * triangles, packed_positions,
        packed_indices, index_size, how & 4U ? "INDICES" : "TRIANGLES", 3 * triangles, content.size());
    return mesh_files::glb_of(mesh_files::json_text(json), std::string(content));
}

}  // namespace exemplar::fuzz
