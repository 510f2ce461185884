#include "host/mesh/gltf/gltf_compression.h"

#include <draco/compression/decode.h>
#include <fmt/format.h>
#include <meshoptimizer.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <memory>
#include <new>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <stdexcept>
#include <utility>

#include "host/mesh/io/io_text.h"

namespace exemplar::mesh_io {
namespace {

using Json = nlohmann::json;
using PackedBytes = std::span<const unsigned char>;

/// Takes an extension out of an object; null if it is not there.
Json take_extension(Json& owner, const char* extension) {
    if (!owner.is_object() || !owner.contains("extensions") || !owner["extensions"].is_object()) return {};
    Json& all = owner["extensions"];
    Json taken = all.contains(extension) ? std::move(all[extension]) : Json();
    all.erase(extension);
    if (all.empty()) owner.erase("extensions");
    return taken;
}

/// Decodes into new buffers, of a bounded size.
class Expander {
  public:
    Expander(Json& document, GltfBuffers& buffers, const std::string& name)
        : document_(document), buffers_(buffers), name_(name) {
        std::uint64_t bytes = 0;
        for (const auto& buffer : buffers) bytes += buffer.size();
        bytes_left_ = std::min(k_free_bytes + k_bytes_per_byte * bytes, k_max_gltf_bytes);
        faces_left_ = k_free_faces + k_faces_per_byte * bytes;
    }

    void expand() {
        Json* views = list("bufferViews");
        for (std::size_t v = 0; views && v < views->size(); ++v)
            if (const Json packed = take_extension((*views)[v], "EXT_meshopt_compression"); packed.is_object())
                expand_view(v, (*views)[v], packed);
        Json* meshes = list("meshes");
        for (std::size_t m = 0; meshes && m < meshes->size(); ++m) {
            const auto primitives = (*meshes)[m].find("primitives");
            if (!(*meshes)[m].is_object() || primitives == (*meshes)[m].end() || !primitives->is_array()) continue;
            for (Json& primitive : *primitives)
                if (const Json packed = take_extension(primitive, "KHR_draco_mesh_compression"); packed.is_object())
                    expand_primitive(m, primitive, packed);
        }
    }

  private:
    /// Meshopt packs at most 64 bytes into one (16 equal bytes into two bits). Draco, which takes about 100 bytes per
    /// face while it decodes, packs regular meshes tighter, but seldom 16 faces into a byte.
    static constexpr std::uint64_t k_free_bytes = 16 << 20, k_bytes_per_byte = 64, k_free_faces = 200'000,
                                   k_faces_per_byte = 16;

    [[noreturn]] void fail(const std::string& message) const { mesh_io::fail(name_, what_ + " " + message); }

    Json* list(const char* key) {
        const auto found = document_.find(key);
        return found != document_.end() && found->is_array() ? &*found : nullptr;
    }

    /// Returns a count or index below 2^32; `otherwise` if it is missing.
    std::uint64_t number(const Json& object, const char* key, std::optional<std::uint64_t> otherwise = {}) const {
        const auto found = object.is_object() ? object.find(key) : object.end();
        if (found == object.end() && otherwise) return *otherwise;
        if (found == object.end() || !found->is_number_unsigned() || *found > 0xffffffffU)
            fail(fmt::format("has no valid {}", key));
        return found->get<std::uint64_t>();
    }

    PackedBytes bytes_of_buffer(const Json& view) const {
        const std::uint64_t buffer = number(view, "buffer"), offset = number(view, "byteOffset", 0),
                            length = number(view, "byteLength");
        if (buffer >= buffers_.size()) fail(fmt::format("names buffer {}, but there are {}", buffer, buffers_.size()));
        const std::vector<unsigned char>& bytes = buffers_[buffer];
        if (offset > bytes.size() || length > bytes.size() - offset) fail("reaches past the end of its buffer");
        return PackedBytes(bytes).subspan(offset, length);
    }

    void charge(std::uint64_t bytes) {
        if (bytes > bytes_left_) fail("claims to hold far more than its bytes can; export the file again");
        bytes_left_ -= bytes;
    }

    /// Points `view` at decoded bytes.
    void replace(Json& view, std::vector<unsigned char> decoded) {
        view["buffer"] = buffers_.size();
        view["byteOffset"] = 0;
        view["byteLength"] = decoded.size();
        buffers_.push_back(std::move(decoded));
    }

