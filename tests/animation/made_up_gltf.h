#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <numbers>
#include <string>
#include <vector>

#include "host/animation/read_animation.h"
#include "tests/support/mesh_files.h"

/// glTF files built in tests.
namespace exemplar::made_up {

using Json = nlohmann::json;

constexpr int k_byte = 5120, k_ubyte = 5121, k_short = 5122, k_ushort = 5123, k_uint = 5125, k_float = 5126;

/// A document with its binary chunk. Members are free to be changed.
struct Gltf {
    Json json = {{"asset", {{"version", "2.0"}}},
                 {"accessors", Json::array()},
                 {"bufferViews", Json::array()},
                 {"nodes", Json::array()},
                 {"meshes", Json::array()}};
    std::string binary;

    /// A view of `values`; returns its index.
    template <typename T>
    std::size_t view(const std::vector<T>& values) {
        binary.resize((binary.size() + 3) / 4 * 4, '\0');
        json["bufferViews"].push_back(
            {{"buffer", 0}, {"byteOffset", binary.size()}, {"byteLength", values.size() * sizeof(T)}});
        for (const T& value : values) binary += mesh_files::bytes_of(value);
        return json["bufferViews"].size() - 1;
    }

    /// An accessor of `values`; returns its index.
    template <typename T>
    std::size_t accessor(const std::vector<T>& values, const std::string& type, int component = k_float,
                         bool normalized = false) {
        const std::size_t width = type == "SCALAR" ? 1 : type == "VEC3" ? 3 : type == "VEC4" ? 4 : 16;
        Json accessor{{"bufferView", view(values)},
                      {"componentType", component},
                      {"count", values.size() / width},
                      {"type", type}};
        if (normalized) accessor["normalized"] = true;
        json["accessors"].push_back(accessor);
        return json["accessors"].size() - 1;
    }

    /// Adds a channel with its sampler to an animation of `json`.
    void channel(std::size_t animation, std::size_t node, const std::string& path, const std::vector<float>& times,
                 std::size_t output, const std::string& interpolation = "LINEAR") {
        Json& target = json["animations"][animation];
        target["samplers"].push_back(
            {{"input", accessor(times, "SCALAR")}, {"output", output}, {"interpolation", interpolation}});
        target["channels"].push_back(
            {{"sampler", target["samplers"].size() - 1}, {"target", {{"node", node}, {"path", path}}}});
    }

    std::string bytes() const {
        Json complete = json;
        complete["buffers"] = Json::array({{{"byteLength", (binary.size() + 3) / 4 * 4}}});
        return mesh_files::glb_of(complete.dump(), binary);
    }

    Animation read(double frames_per_second = 30) const {
        const TemporaryFolder folder;
        mesh_files::write_bytes(folder / "a.glb", bytes());
        return read_animation(folder / "a.glb", {.frames_per_second = frames_per_second});
    }
};

/// Where things are in arm().
constexpr std::size_t k_lower = 0, k_upper = 1, k_surface = 2;

inline std::vector<float> quarter_turn() {
    const float s = std::numbers::sqrt2_v<float> / 2;
    return {0, 0, s, s};
}

/// A strip of three pairs of vertices at x = 0, 1, 2, which is bound to joints at x = 0 and x = 1: an upper and a lower
/// arm. The child comes first, the joints are not in the scene, the skinned node lies elsewhere (which does not
/// matter), and the middle pair hangs on both joints. Without animations.
inline Gltf arm() {
    Gltf gltf;
    const std::vector<float> positions{0, 0, 0, 0, 1, 0, 1, 0, 0, 1, 1, 0, 2, 0, 0, 2, 1, 0};
    const std::vector<std::uint8_t> joints{0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0};
    const std::vector<float> weights{1, 0, 0, 0, 1, 0, 0, 0, .5f, .5f, 0, 0, .5f, .5f, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0};
    const std::vector<std::uint16_t> indices{0, 2, 1, 1, 2, 3, 2, 4, 3, 3, 4, 5};
    const std::vector<float> inverse{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0,  0, 0, 1,
                                     1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, -1, 0, 0, 1};
    Json& json = gltf.json;
    const std::size_t position = gltf.accessor(positions, "VEC3");
    const std::size_t joint = gltf.accessor(joints, "VEC4", k_ubyte), weight = gltf.accessor(weights, "VEC4");
    const std::size_t index = gltf.accessor(indices, "SCALAR", k_ushort);
    json["meshes"].push_back(
        {{"primitives",
          Json::array({{{"attributes", {{"POSITION", position}, {"JOINTS_0", joint}, {"WEIGHTS_0", weight}}},
                        {"indices", index}}})}});
    json["skins"] =
        Json::array({{{"joints", {k_upper, k_lower}}, {"inverseBindMatrices", gltf.accessor(inverse, "MAT4")}}});
    json["nodes"].push_back({{"name", "lower"}, {"translation", {1, 0, 0}}});
    json["nodes"].push_back({{"name", "upper"}, {"children", {k_lower}}});
    json["nodes"].push_back({{"name", "skin"}, {"mesh", 0}, {"skin", 0}, {"translation", {100, 0, 0}}});
    json["scenes"] = Json::array({{{"nodes", {k_surface}}}});
    json["scene"] = 0;
    return gltf;
}

/// The arm, and a clip in which its lower part makes a quarter turn about z in a second.
inline Gltf bending_arm() {
    Gltf gltf = arm();
    gltf.json["animations"] = Json::array({{{"name", "bend"}}});
    const std::vector<float> turn = quarter_turn();
    gltf.channel(0, k_lower, "rotation", {0, 1},
                 gltf.accessor<float>({0, 0, 0, 1, turn[0], turn[1], turn[2], turn[3]}, "VEC4"));
    return gltf;
}

/// A triangle that node 0 carries, with `names.size()` morph targets; target t moves corner t % 3 by t + 1 along z.
inline Gltf face(const std::vector<std::string>& names) {
    Gltf gltf;
    const std::size_t position = gltf.accessor<float>({0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3");
    Json primitive{{"attributes", {{"POSITION", position}}}};
    for (std::size_t t = 0; t < names.size(); ++t) {
        std::vector<float> offsets(9, 0);
        offsets[3 * (t % 3) + 2] = static_cast<float>(t + 1);
        primitive["targets"].push_back({{"POSITION", gltf.accessor(offsets, "VEC3")}});
    }
    gltf.json["meshes"].push_back({{"primitives", Json::array({primitive})}, {"extras", {{"targetNames", names}}}});
    gltf.json["nodes"].push_back({{"name", "head"}, {"mesh", 0}});
    return gltf;
}

inline std::string warnings_of(const Animation& animation) {
    std::string text;
    for (const std::string& warning : animation.warnings) text += warning + "\n";
    return text;
}

inline const Clip& clip_of(const Animation& animation, const std::string& name) {
    for (const Clip& clip : animation.clips)
        if (clip.name == name) return clip;
    ADD_FAILURE() << "no clip is called " << name;
    static const Clip none;
    return none;
}

}  // namespace exemplar::made_up
