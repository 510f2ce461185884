#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <sstream>

#include "host/core/random.h"
#include "tests/support/mesh_files.h"

namespace exemplar {
namespace {

using mesh_files::read_as;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

using V = std::vector<Vec3>;

/// Area vector of all triangles of a mesh.
Vec3d area_sum(const TriangleMesh& mesh) {
    Vec3d sum = Vec3d::Zero();
    for (const Face& f : mesh.faces) {
        const Vec3d a = mesh.vertices[f[0]].cast<double>();
        sum += 0.5 * (mesh.vertices[f[1]].cast<double>() - a).cross(mesh.vertices[f[2]].cast<double>() - a);
    }
    return sum;
}
double total_area(const TriangleMesh& mesh) {
    double area = 0;
    for (float a : face_areas(mesh)) area += a;
    return area;
}

TEST(ReadOff, TrianglesKeepOrderAndNeedNoSourceMap) {
    const MeshFile file = read_as("a.off", "OFF\n4 2 5\n0 0 0\n1 0 0\n1 1 0.5\n-1e-3 +2 .25\n3 0 1 2\n3 0 2 3\n");
    EXPECT_EQ(file.mesh.vertices, (V{{0, 0, 0}, {1, 0, 0}, {1, 1, 0.5f}, {-1e-3f, 2, 0.25f}}));
    EXPECT_THAT(file.mesh.faces, ElementsAre(Face{0, 1, 2}, Face{0, 2, 3}));
    EXPECT_THAT(file.mesh.source_face, IsEmpty());
    EXPECT_EQ(file.mesh.source_face_count, 2u);
    EXPECT_THAT(file.warnings, IsEmpty());
    EXPECT_FALSE(file.labels.has_value());
}

TEST(ReadOff, TakesEveryFormOfHeaderSpacingAndComment) {
    const std::string body = "0 0 0 9 9\n1 0 0 9 9\n0 1 0 9 9\n3 0 1 2 255 0 0\n";
    for (const std::string& text :
         {"OFF\n3 1 0\n" + body, "OFF 3 1 0\n" + body,
          "# made by hand\n\nOFF # header\n # counts\n3 1 0 # that many\n\n" + body, "COFF\n3 1\n" + body,
          "NOFF\n3 1 3\n" + body, "CNOFF\n3 1 3\n" + body, "STCNOFF 3 1 3\n" + body, "OFF3 1 0\n" + body,
          "COFF3\t1\n" + body, "\xef\xbb\xbfOFF\n3 1 3\n" + body}) {
        const MeshFile file = read_as("a.off", text);
        EXPECT_EQ(file.mesh.vertices, (V{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}})) << text;
        EXPECT_THAT(file.mesh.faces, ElementsAre(Face{0, 1, 2})) << text;
    }
}

TEST(ReadOff, TakesAllLineEndsAndExtensionCase) {
    const std::string unix_text = "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2";
    std::string dos, mac;
    for (char c : unix_text) {
        dos += c == '\n' ? std::string("\r\n") : std::string(1, c);
        mac += c == '\n' ? '\r' : c;
    }
    for (const std::string& text : {unix_text, dos, mac}) {
        const MeshFile file = read_as("A.OFF", text);
        EXPECT_THAT(file.mesh.vertices, SizeIs(3));
        EXPECT_THAT(file.mesh.faces, ElementsAre(Face{0, 1, 2}));
    }
}

TEST(ReadOff, AnyWhiteSpaceSeparatesNumbers) {
    for (const char* const text :
         {"OFF 3 1 0 0 0 0 1 0 0 0 1 0 3 0 1 2", "OFF 3 1 0\n0 0 0 1 0 0 0 1 0\n3 0 1 2\n",
          "OFF\n3 1 0 0 0 0 1 0 0\n0 1 0 3\n0 1 2\n", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0\n1\n2\n",
          "OFF\n3 1 0\n0 0 0\n1 0 0 9 9\n0 1\n0\n3 0 1\n2\n", "OFF\n3\n1\n0\n0\n0\n0\n1\n0\n0\n0\n1\n0\n3\n0\n1\n2\n",
          "OFF\n3 1\n0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n",
          "COFF 3 1 0\n0 0 0 1 1 1 1 1 0 0 1 1 1 1\n0 1 0 1 1 1 1 3 0 1 2\n",
          "CNOFF 3 1 0 0 0 0 1 1 1 1 0 0 1 1 0 0 1 1 1 1 0 0 1 0 1 0 1 1 1 1 0 0 1 3 0 1 2"}) {
        const MeshFile file = read_as("a.off", text);
        EXPECT_EQ(file.mesh.vertices, (V{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}})) << text;
        EXPECT_THAT(file.mesh.faces, ElementsAre(Face{0, 1, 2})) << text;
        EXPECT_THAT(file.warnings, IsEmpty()) << text;
    }
}

