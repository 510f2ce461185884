// A malformed file gives one line that names the file and the place; nothing crashes and nothing large is allocated.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include "tests/support/mesh_files.h"

namespace exemplar {
namespace {

using mesh_files::bytes_of;
using mesh_files::error_of;
using mesh_files::glb_of;
using mesh_files::json_text;
using mesh_files::read_as;
using mesh_files::tetrahedron_gltf;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

std::string read_error(const std::string& file_name, const std::string& bytes) {
    std::string message = error_of<MeshError>([&] { read_as(file_name, bytes); });
    EXPECT_THAT(message, AllOf(HasSubstr(file_name), Not(HasSubstr("\n"))));
    EXPECT_LT(message.size(), 400u) << message;
    return message;
}

std::string file_with(std::string_view extension) {
    std::string name(1, 'a');
    name += extension;
    return name;
}

/// Bytes, where the error must say it is, and a word of what it must say.
struct BadFile {
    std::string bytes, place, word;
};
void expect_errors(const std::string& file_name, const std::vector<BadFile>& files) {
    for (const BadFile& file : files)
        EXPECT_THAT(read_error(file_name, file.bytes), AllOf(HasSubstr(file_name + file.place), HasSubstr(file.word)))
            << file.bytes.substr(0, 300);
}

TEST(BadFile, MissingFolderEmptyAndUnknown) {
    const mesh_files::TemporaryFolder folder;
    std::filesystem::create_directories(folder / "folder.off");
    EXPECT_THAT(error_of<MeshError>([&] { read_mesh(folder / "none.ply"); }), HasSubstr("none.ply"));
    EXPECT_THAT(error_of<MeshError>([&] { read_mesh(folder / "folder.off"); }), HasSubstr("folder"));
    for (const auto extension : mesh_extensions())
        EXPECT_THAT(read_error(file_with(extension), ""), HasSubstr("empty"));
    EXPECT_THAT(read_error("a.pyl", "x"), AllOf(HasSubstr("'.pyl'"), HasSubstr(".ply")));
    EXPECT_THAT(read_error("a", "x"), HasSubstr(".off"));
}

TEST(BadFile, ContentOfAnotherFormat) {
    EXPECT_THAT(read_error("a.off", "ply\nformat ascii 1.0\n"), HasSubstr("rename it to end in .ply"));
    EXPECT_THAT(read_error("a.ply", "OFF\n0 0 0\n"), HasSubstr(".off"));
    EXPECT_THAT(read_error("a.stl", glb_of("{}", "")), HasSubstr(".glb"));
    EXPECT_THAT(read_error("a.obj", " {\"asset\":{}}"), HasSubstr(".gltf"));
}

TEST(BadFile, PointersOfGitLfsAndOtherEncodings) {
    const std::string pointer = "version https://git-lfs.github.com/spec/v1\noid sha256:4d7a\nsize 12345\n";
    for (const auto extension : mesh_extensions())
        EXPECT_THAT(read_error(file_with(extension), pointer), AllOf(HasSubstr("Git LFS"), HasSubstr("git lfs pull")));
    for (const std::string name : {"a.off", "a.obj", "a.ply", "a.gltf"})
        for (const std::string mark : {"\xff\xfe", "\xfe\xff"})
            EXPECT_THAT(read_error(name, mark + std::string("v\0 \0", 4)), HasSubstr("UTF-16; save it as UTF-8"));
}

TEST(BadFile, GarbageInEveryFormat) {
    std::string garbage;
    for (int i = 0; i < 4000; ++i) garbage += static_cast<char>((i * 7919 + i * i * 31) % 256);
    for (const auto extension : mesh_extensions()) {
        read_error(file_with(extension), garbage);
        read_error(file_with(extension), std::string(1000, '\0'));
        read_error(file_with(extension), std::string(1000, '\n'));
        read_error(file_with(extension), "x");
    }
}

TEST(BadFile, Off) {
    const std::string vertices = "0 0 0\n1 0 0\n0 1 0\n";
    expect_errors("a.off",
                  {{"# only a comment\n", ":1: ", "the word OFF"},
                   {"OF\n3 1 0\n", ":1: ", "OFF"},
                   {"OFF BINARY\n", ":1: ", "binary"},
                   {"4OFF\n3 1 0\n", ":1: ", "4OFF"},
                   {"nOFF\n3\n3 1 0\n", ":1: ", "nOFF"},
                   {"OFF\n", ":1: ", "counts"},
                   {"OFFx 3 1 0\n", ":1: ", "'OFFx'"},
                   {"nOFF3 3 1 0\n", ":1: ", "nOFF"},
                   {"OFF3000000000 1 0\n", ":1: ", "3000000000"},
                   {"OFF\n3\n", ":2: ", "number of faces"},
                   {"OFF\nthree 1 0\n", ":2: ", "'three'"},
                   {"OFF\n-3 1 0\n" + vertices, ":2: ", "-3"},
                   {"OFF\n3 -1 0\n" + vertices, ":2: ", "-1"},
                   {"OFF\n3000000000 1 0\n" + vertices, ":2: ", "3000000000"},
                   {"OFF\n3 3000000000 0\n" + vertices, ":2: ", "3000000000"},
                   {"OFF\n99999999999999999999 1 0\n" + vertices, ":2: ", "integer"},
                   {"OFF\n9223372036854775807 9223372036854775807 0\n" + vertices, ":2: ", "cannot be"},
                   {"OFF\n3 1 0\n0 0 0\n1 0\n0 1 0\n3 0 1 2\n", ":4: ", "z of a vertex"},
                   {"OFF\n3 1 0\n0 0 0\n1 0 zero\n0 1 0\n3 0 1 2\n", ":4: ", "'zero'"},
                   {"OFF\n3 1 0\n0 0 0\n1 0 1.2.3\n0 1 0\n3 0 1 2\n", ":4: ", "'1.2.3'"},
                   {"OFF\n3 1 0\n0 0 0\n1 0 0x10\n0 1 0\n3 0 1 2\n", ":4: ", "'0x10'"},
                   {"OFF\n3 1 0\n" + vertices, ":5: ", "a face"},
                   {"OFF\n3 2 0\n" + vertices + "3 0 1 2\n", ":6: ", "cut off"},
                   {"OFF\n3 1 0\n" + vertices + "3 0 1\n", ":6: ", "cannot have 3 corners"},
                   {"OFF\n1 1 0\n0 0 0\n3 0 0\n", ":4: ", "corners"},
                   {"OFF\n3 1 0\n" + vertices + "3 0 1 3\n", ":6: ", "face 0 names vertex 3"},
                   {"OFF\n3 1 0\n" + vertices + "3 0 1 -1\n", ":6: ", "vertex -1"},
                   {"OFF\n3 1 0\n" + vertices + "3 0 1 4294967296\n", ":6: ", "4294967296"},
                   {"OFF\n3 1 0\n" + vertices + "3 0 1 1.5\n", ":6: ", "'1.5'"},
                   {"OFF\n3 1 0\n" + vertices + "-3 0 1 2\n", ":6: ", "-3 corners"},
                   {"OFF\n3 1 0\n" + vertices + "2000000000 0 1 2\n", ":6: ", "2000000000"},
                   {"OFF 3 1 0 0 0 0 1 0 0 0 1 0 3 0 1", ":1: ", "cannot have 3 corners in what is left"},
                   {"OFF 3 1 0 0 0 0 1 0 0 0 1 0 3 0 1 2 7", ":1: ", "more numbers follow"},
                   {"OFF 3 1 0 0 0 0 1 0 0 0 1 0 9 0 1 2", ":1: ", "cannot have 9 corners in what is left"},
                   {"OFF\n3 2 0\n0 0 0 1 0 0\n0 1 0\n3 0 1 2 3 0 1 2\n7 7\n", ":6: ", "more numbers follow"},
                   {"OFF\n3 1 0\n" + vertices + "3 0 1\n\n\n# end\nx\n", ":10: ", "'x'"},
                   // A missing number is not taken from the next element, even if lines are left over.
                   {"OFF\n3 1 0\n0 0 0\n1 0\n0 1 0\n3 0 1 2\n3 0 1 2\n", ":5: ", "a vertex from line 4"},
                   {"OFF\n4 2 0\n" + vertices + "0 0 1\n3 0 1\n3 0 2 1\n3 0 1 2\n", ":8: ", "a face from line 7"}});
}

TEST(BadFile, Obj) {
    const std::string vertices = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
    expect_errors("a.obj", {{"f 1 2 3\n", "", "no line"},
                            {"hello\n", "", "no line"},
                            {"v 0 0\n", ":1: ", "three coordinates"},
                            {vertices + "v 0 0 x\n", ":4: ", "'x'"},
                            {vertices + "f 1 2 4\n", ":4: ", "vertex 4"},
                            {"f 1 2 4\n" + vertices, ":1: ", "vertex 4"},
                            {vertices + "f 1 2 0\n", ":4: ", "'0'"},
                            {vertices + "f 1 2 -4\n", ":4: ", "vertex -4"},
                            {vertices + "\n# c\nf 1 2 -4\n", ":6: ", "vertex -4"},
                            {vertices + "f 1 2 x\n", ":4: ", "'x'"},
                            {vertices + "f 1 2 3/x\n", ":4: ", "'3/x'"},
                            {vertices + "f 1/1/1/1 2 3\n", ":4: ", "three indices"},
                            {vertices + "f /1 2 3\n", ":4: ", "'/1'"},
                            {vertices + "f 1 2 99999999999\n", ":4: ", "99999999999"},
                            {vertices + "f 1 2 \\\n 2147483647\n", ":4: ", "2147483647"},
                            {vertices + "f 1 2 -2147483648\n", ":4: ", "-2147483648"},
                            {vertices + "f 1 2 -9223372036854775808\n", ":4: ", "-9223372036854775808"}});
}

std::string ascii_ply(const std::string& elements, const std::string& body) {
    return "ply\nformat ascii 1.0\n" + elements + "end_header\n" + body;
}

TEST(BadFile, PlyHeader) {
    const std::string xyz = "property float x\nproperty float y\nproperty float z\n";
    expect_errors(
        "a.ply",
        {{"plx\n", ":1: ", "ply"},
         {"ply\nformat ascii 1.0\nelement vertex 3\n", ": ", "end_header"},
         {"ply\nformat ascii 1.0\ncomment end_header\n", ": ", "end_header"},
         {"ply\nelement vertex 0\n" + xyz + "end_header\n", ":", "format"},
         {"ply\nformat binary 1.0\nend_header\n", ":2: ", "'binary'"},
         {ascii_ply("element vertex -1\n" + xyz, ""), ":3: ", "-1"},
         {ascii_ply("element vertex\n" + xyz, ""), ":3: ", "missing"},
         {ascii_ply("element vertex 99999999999999999999\n" + xyz, ""), ":3: ", "integer"},
         {ascii_ply("property float x\n", ""), ":3: ", "before the first element"},
         {ascii_ply("element vertex 0\nproperty real x\n", ""), ":4: ", "'real'"},
         {ascii_ply("element vertex 0\nproperty float\n", ""), ":4: ", "no name"},
         {ascii_ply("element vertex 0\nproperty list float int x\n", ""), ":4: ", "integer type"},
         {ascii_ply("element vertex 0\nproperty list\n", ""), ":4: ", "type"},
         {ascii_ply("elements vertex 0\n", ""), ":3: ", "'elements'"},
         {ascii_ply("element vertex 0\n" + xyz + "element vertex 0\n", ""), ":7: ", "twice"},
         {ascii_ply("", ""), ": ", "no vertices"},
         {ascii_ply("comment label 0 Fl\xfcgel\n", ""), ":3: ", "UTF-8"},
         {ascii_ply("element vertex 0\n" + xyz + "property float y\n", ""), ": ", "twice"},
         {ascii_ply("element vertex 0\n" + xyz + "element face 0\nproperty list uchar int vertex_indices\n" +
                        "property int label\nproperty float label\n",
                    ""),
          ": ", "labels twice"},
         {ascii_ply("element vertex 0\nproperty float x\nproperty float y\n", ""), ": ", "no property z"},
         {ascii_ply("element vertex 0\n" + xyz + "element face 1\nproperty int label\n", ""), ": ", "vertex_indices"},
         {ascii_ply("element vertex 0\n" + xyz + "element face 1\nproperty list uchar float vertex_indices\n", ""),
          ": ", "integers"},
         {ascii_ply("element vertex 0\n" + xyz + "element tristrips 0\nproperty int length\n", ""), ": ",
          "tristrips has no property vertex_indices"},
         {ascii_ply("element vertex 1\n" + xyz + "element tristrips 1\nproperty list int int vertex_indices\n",
                    "0 0 0\n3 0 -1 1\n"),
          ":11: ", "strip 0 names vertex 1"},
         {ascii_ply("element vertex 1\n" + xyz + "element tristrips 1\nproperty list int int vertex_indices\n",
                    "0 0 0\n3 0 -2 0\n"),
          ":11: ", "vertex -2"}});
}

TEST(BadFile, PlyAsciiBody) {
    const auto body = [](const std::string& counts_and_body) {
        const std::size_t bar = counts_and_body.find('|');
        return ascii_ply("element vertex 3\nproperty float x\nproperty int y\nproperty float z\nelement face " +
                             counts_and_body.substr(0, bar) +
                             "\nproperty list char int vertex_indices\nproperty float label\n",
                         counts_and_body.substr(bar + 1));
    };
    const std::string vertices = "0 0 0\n1 0 0\n0 1 0\n";
    expect_errors("a.ply", {{body("1|"), ": ", "vertex"},
                            {body("1|0 0 0\n1 0 0\n"), ": ", "'vertex'"},
                            {body("1|0 0 0\n1 0 0\n\n\n\n\n\n"), ":", "vertex"},
                            {body("4000000000|" + vertices + "3 0 1 2 0\n"), ": ", "4000000000"},
                            {body("9223372036854775807|" + vertices + "3 0 1 2 0\n"), ": ", "'face'"},
                            {body("2|" + vertices + "3 0 1 2 0\n"), ":14: ", "face"},
                            {body("1|0 0 0\n1 0.5 0\n0 1 0\n3 0 1 2 0\n"), ":12: ", "'0.5'"},
                            {body("1|0 0 0\n1 0 a\n0 1 0\n3 0 1 2 0\n"), ":12: ", "'a'"},
                            {body("1|0 0 0\n1 0\n0 1 0\n3 0 1 2 0\n"), ":12: ", "'z' is missing"},
                            {body("1|" + vertices + "3 0 1 3 0\n"), ":14: ", "face 0 names vertex 3"},
                            {body("1|" + vertices + "3 0 1 -1 0\n"), ":14: ", "vertex -1"},
                            {body("1|" + vertices + "-3 0 1 2 0\n"), ":14: ", "-3 items"},
                            {body("1|" + vertices + "100 0 1 2 0\n"), ":14: ", "100 items"},
                            {body("1|" + vertices + "3 0 1 2\n"), ":14: ", "'label' is missing"},
                            {body("1|" + vertices + "3 0 1 2 1.5\n"), ":14: ", "label 1.5"},
                            {body("1|" + vertices + "3 0 1 2 1e10\n"), ":14: ", "32-bit"},
                            {body("1|" + vertices + "3 0 1 2 nan\n"), ":14: ", "label nan"}});
}

TEST(BadFile, PlyBinaryBody) {
    for (bool big_endian : {false, true}) {
        const std::string good = mesh_files::binary_ply(big_endian);
        const std::size_t begin = good.find("end_header\n") + 11;
        for (std::size_t size = begin; size < good.size(); ++size) read_error("a.ply", good.substr(0, size));
        std::string bad = good;
        bad[good.size() - 2 - (big_endian ? 0 : 3)] = 4;  // the last corner of the last face
        EXPECT_THAT(read_error("a.ply", bad), AllOf(HasSubstr("byte "), HasSubstr("face 1 names vertex 4")));
        bad = good;
        bad.replace(bad.find("element face 2"), 14, "element face 9");
        EXPECT_THAT(read_error("a.ply", bad), HasSubstr("byte "));
        bad.replace(bad.find("element face 9"), 14, "element face 4000000000");
        EXPECT_THAT(read_error("a.ply", bad), HasSubstr("4000000000 rows of element 'face'"));
        bad = good;
        bad[begin + 4 * 15] = bad[begin + 4 * 15 + 1] = '\xff';  // the item count of the first list
        EXPECT_THAT(read_error("a.ply", bad), AllOf(HasSubstr("byte "), HasSubstr("65535 items")));
    }
}

TEST(BadFile, Stl) {
    const std::string facet =
        "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n";
    expect_errors(
        "a.stl",
        {{"solid\n", ":1: ", "endsolid"},
         {"solid\n" + facet, ":8: ", "endsolid"},
         {"solid\nfacet\n", ":2: ", "outer loop"},
         {"solid\nface\nendsolid\n", ":2: ", "'face'"},
         {"solidity\n" + facet + "endsolid\n", ":1: ", "solid is expected"},
         {"solid\nfacet\nouter loop\nvertex 0 0\n", ":4: ", "z of a vertex"},
         {"solid\nfacet\nouter loop\nvertex 0 0 q\n", ":4: ", "'q'"},
         {"solid\nfacet\nouter loop\nvertex 0 0 0\nvertex 0 0 0\nendloop\n", ":6: ", "vertex is expected"},
         {"solid\nfacet\nouter loop\nvertex 0 0 0\nvertex 0 0 0\nvertex 0 0 0\nvertex 0 0 0\n",
          ":7: ", "endloop is expected"},
         {"solid\nfacet\nouter ring\n", ":3: ", "loop is expected"},
         {"solid a facet normal 0 0 1 outer loop vertex 0 0 0 vertex 1 0 0 endloop endfacet endsolid",
          ":1: ", "vertex is expected, not 'endloop'"},
         {"solid a facet normal 0 0 1 outer loop vertex 0 0 0 vertex 1 0 0 vertex 0 1 0 endloop endfacet",
          ":1: ", "endsolid"},
         {"\xff\xfe" + std::string(100, ' '), ": ", "UTF-16"},
         {"<html><body>" + std::string(100, ' '), ":1: ", "begins with the word solid, not with '<html><body>'"}});
    const std::string binary = mesh_files::binary_stl({{0, 0, 0, 1, 0, 0, 0, 1, 0}, {0, 0, 0, 1, 0, 0, 0, 1, 0}});
    for (std::size_t size = 1; size < binary.size(); ++size)
        EXPECT_THAT(read_error("a.stl", binary.substr(0, size)), HasSubstr("byte "));
    std::string absurd = binary;
    absurd.replace(80, 4, "\xff\xff\xff\xff");
    EXPECT_THAT(read_error("a.stl", absurd), AllOf(HasSubstr("byte 80"), HasSubstr("4294967295 triangles")));
}

const std::string& buffer_bytes() {
    static const std::string bytes = mesh_files::tetrahedron_positions() + mesh_files::tetrahedron_indices();
    return bytes;
}
/// The tetrahedron's document with `from` replaced by `to`, as .glb.
std::string edited_glb(const std::string& from, const std::string& to) {
    std::string json = tetrahedron_gltf("");
    const std::size_t at = json.find(json_text(from));
    EXPECT_NE(at, std::string::npos) << from;
    json.replace(at, from.size(), json_text(to));
    return glb_of(json, buffer_bytes());
}

/// A sparse part of `count` elements whose places are in a buffer view of the tetrahedron, and its values in the first.
std::string sparse_part(int count, int view, int type) {
    return "'sparse':{'count':" + std::to_string(count) + ",'indices':{'bufferView':" + std::to_string(view) +
           ",'componentType':" + std::to_string(type) + "},'values':{'bufferView':0}}";
}

TEST(BadFile, GltfIndicesAndLengths) {
    expect_errors(
        "a.glb",
        {{edited_glb("'version':'2.0'", "'version':'1.0'"), ": ", "'1.0'"},
         {edited_glb("'scene':0", "'scene':1"), ": ", "scene 1"},
         {edited_glb("'nodes':[0]", "'nodes':[1]"), ": ", "node 1"},
         {edited_glb("'nodes':[0]", "'nodes':[-1]"), ": ", "node -1"},
         {edited_glb("'mesh':0", "'mesh':7"), ": ", "mesh 7"},
         {edited_glb("'mesh':0", "'children':[0]"), ": ", "its own ancestor"},
         {edited_glb("'mesh':0", "'children':[5]"), ": ", "node 5"},
         {edited_glb("'mesh':0", "'mesh':0,'matrix':[1,2,3]"), ": ", "matrix of 3"},
         {edited_glb("'mesh':0", "'mesh':0,'rotation':[1,2,3]"), ": ", "rotation of 3"},
         {edited_glb("'POSITION':0", "'POSITION':9"), ": ", "accessor 9"},
         {edited_glb("'POSITION':0", "'POSITION':1"), ": ", "accessor 1"},
         {edited_glb("'POSITION':0", "'POSITION':-3"), ": ", "accessor -3"},
         {edited_glb("'indices':1", "'indices':0"), ": ", "accessor 0"},
         {edited_glb("'indices':1", "'indices':2"), ": ", ""},
         {edited_glb("'componentType':5123", "'componentType':5126"), ": ", "no unsigned integers"},
         {edited_glb("'componentType':5123", "'componentType':5125"), ": ", "accessor 1"},
         {edited_glb("'componentType':5123", "'componentType':7"), ": ", ""},
         {edited_glb("'count':4", "'count':3"), ": ", "names vertex 3"},
         {edited_glb("'count':4", "'count':5"), ": ", "5 elements of accessor 0"},
         {edited_glb("'count':4", "'count':0"), ": ", "accessor 0"},
         {edited_glb("'count':4", "'count':18446744073709551615"), ": ", "accessor 0"},
         {edited_glb("'count':12", "'count':11"), ": ", "whole triangles"},
         {edited_glb("'bufferView':0", "'bufferView':0,'byteOffset':18446744073709551615"), ": ", "accessor 0"},
         {edited_glb("'bufferView':0,'componentType':5126,'count':4", "'componentType':5126,'count':4000000000"), ": ",
          "4000000000 elements of accessor 0"},
         {edited_glb("'componentType':5126,", sparse_part(-1, 1, 5123) + ",'componentType':5126,"), ": ", "negative"},
         {edited_glb("'componentType':5126,", sparse_part(1, 7, 5123) + ",'componentType':5126,"), ": ",
          "buffer view 7"},
         {edited_glb("'componentType':5126,", sparse_part(13, 1, 5123) + ",'componentType':5126,"), ": ",
          "13 elements of accessor 0"},
         {edited_glb("'componentType':5126,", sparse_part(1, 0, 5126) + ",'componentType':5126,"), ": ",
          "no unsigned integers"},
         {edited_glb("'componentType':5126,", sparse_part(4, 0, 5125) + ",'componentType':5126,"), ": ",
          "names element"},
         {edited_glb("'bufferView':0", "'bufferView':9"), ": ", "buffer view 9"},
         {edited_glb("'buffer':0,'byteLength':48", "'buffer':1,'byteLength':48"), ": ", "buffer 1"},
         {edited_glb("'byteLength':48", "'byteLength':4800"), ": ", "past the end"},
         {edited_glb("'byteOffset':48", "'byteOffset':18446744073709551612"), ": ", "past the end"},
         {edited_glb("'byteLength':48", "'byteLength':48,'byteStride':3"), ": ", "byteStride"},
         {edited_glb("'byteLength':72", "'byteLength':7200"), ": ", ""},
         {edited_glb("'byteLength':72", "'byteLength':0"), ": ", ""},
         {edited_glb("'byteLength':72}", "'byteLength':72},{'byteLength':72}"), ": ", "buffer 1 has no bytes"},
         {edited_glb("'byteLength':72}", "'uri':'/etc/hostname','byteLength':72}"), ": ", "no file in the folder"},
         {edited_glb("'byteLength':72}", "'uri':'../x','byteLength':72}"), ": ", "no file in the folder"},
         {edited_glb("'byteLength':72}", "'uri':'x%00y','byteLength':72}"), ": ", "no file in the folder"},
         {edited_glb("'byteLength':72}", "'uri':'x%zz','byteLength':72}"), ": ", "no file in the folder"},
         {edited_glb("'byteLength':72}", "'uri':'x%4','byteLength':72}"), ": ", "no file in the folder"},
         {edited_glb("'byteLength':72}", "'uri':'y/%2e%2E/%2e./x','byteLength':72}"), ": ", "no file in the folder"},
         {edited_glb("'byteLength':72}", "'uri':'https://example.com/a.bin','byteLength':72}"), ": ",
          "buffer 0 is an address on the net, 'https://example.com/a.bin'; download it beside this file"},
         {edited_glb("'byteLength':72}", "'uri':'file:///etc/hostname','byteLength':72}"), ": ",
          "no file in the folder"},
         {edited_glb("'byteLength':72}", "'uri':'C:/x.bin','byteLength':72}"), ": ", "no file in the folder"},
         {edited_glb("'type':'VEC3'", "'type':'VEC9'"), ": the JSON is no valid glTF (", "export it again"},
         {edited_glb("'scene':0", "'extensionsRequired':['EXT_other_compression'],'scene':0"), ": ",
          "needs the extension 'EXT_other_compression'"}});
}

TEST(BadFile, GltfContainerAndJson) {
    const std::string good = glb_of(tetrahedron_gltf(""), buffer_bytes());
    for (std::size_t size = 4; size < good.size(); size += 7) read_error("a.glb", good.substr(0, size));
    std::string bad = good;
    bad[4] = 1;
    EXPECT_THAT(read_error("a.glb", bad), AllOf(HasSubstr("byte 4"), HasSubstr("version 1")));
    bad = good;
    bad.replace(12, 4, "\xff\xff\xff\x7f");
    EXPECT_THAT(read_error("a.glb", bad), AllOf(HasSubstr("byte 12"), HasSubstr("past the end")));
    bad = good;
    bad.replace(16, 4, "XXXX");
    EXPECT_THAT(read_error("a.glb", bad), HasSubstr("no JSON chunk"));
    // The binary chunk may not claim the eight bytes of its own header.
    bad = good;
    bad.replace(good.size() - buffer_bytes().size() - 8, 4,
                bytes_of(static_cast<std::uint32_t>(buffer_bytes().size() + 8)));
    EXPECT_THAT(read_error("a.glb", bad), HasSubstr("past the end"));

    EXPECT_THAT(read_error("a.gltf", "{\"asset\":"), HasSubstr("byte 9"));
    EXPECT_THAT(read_error("a.gltf", "[1,2]"), HasSubstr("object"));
    EXPECT_THAT(read_error("a.gltf", "{}"), HasSubstr("a.gltf"));
    EXPECT_THAT(read_error("a.gltf", "{\"extras\":" + std::string(200000, '[')), HasSubstr("too deep"));
    EXPECT_THAT(read_error("a.gltf", tetrahedron_gltf("'uri':'data:application/octet-stream;base64,AAAA',")),
                HasSubstr("buffer 0 has 3 bytes instead of 72"));
    for (const std::string uri : {"data:application/octet-stream;base64,AA#A", "data:text/plain,%4", "data:nothing"})
        EXPECT_THAT(read_error("a.gltf", tetrahedron_gltf("'uri':'" + uri + "',")), HasSubstr("cannot be decoded"));
    EXPECT_THAT(read_error("a.gltf", tetrahedron_gltf("'uri':'missing.bin',")), HasSubstr("missing.bin"));
    EXPECT_THAT(read_error("a.gltf", tetrahedron_gltf("")), HasSubstr("buffer 0 has no bytes"));
    EXPECT_THAT(read_error("a.gltf", json_text("{'meshes':{'a':{}},'nodes':{'b':{}}}")),
                AllOf(HasSubstr("version '1.0'"), HasSubstr("as glTF 2.0")));
    EXPECT_THAT(read_error("a.gltf", json_text("{'asset':{'generator':'x'}}")), HasSubstr("no version"));
}

/// A folder with a.gltf whose buffer is buffer.bin, beside other files.
class GltfBufferFile : public testing::Test {
  protected:
    GltfBufferFile() {
        std::filesystem::create_directories(folder_ / "in/below");
        mesh_files::write_bytes(folder_ / "in/a.gltf", tetrahedron_gltf("'uri':'buffer.bin',"));
        mesh_files::write_bytes(folder_ / "out.bin", buffer_bytes());
        mesh_files::write_bytes(folder_ / "in/below/in.bin", buffer_bytes());
    }
    void link_to(const std::filesystem::path& target) const { std::filesystem::create_symlink(target, buffer_); }
    std::string error() const {
        return error_of<MeshError>([&] { read_mesh(folder_ / "in/a.gltf"); });
    }
    mesh_files::TemporaryFolder folder_;
    std::filesystem::path buffer_ = folder_ / "in/buffer.bin";
};

TEST_F(GltfBufferFile, LinksThatLeadOutAreRefused) {
    for (const std::filesystem::path& target : {folder_ / "out.bin", std::filesystem::path("../out.bin")}) {
        link_to(target);
        EXPECT_THAT(error(), AllOf(HasSubstr("a.gltf: "), HasSubstr("buffer.bin"), HasSubstr("leads out"),
                                   HasSubstr("put a copy")));
        std::filesystem::remove(buffer_);
    }
    std::filesystem::create_directory_symlink(folder_.path(), folder_ / "in/up");
    mesh_files::write_bytes(folder_ / "in/a.gltf", tetrahedron_gltf("'uri':'up/out.bin',"));
    EXPECT_THAT(error(), HasSubstr("leads out"));
}

TEST_F(GltfBufferFile, LinksThatStayInsideAreFollowed) {
    link_to("below/in.bin");
    EXPECT_EQ(read_mesh(folder_ / "in/a.gltf").mesh.face_count(), 4U);
    std::filesystem::create_directory_symlink(folder_ / "in", folder_ / "elsewhere");
    EXPECT_EQ(read_mesh(folder_ / "elsewhere/a.gltf").mesh.face_count(), 4U);
}

TEST_F(GltfBufferFile, WhatIsNoFileIsRefused) {
    link_to("/dev/zero");
    EXPECT_THAT(error(), HasSubstr("leads out"));
    std::filesystem::remove(buffer_);
    link_to("nowhere");
    EXPECT_THAT(error(), HasSubstr("buffer.bin"));
    std::filesystem::remove(buffer_);
    ASSERT_EQ(mkfifo(buffer_.c_str(), 0600), 0);
    EXPECT_THAT(error(), HasSubstr("is no file"));
    std::filesystem::remove(buffer_);
    std::filesystem::create_directory(buffer_);
    EXPECT_THAT(error(), HasSubstr("is no file"));
}

TEST_F(GltfBufferFile, HasAtLeastTheBytesThatTheJsonTells) {
    mesh_files::write_bytes(buffer_, buffer_bytes() + "more");
    EXPECT_EQ(read_mesh(folder_ / "in/a.gltf").mesh.face_count(), 4U);
    // A hole costs no disk, but reading it would cost its memory.
    std::filesystem::resize_file(buffer_, std::uintmax_t{1} << 40);
    EXPECT_EQ(read_mesh(folder_ / "in/a.gltf").mesh.face_count(), 4U);
    mesh_files::write_bytes(buffer_, buffer_bytes().substr(1));
    EXPECT_THAT(error(), HasSubstr("71 bytes instead of 72"));
    mesh_files::write_bytes(buffer_, "");
    EXPECT_THAT(error(), HasSubstr("0 bytes instead of 72"));
    std::string declared = tetrahedron_gltf("'uri':'buffer.bin',");
    declared.replace(declared.find("\"byteLength\":72"), 15, "\"byteLength\":1099511627776");
    mesh_files::write_bytes(folder_ / "in/a.gltf", declared);
    EXPECT_THAT(error(), HasSubstr("larger than 2 GiB"));
}

TEST_F(GltfBufferFile, OneFileMayServeTwoBuffers) {
    link_to("below/in.bin");
    for (const std::string second : {"below/in.bin", "buffer.bin"}) {
        std::string twice = tetrahedron_gltf("'uri':'buffer.bin',");
        twice.insert(twice.rfind("]}"), mesh_files::json_text(",{'uri':'" + second + "','byteLength':72}"));
        const std::string view = json_text("{'buffer':0,'byteOffset':48");  // that of the indices
        twice.replace(twice.find(view), view.size(), json_text("{'buffer':1,'byteOffset':48"));
        mesh_files::write_bytes(folder_ / "in/a.gltf", twice);
        EXPECT_EQ(read_mesh(folder_ / "in/a.gltf").mesh.face_count(), 4U);
    }
}

TEST(BadFile, GltfMeshesRepeatedBeyondMeasure) {
    // A thousand nodes with a mesh of a thousand primitives each ask for millions of triangles from a small file.
    std::string json = tetrahedron_gltf("");
    const std::string primitive = json_text("{'attributes':{'POSITION':0},'indices':1}");
    std::string primitives = primitive, nodes = json_text("[{'mesh':0}");
    std::string roots = "[0";
    for (int i = 1; i < 1000; ++i) {
        primitives += ',';
        primitives += primitive;
        nodes += json_text(",{'mesh':0}");
        roots += ',';
        roots += std::to_string(i);
    }
    json.replace(json.find(primitive), primitive.size(), primitives);
    json.replace(json.find(json_text("[{'mesh':0}")), 11, nodes);
    json.replace(json.find("[0]"), 3, roots + "]");
    EXPECT_THAT(read_error("a.glb", glb_of(json, buffer_bytes())), HasSubstr("repeats its meshes"));
}

}  // namespace
}  // namespace exemplar