    void expand_view(std::size_t index, Json& view, const Json& packed) {
        what_ = fmt::format("buffer view {} (EXT_meshopt_compression)", index);
        const PackedBytes source = bytes_of_buffer(packed);
        const std::uint64_t count = number(packed, "count"), stride = number(packed, "byteStride");
        const std::string mode = packed.value("mode", Json()).is_string() ? packed["mode"].get<std::string>() : "";
        const bool attributes = mode == "ATTRIBUTES", triangles = mode == "TRIANGLES";
        if (!attributes && !triangles && mode != "INDICES") fail("has the unknown mode " + quote(mode));
        const bool fits = attributes ? stride >= 4 && stride <= 256 && stride % 4 == 0 : stride == 2 || stride == 4;
        if (!fits || (triangles && count % 3 != 0)) fail(fmt::format("cannot hold {} x {} bytes", count, stride));
        charge(count * stride);
        std::vector<unsigned char> decoded(count * stride);
        const int error =
            attributes  ? meshopt_decodeVertexBuffer(decoded.data(), count, stride, source.data(), source.size())
            : triangles ? meshopt_decodeIndexBuffer(decoded.data(), count, stride, source.data(), source.size())
                        : meshopt_decodeIndexSequence(decoded.data(), count, stride, source.data(), source.size());
        if (error != 0) fail("is damaged; export the file again");
        if (attributes) apply_filter(packed, decoded, count, stride);
        replace(view, std::move(decoded));
    }

    void apply_filter(const Json& packed, std::vector<unsigned char>& decoded, std::size_t count, std::size_t stride) {
        const Json filter = packed.value("filter", Json("NONE"));
        if (filter == "NONE") return;
        if (filter == "OCTAHEDRAL" && (stride == 4 || stride == 8))
            meshopt_decodeFilterOct(decoded.data(), count, stride);
        else if (filter == "QUATERNION" && stride == 8)
            meshopt_decodeFilterQuat(decoded.data(), count, stride);
        else if (filter == "EXPONENTIAL")
            meshopt_decodeFilterExp(decoded.data(), count, stride);
        else
            fail("has an unknown filter, or one that does not fit its stride");
    }

    /// Returns accessor `index`, which a primitive names.
    Json& accessor(const Json& index) {
        Json* accessors = list("accessors");
        if (!accessors || !index.is_number_unsigned() || index >= accessors->size() ||
            !(*accessors)[index.get<std::size_t>()].is_object())
            fail("names an accessor that does not exist");
        return (*accessors)[index.get<std::size_t>()];
    }

    void expand_primitive(std::size_t mesh, Json& primitive, const Json& packed) {
        what_ = fmt::format("a primitive of mesh {} (KHR_draco_mesh_compression)", mesh);
        const Json* views = list("bufferViews");
        const std::uint64_t view = number(packed, "bufferView");
        if (!views || view >= views->size()) fail(fmt::format("names buffer view {}, which does not exist", view));
        if (!primitive.contains("indices")) fail("has no indices");
        Json& indices = accessor(primitive["indices"]);
        const PackedBytes source = bytes_of_buffer((*views)[view]);
        check_header(source, number(indices, "count"));
        const std::unique_ptr<draco::Mesh> decoded = decode(source);
        replace_indices(indices, *decoded);
        const Json ids = packed.value("attributes", Json::object());
        if (!ids.is_object() || !primitive["attributes"].is_object()) fail("has no attributes");
        for (const auto& [attribute, id] : ids.items())
            if (const auto target = primitive["attributes"].find(attribute);
                target != primitive["attributes"].end() && id.is_number_unsigned())
                replace_attribute(accessor(*target), *decoded, id.get<std::uint32_t>());
    }

    /// Checks that the faces that a Draco file (bitstream 2.2, as glTF wants it) claims are those of the indices, and
    /// that there are not far more of them than its bytes can hold, before Draco takes memory for them.
    void check_header(PackedBytes source, std::uint64_t corners) {
        constexpr std::size_t k_connectivity = 11;
        constexpr unsigned char k_mesh = 1, k_edgebreaker = 1, k_metadata = 0x80;
        if (source.size() < k_connectivity || std::memcmp(source.data(), "DRACO", 5) != 0) fail("is no Draco data");
        if (source[5] != 2 || source[6] != 2)
            fail(fmt::format("is of version {}.{} of Draco's format, not 2.2", source[5], source[6]));
        if (source[7] != k_mesh || source[10] & k_metadata) fail("holds no plain mesh; export it without metadata");
        std::size_t at = k_connectivity;
        if (source[8] == k_edgebreaker) {
            ++at;                     // how the mesh is walked
            read_varint(source, at);  // vertices, of which Draco allows three per face
        }
        const std::uint64_t faces = read_varint(source, at);
        if (3 * faces != corners)
            fail(fmt::format("has {} triangles, but its indices have {} corners", faces, corners));
        if (faces > faces_left_) fail("claims to hold far more than its bytes can; export the file again");
        faces_left_ -= faces;
        charge(12 * faces);
    }