TEST(ReadOff, NumbersBeyondFloatsBecomeInfinityOrZero) {
    const MeshFile file = read_as("a.off", "OFF\n3 0 0\nnan inf -inf\n1e39 -1e39 1e999\n1e-60 -1e-999 0\n");
    const V& v = file.mesh.vertices;
    EXPECT_TRUE(std::isnan(v[0][0]));
    for (float x : {v[0][1], v[1][0], v[1][2]}) EXPECT_EQ(x, INFINITY);
    for (float x : {v[0][2], v[1][1]}) EXPECT_EQ(x, -INFINITY);
    EXPECT_EQ(v[2], Vec3(0, 0, 0));
}

TEST(ReadOff, SmallPolygonsAreLeftOutButCounted) {
    const MeshFile file = read_as("a.off", "OFF\n3 4 0\n0 0 0\n1 0 0\n0 1 0\n2 0 1\n3 0 1 2\n0\n3 2 1 0\n");
    EXPECT_THAT(file.mesh.faces, ElementsAre(Face{0, 1, 2}, Face{2, 1, 0}));
    EXPECT_THAT(file.mesh.source_face, ElementsAre(1u, 3u));
    EXPECT_EQ(file.mesh.source_face_count, 4u);
    ASSERT_THAT(file.warnings, SizeIs(1));
    EXPECT_THAT(file.warnings[0], HasSubstr("2 faces have fewer than three corners"));
}

TEST(ReadOff, MixedPolygonsCarryTheirSourceFace) {
    // A two-corner and a four-corner face have as many corners as two triangles.
    const MeshFile file = read_as("a.off", "OFF\n4 2 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n2 0 1\n4 0 1 2 3\n");
    EXPECT_THAT(file.mesh.faces, SizeIs(2));
    EXPECT_THAT(file.mesh.source_face, ElementsAre(1u, 1u));
    EXPECT_EQ(file.mesh.source_face_count, 2u);
}

TEST(ReadOff, WhatFollowsTheFacesIsLeftOutWithARemark) {
    const MeshFile file = read_as("a.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n3 0 2 1\n");
    EXPECT_THAT(file.mesh.faces, SizeIs(1));
    ASSERT_THAT(file.warnings, SizeIs(1));
    EXPECT_THAT(file.warnings[0], HasSubstr("line 7"));
}

std::string off_polygon(const V& points) {
    std::ostringstream text, face;
    text << "OFF\n" << points.size() << " 1 0\n";
    face << points.size();
    for (std::size_t i = 0; i < points.size(); ++i) {
        text << points[i].transpose() << '\n';
        face << ' ' << i;
    }
    return text.str() + face.str() + '\n';
}

/// Triangles of a simple polygon tile it: areas add up and none is turned around.
void expect_tiles(const V& points, double area) {
    const MeshFile file = read_as("a.off", off_polygon(points));
    ASSERT_EQ(file.mesh.face_count(), points.size() - 2);
    EXPECT_EQ(file.mesh.source_face_count, 1u);
    EXPECT_THAT(file.mesh.source_face, testing::Each(0u));
    EXPECT_NEAR(total_area(file.mesh), area, 1e-5 * area);
    EXPECT_NEAR(area_sum(file.mesh).norm(), area, 1e-5 * area);
    for (float a : face_areas(file.mesh)) EXPECT_GT(a, 0.0f);
}

