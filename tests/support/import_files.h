#pragma once

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "tests/support/mesh_files.h"

/// Files that exemplar-import reads, written by hand.
namespace exemplar::import_files {

using mesh_files::bytes_of;

/// Whether exemplar-import lies where this program finds it.
inline bool can_import() {
    const auto folder = std::filesystem::read_symlink("/proc/self/exe").parent_path();
    return std::filesystem::exists(folder / "exemplar-import") ||
           std::filesystem::exists(folder.parent_path() / "exemplar-import");
}

/// Tests of this kind are skipped where it was not built.
class ImportTest : public testing::Test {
  protected:
    void SetUp() override {
        if (!can_import()) GTEST_SKIP() << "exemplar-import is not built; it needs libassimp-dev";
    }
};

/// A cube of six quads, as a list of corners each; it looks outward.
struct Cube {
    std::vector<float> coordinates;
    std::vector<int> corners{0, 2, 3, 1, 4, 5, 7, 6, 0, 1, 5, 4, 2, 6, 7, 3, 0, 4, 6, 2, 1, 3, 7, 5};
    Cube() {
        for (int v = 0; v < 8; ++v)
            for (int axis = 0; axis < 3; ++axis) coordinates.push_back(static_cast<float>(v >> axis & 1));
    }
};

/// COLLADA, at x + 5 and, if `mirrored`, with x turned around.
inline std::string collada(bool mirrored) {
    const Cube cube;
    return fmt::format(
        "<?xml version=\"1.0\"?><COLLADA xmlns=\"http://www.collada.org/2005/11/COLLADASchema\" version=\"1.4.1\">"
        "<asset><up_axis>Y_UP</up_axis></asset><library_geometries><geometry id=\"g\"><mesh><source id=\"p\">"
        "<float_array id=\"a\" count=\"24\">{}</float_array><technique_common><accessor source=\"#a\" count=\"8\" "
        "stride=\"3\"><param name=\"X\" type=\"float\"/><param name=\"Y\" type=\"float\"/><param name=\"Z\" "
        "type=\"float\"/>"
        "</accessor></technique_common></source><vertices id=\"v\"><input semantic=\"POSITION\" "
        "source=\"#p\"/></vertices>"
        "<polylist count=\"6\"><input semantic=\"VERTEX\" source=\"#v\" offset=\"0\"/><vcount>4 4 4 4 4 "
        "4</vcount><p>{}</p>"
        "</polylist></mesh></geometry></library_geometries><library_visual_scenes><visual_scene id=\"s\"><node "
        "id=\"n\">"
        "<matrix>{} 0 0 5 0 1 0 0 0 0 1 0 0 0 0 1</matrix><instance_geometry url=\"#g\"/></node></visual_scene>"
        "</library_visual_scenes><scene><instance_visual_scene url=\"#s\"/></scene></COLLADA>",
        fmt::join(cube.coordinates, " "), fmt::join(cube.corners, " "), mirrored ? -1 : 1);
}

inline std::string fbx() {
    const Cube cube;
    std::vector<int> corners = cube.corners;
    for (std::size_t i = 3; i < corners.size(); i += 4) corners[i] = -corners[i] - 1;  // the last of a polygon
    return fmt::format(
        "; FBX 7.4.0 project file\nFBXHeaderExtension:  {{\n\tFBXHeaderVersion: 1003\n\tFBXVersion: 7400\n}}\nObjects: "
        " {{\n"
        "\tGeometry: 1, \"Geometry::cube\", \"Mesh\" {{\n\t\tVertices: *24 {{\n\t\t\ta: {}\n\t\t}}\n"
        "\t\tPolygonVertexIndex: *24 {{\n\t\t\ta: {}\n\t\t}}\n\t\tGeometryVersion: 124\n\t}}\n"
        "\tModel: 2, \"Model::cube\", \"Mesh\" {{\n\t\tVersion: 232\n\t}}\n}}\n"
        "Connections:  {{\n\tC: \"OO\",2,0\n\tC: \"OO\",1,2\n}}\n",
        fmt::join(cube.coordinates, ","), fmt::join(corners, ","));
}

inline std::string chunk_3ds(std::uint16_t kind, const std::string& content) {
    return bytes_of(kind) + bytes_of(static_cast<std::uint32_t>(content.size() + 6)) + content;
}
inline std::string max_3ds() {
    const Cube cube;
    std::string vertices = bytes_of(std::uint16_t{8}), faces = bytes_of(std::uint16_t{12});
    for (const float x : cube.coordinates) vertices += bytes_of(x);
    for (std::size_t i = 0; i < 24; i += 4)
        for (std::size_t k = 1; k < 3; ++k) {
            for (const std::size_t corner : {i, i + k, i + k + 1})
                faces += bytes_of(static_cast<std::uint16_t>(cube.corners[corner]));
            faces += bytes_of(std::uint16_t{7});
        }
    const std::string mesh = chunk_3ds(0x4100, chunk_3ds(0x4110, vertices) + chunk_3ds(0x4120, faces));
    return chunk_3ds(0x4d4d, chunk_3ds(0x0002, bytes_of(std::uint32_t{3})) +
                                 chunk_3ds(0x3d3d, chunk_3ds(0x4000, std::string("cube\0", 5) + mesh)));
}

inline std::uint32_t crc32_of(const std::string& bytes) {
    std::uint32_t crc = ~0U;
    for (const char byte : bytes) {
        crc ^= static_cast<unsigned char>(byte);
        for (int bit = 0; bit < 8; ++bit) crc = crc >> 1 ^ (crc & 1 ? 0xedb88320U : 0U);
    }
    return ~crc;
}

/// A ZIP archive of files that are not compressed.
inline std::string zip_of(const std::vector<std::pair<std::string, std::string>>& files) {
    std::string bytes, directory;
    for (const auto& [name, content] : files) {
        const auto size = static_cast<std::uint32_t>(content.size());
        const std::string about = bytes_of(std::uint16_t{20}) + std::string(8, '\0') + bytes_of(crc32_of(content)) +
                                  bytes_of(size) + bytes_of(size) + bytes_of(static_cast<std::uint16_t>(name.size())) +
                                  std::string(2, '\0');
        directory
            .append("PK\1\2" + bytes_of(std::uint16_t{20}) + about + std::string(10, '\0') +
                    bytes_of(static_cast<std::uint32_t>(bytes.size())))
            .append(name);
        bytes.append("PK\3\4").append(about).append(name).append(content);
    }
    const auto count = bytes_of(static_cast<std::uint16_t>(files.size()));
    return bytes + directory + "PK\5\6" + std::string(4, '\0') + count + count +
           bytes_of(static_cast<std::uint32_t>(directory.size())) + bytes_of(static_cast<std::uint32_t>(bytes.size())) +
           std::string(2, '\0');
}

inline std::string model_3mf() {
    const Cube cube;
    std::string vertices, triangles;
    for (std::size_t v = 0; v < 24; v += 3)
        vertices += fmt::format("<vertex x=\"{}\" y=\"{}\" z=\"{}\"/>", cube.coordinates[v], cube.coordinates[v + 1],
                                cube.coordinates[v + 2]);
    for (std::size_t i = 0; i < 24; i += 4)
        for (std::size_t k = 1; k < 3; ++k)
            triangles += fmt::format("<triangle v1=\"{}\" v2=\"{}\" v3=\"{}\"/>", cube.corners[i], cube.corners[i + k],
                                     cube.corners[i + k + 1]);
    const std::string place = "http://schemas.openxmlformats.org/package/2006/";
    return zip_of(
        {{"[Content_Types].xml",
          "<Types xmlns=\"" + place +
              "content-types\"><Default Extension=\"model\" "
              "ContentType=\"application/vnd.ms-package.3dmanufacturing-3dmodel+xml\"/></Types>"},
         {"_rels/.rels",
          "<Relationships xmlns=\"" + place +
              "relationships\"><Relationship Target=\"/3D/3dmodel.model\" "
              "Id=\"r\" Type=\"http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel\"/></Relationships>"},
         {"3D/3dmodel.model",
          "<?xml version=\"1.0\"?><model unit=\"millimeter\" "
          "xmlns=\"http://schemas.microsoft.com/3dmanufacturing/core/2015/02\"><resources><object id=\"1\" "
          "type=\"model\"><mesh><vertices>" +
              vertices + "</vertices><triangles>" + triangles +
              "</triangles></mesh></object></resources><build><item objectid=\"1\"/></build></model>"}});
}

inline std::string collada_floats(const std::string& id, const std::string& numbers, std::size_t count,
                                  std::size_t stride, const std::string& type = "float") {
    const std::string array = type == "float" || type == "float4x4" ? "float_array" : "Name_array";
    std::string params;
    if (stride == 3)
        params =
            "<param name=\"X\" type=\"float\"/><param name=\"Y\" type=\"float\"/><param name=\"Z\" type=\"float\"/>";
    else
        params = "<param name=\"P\" type=\"" + type + "\"/>";
    return fmt::format(
        "<source id=\"{0}\"><{1} id=\"{0}-array\" count=\"{2}\">{3}</{1}><technique_common><accessor "
        "source=\"#{0}-array\" count=\"{4}\" stride=\"{5}\">{6}</accessor></technique_common></source>\n",
        id, array, count * stride, numbers, count, stride, params);
}

/// A strip of two quads in the plane z = 0: vertices (0, y), (1, y), (2, y) for y = 0 and 1.
inline std::string strip_geometry(const std::string& id, const std::string& positions) {
    return "<geometry id=\"" + id + "\"><mesh>" + collada_floats(id + "-p", positions, 6, 3) + "<vertices id=\"" + id +
           "-v\"><input semantic=\"POSITION\" source=\"#" + id +
           "-p\"/></vertices><polylist count=\"2\"><input semantic=\"VERTEX\" source=\"#" + id +
           "-v\" offset=\"0\"/><vcount>4 4</vcount><p>0 1 4 3 1 2 5 4</p></polylist></mesh></geometry>\n";
}
constexpr const char* k_strip_positions = "0 0 0 1 0 0 2 0 0 0 1 0 1 1 0 2 1 0";

inline std::string collada_file(const std::string& libraries, const std::string& nodes) {
    return "<?xml version=\"1.0\"?>\n<COLLADA xmlns=\"http://www.collada.org/2005/11/COLLADASchema\" "
           "version=\"1.4.1\">\n<asset><up_axis>Y_UP</up_axis></asset>\n" +
           libraries + "<library_visual_scenes><visual_scene id=\"s\">\n" + nodes +
           "</visual_scene></library_visual_scenes><scene><instance_visual_scene url=\"#s\"/></scene></COLLADA>\n";
}

inline std::string collada_animation(const std::string& target, const std::string& values) {
    return "<library_animations><animation id=\"act\">" + collada_floats("act-in", "0 1", 2, 1) +
           collada_floats("act-out", values, 2, 1) + collada_floats("act-how", "LINEAR LINEAR", 2, 1, "name") +
           "<sampler id=\"act-s\"><input semantic=\"INPUT\" source=\"#act-in\"/><input semantic=\"OUTPUT\" "
           "source=\"#act-out\"/><input semantic=\"INTERPOLATION\" source=\"#act-how\"/></sampler><channel "
           "source=\"#act-s\" target=\"" +
           target + "\"/></animation></library_animations>\n";
}

/// The strip on the joints root, a, b, c (at the origin) and tip (at x = 1, turned by 90 degrees about z at rest, bound
/// without the turn). Vertices at x = 0 have a fifth of each joint, those at x = 1 half of root and tip, those at x = 2
/// follow the tip. The node of the mesh is moved far away, which must not matter. In one second the tip turns to 0.
inline std::string skinned_collada() {
    const std::string identity = "1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1 ";
    const std::string row = "0 0 1 0 2 0 3 0 4 0 0 1 4 1 4 2";
    const auto joint = [](const std::string& name, const std::string& inside) {
        return "<node id=\"" + name + "\" sid=\"" + name + "\" name=\"" + name + "\" type=\"JOINT\">" + inside +
               "</node>\n";
    };
    const std::string skin =
        "<library_controllers><controller id=\"k\"><skin source=\"#g\"><bind_shape_matrix>" + identity +
        "</bind_shape_matrix>\n" + collada_floats("k-j", "root a b c tip", 5, 1, "name") +
        collada_floats("k-m", identity + identity + identity + identity + "1 0 0 -1 0 1 0 0 0 0 1 0 0 0 0 1", 5, 16,
                       "float4x4") +
        collada_floats("k-w", "0.2 0.5 1", 3, 1) +
        "<joints><input semantic=\"JOINT\" source=\"#k-j\"/><input semantic=\"INV_BIND_MATRIX\" "
        "source=\"#k-m\"/></joints><vertex_weights count=\"6\"><input semantic=\"JOINT\" source=\"#k-j\" "
        "offset=\"0\"/><input semantic=\"WEIGHT\" source=\"#k-w\" offset=\"1\"/><vcount>5 2 1 5 2 1</vcount><v>" +
        row + " " + row + "</v></vertex_weights></skin></controller></library_controllers>\n";
    return collada_file(
        collada_animation("tip/turn.ANGLE", "90 0") + "<library_geometries>" + strip_geometry("g", k_strip_positions) +
            "</library_geometries>\n" + skin,
        joint("root", joint("a", "") + joint("b", "") + joint("c", "") +
                          joint("tip", "<translate>1 0 0</translate><rotate sid=\"turn\">0 0 1 90</rotate>")) +
            "<node id=\"n\"><translate>100 0 0</translate><instance_controller url=\"#k\"><skeleton>#root</skeleton>"
            "</instance_controller></node>\n");
}

/// The objects and connections of an FBX file that animate property `name` of object `target`; times in seconds.
inline std::pair<std::string, std::string> fbx_motion(int target, const std::string& property,
                                                      const std::string& channel, const std::vector<double>& times,
                                                      const std::vector<double>& values) {
    std::vector<std::int64_t> ticks;
    ticks.reserve(times.size());
    for (const double time : times) ticks.push_back(static_cast<std::int64_t>(time * 46186158000.0));
    const std::string objects = fmt::format(
        "\tAnimationStack: 50, \"AnimStack::Take\", \"\" {{\n\t\tProperties70:  {{\n\t\t\tP: \"LocalStop\", \"KTime\", "
        "\"Time\", \"\",{3}\n\t\t}}\n\t}}\n\tAnimationLayer: 51, \"AnimLayer::Base\", \"\" "
        "{{\n\t}}\n\tAnimationCurveNode: 52, \"AnimCurveNode::C\", \"\" {{\n\t}}\n"
        "\tAnimationCurve: 53, \"AnimCurve::\", \"\" {{\n\t\tKeyTime: *{0} {{\n\t\t\ta: {1}\n\t\t}}\n"
        "\t\tKeyValueFloat: *{0} {{\n\t\t\ta: {2}\n\t\t}}\n\t}}\n",
        ticks.size(), fmt::join(ticks, ","), fmt::join(values, ","), ticks.back());
    return {objects, fmt::format("\tC: \"OO\",51,50\n\tC: \"OO\",52,51\n\tC: \"OP\",52,{},\"{}\"\n\tC: "
                                 "\"OP\",53,52,\"{}\"\n",
                                 target, property, channel)};
}

/// The cube as FBX, with more objects and connections, and properties of its model.
inline std::string fbx_with(const std::string& objects, const std::string& connections,
                            const std::string& properties = {}) {
    std::string text = fbx();
    const auto insert = [&](const std::string& before, const std::string& added) {
        text.insert(text.find(before), added);
    };
    insert("}\nConnections:", objects);
    text.insert(text.rfind("}\n"), connections);
    const std::string version = "\t\tVersion: 232\n";
    text.insert(text.find(version) + version.size(), "\t\tProperties70:  {\n" + properties + "\t\t}\n");
    return text;
}

/// The cube turns by 90 degrees in a second, about the axis through (1, 0, 0) along z, which is its pivot.
inline std::string turning_fbx() {
    const auto [objects, connections] = fbx_motion(2, "Lcl Rotation", "d|Z", {0, 1}, {0, 90});
    return fbx_with(objects, connections, "\t\t\tP: \"RotationPivot\", \"Vector3D\", \"Vector\", \"\",1,0,0\n");
}

/// The cube with a morph target "up" that raises its vertex 7 by 2; its weight goes from 0 to 50 percent in a second.
inline std::string morphed_fbx() {
    const auto [objects, connections] = fbx_motion(62, "DeformPercent", "d|DeformPercent", {0, 1}, {0, 50});
    return fbx_with(objects +
                        "\tGeometry: 60, \"Geometry::up\", \"Shape\" {\n\t\tVersion: 100\n\t\tIndexes: *1 {\n\t\t\ta: "
                        "7\n\t\t}\n\t\tVertices: *3 {\n\t\t\ta: 0,0,2\n\t\t}\n\t\tNormals: *3 {\n\t\t\ta: "
                        "0,0,0\n\t\t}\n\t}\n\tDeformer: 61, \"Deformer::shapes\", \"BlendShape\" {\n\t\tVersion: "
                        "100\n\t}\n\tDeformer: 62, \"SubDeformer::up\", \"BlendShapeChannel\" {\n\t\tVersion: "
                        "100\n\t\tDeformPercent: 0\n\t\tFullWeights: *1 {\n\t\t\ta: 100\n\t\t}\n\t}\n",
                    connections + "\tC: \"OO\",61,1\n\tC: \"OO\",62,61\n\tC: \"OO\",60,62\n");
}

}  // namespace exemplar::import_files