    /// Reads a number of seven bits per byte, lowest first, the last without the highest bit.
    std::uint64_t read_varint(PackedBytes source, std::size_t& at) const {
        std::uint64_t value = 0;
        for (int shift = 0; shift < 35; shift += 7) {
            if (at >= source.size()) fail("is cut off");
            const unsigned char byte = source[at++];
            value |= std::uint64_t{byte & 0x7fU} << shift;
            if (byte < 0x80) return value;
        }
        fail("is damaged; export the file again");
    }

    std::unique_ptr<draco::Mesh> decode(PackedBytes source) const {
        draco::DecoderBuffer buffer;
        buffer.Init(reinterpret_cast<const char*>(source.data()), source.size());
        try {
            draco::Decoder decoder;
            draco::StatusOr<std::unique_ptr<draco::Mesh>> decoded = decoder.DecodeMeshFromBuffer(&buffer);
            if (!decoded.ok()) fail("is damaged; export the file again");
            return std::move(decoded).value();
        } catch (const std::bad_alloc&) {
            fail("takes more memory than there is");
        } catch (const std::length_error&) {
            fail("is damaged; export the file again");
        }
    }

    /// Points `accessor` at decoded elements of `components`.
    void replace_accessor(Json& accessor, std::vector<unsigned char> bytes, int component_type) {
        Json* views = list("bufferViews");
        Json view = Json::object();
        replace(view, std::move(bytes));
        accessor["bufferView"] = views->size();
        accessor["componentType"] = component_type;
        accessor.erase("byteOffset");
        views->push_back(std::move(view));
    }

    void replace_indices(Json& accessor, const draco::Mesh& mesh) {
        constexpr int k_unsigned_int = 5125;
        if (3 * std::uint64_t{mesh.num_faces()} != number(accessor, "count")) fail("has another number of triangles");
        std::vector<unsigned char> bytes(std::size_t{mesh.num_faces()} * 12);
        for (std::uint32_t f = 0; f < mesh.num_faces(); ++f)
            for (std::size_t i = 0; i < 3; ++i) {
                const std::uint32_t corner = mesh.face(draco::FaceIndex(f))[i].value();
                std::memcpy(bytes.data() + 12 * std::size_t{f} + 4 * i, &corner, sizeof(corner));
            }
        replace_accessor(accessor, std::move(bytes), k_unsigned_int);
    }

    void replace_attribute(Json& accessor, const draco::Mesh& mesh, std::uint32_t id) {
        constexpr std::array<std::pair<draco::DataType, int>, 6> k_types{{{draco::DT_INT8, 5120},
                                                                          {draco::DT_UINT8, 5121},
                                                                          {draco::DT_INT16, 5122},
                                                                          {draco::DT_UINT16, 5123},
                                                                          {draco::DT_UINT32, 5125},
                                                                          {draco::DT_FLOAT32, 5126}}};
        const draco::PointAttribute* attribute = mesh.GetAttributeByUniqueId(id);
        if (!attribute) fail(fmt::format("names attribute {}, which its Draco data lack", id));
        const auto type = std::ranges::find(k_types, attribute->data_type(), &std::pair<draco::DataType, int>::first);
        if (type == k_types.end()) fail(fmt::format("has an attribute {} of a type that glTF does not know", id));
        const std::string shape = accessor.value("type", std::string());
        const int components = shape == "SCALAR"                               ? 1
                               : shape.starts_with("VEC") && shape.size() == 4 ? shape[3] - '0'
                                                                               : 0;
        if (attribute->num_components() != components || mesh.num_points() != number(accessor, "count"))
            fail(fmt::format("has {} x {} numbers as attribute {}, unlike its accessor", mesh.num_points(),
                             attribute->num_components(), id));
        const auto size = static_cast<std::size_t>(draco::DataTypeLength(attribute->data_type())) *
                          static_cast<std::size_t>(components);
        charge(mesh.num_points() * size);
        std::vector<unsigned char> bytes(mesh.num_points() * size);
        for (std::uint32_t p = 0; p < mesh.num_points(); ++p) {
            const draco::AttributeValueIndex value = attribute->mapped_index(draco::PointIndex(p));
            if (value.value() >= attribute->size()) fail("is damaged; export the file again");
            std::memcpy(bytes.data() + p * size, attribute->GetAddress(value), size);
        }
        replace_accessor(accessor, std::move(bytes), type->second);
    }

    Json& document_;
    GltfBuffers& buffers_;
    const std::string& name_;
    std::string what_;                               ///< the part at hand, for messages
    std::uint64_t bytes_left_ = 0, faces_left_ = 0;  ///< that may still be decoded
};

}  // namespace

void expand_compressed(Json& document, GltfBuffers& buffers, const std::string& name) {
    try {
        Expander(document, buffers, name).expand();
    } catch (const Json::exception&) {
        fail(name, "the JSON of its compressed parts has a value of the wrong type; export it again");
    }
}

}  // namespace exemplar::mesh_io