TEST(Triangulation, ConvexAndConcavePolygonsAreTiled) {
    expect_tiles({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, 1);                         // square
    expect_tiles({{0, 0, 0}, {4, 0, 0}, {1, 1, 0}, {0, 4, 0}}, 4);                         // dart, apex at corner 2
    expect_tiles({{1, 1, 0}, {0, 4, 0}, {0, 0, 0}, {4, 0, 0}}, 4);                         // dart, apex at corner 0
    expect_tiles({{4, 0, 0}, {1, 1, 0}, {0, 4, 0}, {0, 0, 0}}, 4);                         // dart, apex at corner 1
    expect_tiles({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}}, 4);              // corners in one line
    expect_tiles({{0, 0, 0}, {0, 0, 3}, {0, 1, 3}, {0, 1, 1}, {0, 3, 1}, {0, 3, 0}}, 5);   // L, in another plane
    expect_tiles({{0, 0, 0}, {9, 0, 0}, {9, 9, 0}, {8, 1, 0}, {1, 1, 0}, {0, 9, 0}}, 17);  // U
}

TEST(Triangulation, RandomStarPolygonsAreTiled) {
    Random random(7);
    for (int round = 0; round < 20; ++round) {
        const std::size_t n = 5 + random.index(40);
        V points;
        double area = 0;
        for (std::size_t i = 0; i < n; ++i) {
            const double angle = 6.283185307179586 * static_cast<double>(i) / static_cast<double>(n);
            const double r = random.uniform(1, 5);
            points.push_back({static_cast<float>(r * std::cos(angle)), static_cast<float>(r * std::sin(angle)), 1.0f});
        }
        for (std::size_t i = 0; i < n; ++i) {
            const Vec3 &a = points[i], &b = points[(i + 1) % n];
            area += 0.5 * (double(a.x()) * b.y() - double(a.y()) * b.x());
        }
        expect_tiles(points, area);
    }
}

TEST(Triangulation, BadPolygonsAreCutSomehow) {
    const V crossed{{0, 0, 0}, {1, 1, 0}, {1, 0, 0}, {0, 1, 0}}, flat{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}};
    const V points{{0, 0, 0}, {0, 0, 0}, {0, 0, 0}, {0, 0, 0}, {0, 0, 0}};
    for (const V& polygon : {crossed, flat, points})
        EXPECT_EQ(read_as("a.off", off_polygon(polygon)).mesh.face_count(), polygon.size() - 2);
    EXPECT_THAT(read_as("a.off", "OFF\n4 1 0\nnan 0 0\n1 0 0\n1 1 inf\n0 1 0\n4 0 1 2 3\n").mesh.faces, SizeIs(2));
}

TEST(ReadObj, PolygonsNegativeIndicesAndContinuedLines) {
    const MeshFile file = read_as("a.obj",
                                  "# c\nmtllib none.mtl\no x\nv 0 0 0\nv\t1 0 0\nv 1 1 0 1.0 # w\nvt 0 0\nvn 0 0 1\n"
                                  "f 1 2 3\nv 0 1 0 0.2 0.3 0.4\nf -4 -3 -2 -1\nusemtl red\ns off\ng a b\n"
                                  "f 1//1 \\\n  3/1 4/1/1\np 1\n");
    EXPECT_EQ(file.mesh.vertices, (V{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}));
    EXPECT_THAT(file.mesh.faces, ElementsAre(Face{0, 1, 2}, Face{0, 1, 2}, Face{0, 2, 3}, Face{0, 2, 3}));
    EXPECT_THAT(file.mesh.source_face, ElementsAre(0u, 1u, 1u, 2u));
    EXPECT_EQ(file.mesh.source_face_count, 3u);
}

TEST(ReadObj, FacesOfFewCornersAndFilesOfOtherThings) {
    const std::string vertices = "v 0 0 0\r\nv 1 0 0\r\nv 0 1 0\r\n";
    for (const char* small : {"f", "f 1", "f 1 2", "f \\\r\n", "f 1 2 \\"}) {
        const MeshFile file = read_as("a.obj", vertices + "f 1 2 3\r\n" + small);
        EXPECT_THAT(file.mesh.faces, ElementsAre(Face{0, 1, 2})) << small;
        EXPECT_THAT(file.mesh.source_face, ElementsAre(0u)) << small;
        EXPECT_EQ(file.mesh.source_face_count, 2u) << small;
        EXPECT_THAT(file.warnings, SizeIs(1)) << small;
    }
    EXPECT_THAT(read_as("a.obj", vertices + "vp 1\ncstype bezier\nend\nfo 1 2 3\n\x01\x02\n").mesh.faces, SizeIs(0));
}

TEST(ReadObj, NotANumberIsReadAndFloatsAreExact) {
    const MeshFile file = read_as("a.obj", "v nan -inf 16777217\nv 0.1 1.17549435e-38 3.4028235e38\n");
    EXPECT_TRUE(std::isnan(file.mesh.vertices[0][0]));
    EXPECT_EQ(file.mesh.vertices[0][1], -INFINITY);
    EXPECT_EQ(file.mesh.vertices[0][2], 16777216.0f);
    EXPECT_EQ(file.mesh.vertices[1], Vec3(0.1f, 1.17549435e-38f, 3.4028235e38f));
}

TEST(ReadPly, AsciiWithExtraElementsBeforeAndAfter) {
    const MeshFile file = read_as("a.ply",
                                  "ply\r\nformat ascii 1.0\r\ncomment a label is not named here\r\nelement camera 1\r\n"
                                  "property float fov\r\nelement face 1\r\nproperty uchar red\r\n"
                                  "property list uchar int vertex_index\r\nelement empty 7\r\nelement vertex 3\r\n"
                                  "property float nx\r\nproperty float x\r\nproperty double y\r\nproperty int z\r\n"
                                  "property list uchar float more\r\nend_header\r\n"
                                  "45\r\n255 3 2 1 0\r\n0 1 2 3 0\r\n0 4 5 6 1 9\r\n0 7 8 9 2 1 2\r\n");
    EXPECT_EQ(file.mesh.vertices, (V{{1, 2, 3}, {4, 5, 6}, {7, 8, 9}}));
    EXPECT_THAT(file.mesh.faces, ElementsAre(Face{2, 1, 0}));
    EXPECT_FALSE(file.labels.has_value());
    EXPECT_THAT(file.warnings, IsEmpty());
}

TEST(ReadPly, BinaryInBothByteOrders) {
    for (bool big_endian : {false, true}) {
        const MeshFile file = read_as("a.ply", mesh_files::binary_ply(big_endian));
        EXPECT_EQ(file.mesh.vertices, (V{{0, 0, 0}, {1, 0, -1}, {0, 1, -2}, {1, 1, -3}}));
        EXPECT_THAT(file.mesh.faces, ElementsAre(Face{0, 1, 2}, Face{1, 2, 3}));
        ASSERT_TRUE(file.labels.has_value());
        EXPECT_THAT(file.labels->names, ElementsAre("left", "right side"));
        EXPECT_THAT(file.labels->label, ElementsAre(0, 1));
    }
}

TEST(ReadPly, TriangleStripsTurnEveryOtherTriangle) {
    // Two strips in one list; the first repeats a vertex to turn a corner.
    const MeshFile file = read_as("a.ply",
                                  "ply\nformat ascii 1.0\nelement vertex 6\nproperty float x\nproperty float y\n"
                                  "property float z\nelement face 1\nproperty list uchar int vertex_indices\n"
                                  "property int label\nelement tristrips 1\nproperty list int int vertex_indices\n"
                                  "end_header\n0 0 0\n1 0 0\n0 1 0\n1 1 0\n0 2 0\n1 2 0\n3 3 4 5 7\n"
                                  "10 0 1 2 3 3 4 -1 5 4 3\n");
    EXPECT_THAT(file.mesh.faces, ElementsAre(Face{3, 4, 5}, Face{0, 1, 2}, Face{2, 1, 3}, Face{5, 4, 3}));
    ASSERT_TRUE(file.labels.has_value());
    EXPECT_THAT(file.labels->label, ElementsAre(0, -1, -1, -1));
    EXPECT_THAT(file.warnings, IsEmpty());
}

std::string labeled_ply(const std::string& comments, const std::string& type, const std::vector<std::string>& labels) {
    std::string text = "ply\nformat ascii 1.0\n" + comments +
                       "element vertex 4\nproperty float x\nproperty float y\nproperty float z\nelement face " +
                       std::to_string(labels.size()) + "\nproperty list uchar int vertex_indices\nproperty " + type +
                       " label\nend_header\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n";
    for (const std::string& label : labels) text += "4 0 1 2 3 " + label + "\n";
    return text;
}

TEST(ReadPly, LabelsArePerPolygonWithNamesFromComments) {
    for (const char* type : {"int", "uchar", "short", "float", "double"}) {
        const MeshFile file =
            read_as("a.ply", labeled_ply("comment label 1 leg\ncomment label 0 upper arm\n", type, {"1", "0", "1"}));
        ASSERT_TRUE(file.labels.has_value());
        EXPECT_THAT(file.labels->names, ElementsAre("upper arm", "leg"));
        EXPECT_THAT(file.labels->label, ElementsAre(1, 0, 1));
        EXPECT_EQ(file.mesh.face_count(), 6u);
    }
}

TEST(ReadPly, LabelsWithoutCommentsAreNamedByNumber) {
    const MeshFile file =
        read_as("a.ply", labeled_ply("comment label 7 head\n", "int", {"2000000000", "-1", "7", "3", "-5"}));
    ASSERT_TRUE(file.labels.has_value());
    EXPECT_THAT(file.labels->names, ElementsAre("3", "head", "2000000000"));
    EXPECT_THAT(file.labels->label, ElementsAre(2, -1, 1, 0, -1));
}

TEST(ReadStl, AsciiAndBinaryAreWelded) {
    for (const auto& sample : mesh_files::samples()) {
        if (!sample.file_name.ends_with(".stl")) continue;
        const MeshFile file = read_as(sample.file_name, sample.bytes);
        EXPECT_EQ(file.mesh.vertices, (V{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}})) << sample.file_name;
        EXPECT_THAT(file.mesh.faces, ElementsAre(Face{0, 1, 2}, Face{1, 3, 2})) << sample.file_name;
    }
}

TEST(ReadStl, BinaryMayBeginWithSolidAndHaveBytesLeftOver) {
    std::string bytes = mesh_files::binary_stl({{0, 0, 0, 1, 0, 0, 0, 1, 0}});
    bytes.replace(0, 6, "solid ");
    EXPECT_THAT(read_as("a.stl", bytes).mesh.faces, SizeIs(1));
    EXPECT_THAT(read_as("a.stl", bytes + "tail").mesh.faces, SizeIs(1));  // no text has zero bytes
    bytes.replace(0, 6, "SOLIX ");
    const MeshFile file = read_as("a.stl", bytes + "tail");
    EXPECT_THAT(file.mesh.faces, SizeIs(1));
    ASSERT_THAT(file.warnings, SizeIs(1));
    EXPECT_THAT(file.warnings[0], HasSubstr("4 bytes"));
}

TEST(ReadStl, AllOnOneLineWithAMarkAndWithKeywordsInNames) {
    const std::string facet = "facet normal 0 0 1 outer loop vertex 0 0 0 vertex 1 0 0 vertex 0 1 0 endloop endfacet";
    const std::string lines =
        "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n";
    for (const std::string& text : {"solid x " + facet + " endsolid x", "solid " + facet + "\nendsolid a solid facet\n",
                                    "solid facet of a solid\n" + lines + "endsolid facet of a solid\n",
                                    "\xef\xbb\xbfsolid x\n" + lines + "endsolid x\n"}) {
        const MeshFile file = read_as("a.stl", text);
        EXPECT_EQ(file.mesh.vertices, (V{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}})) << text;
        EXPECT_THAT(file.mesh.faces, ElementsAre(Face{0, 1, 2})) << text;
    }
    EXPECT_THAT(read_as("a.stl", "solid a " + facet + " endsolid a solid b " + facet + " endsolid b").mesh.faces,
                SizeIs(2));
}

TEST(ReadStl, SeveralSolidsAndAnyCase) {
    const std::string solid =
        "SOLID\nFACET NORMAL 0 0 1\nOUTER LOOP\nVERTEX 0 0 0\nVERTEX 1 0 0\nVERTEX 0 1 "
        "0\nENDLOOP\nENDFACET\nENDSOLID\n";
    EXPECT_THAT(read_as("a.stl", solid + solid).mesh.faces, ElementsAre(Face{0, 1, 2}, Face{0, 1, 2}));
}

}  // namespace
}  // namespace exemplar
