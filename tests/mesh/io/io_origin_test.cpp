// Files whose position would take up the precision of floats.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <random>

#include "host/mesh/io/io_text.h"
#include "tests/support/mesh_files.h"
#include "tests/support/shapes.h"

namespace exemplar {
namespace {

using mesh_files::bytes_of;
using mesh_files::read_as;
using testing::HasSubstr;
using testing::IsEmpty;

const Vec3d k_place(431234.125, 4581234.75, 112.5);

std::string off_at(const TriangleMesh& mesh, const Vec3d& place, const Vec3d& scale = Vec3d::Ones()) {
    std::string text = fmt::format("OFF\n{} {} 0\n", mesh.vertex_count(), mesh.face_count());
    for (const Vec3& p : mesh.vertices) {
        const Vec3d q = place + p.cast<double>().cwiseProduct(scale);
        text += fmt::format("{} {} {}\n", q[0], q[1], q[2]);
    }
    for (const auto& [a, b, c] : mesh.faces) text += fmt::format("3 {} {} {}\n", a, b, c);
    return text;
}

std::string obj_at(const TriangleMesh& mesh, const Vec3d& place) {
    std::string text;
    for (const Vec3& p : mesh.vertices) {
        const Vec3d q = place + p.cast<double>();
        text += fmt::format("v {} {} {}\n", q[0], q[1], q[2]);
    }
    for (const auto& [a, b, c] : mesh.faces) text += fmt::format("f {} {} {}\n", a + 1, b + 1, c + 1);
    return text;
}

/// A PLY file of coordinates of type T.
template <typename T>
std::string ply_at(const TriangleMesh& mesh, const Vec3d& place) {
    const char* const type = sizeof(T) == 8 ? "double" : "float";
    std::string bytes = fmt::format(
        "ply\nformat binary_little_endian 1.0\nelement vertex {0}\nproperty {1} x\nproperty {1} y\nproperty {1} z\n"
        "element face {2}\nproperty list uchar int vertex_indices\nend_header\n",
        mesh.vertex_count(), type, mesh.face_count());
    for (const Vec3& p : mesh.vertices)
        for (int i = 0; i < 3; ++i) bytes += bytes_of(static_cast<T>(place[i] + double{p[i]}));
    for (const Face& face : mesh.faces) bytes += '\3' + bytes_of(face);
    return bytes;
}

/// The largest distance of a vertex from where it is in the file, per extent of `mesh`.
double error_at(const TriangleMesh& read, const TriangleMesh& mesh, const Vec3d& place) {
    double largest = 0;
    for (std::size_t v = 0; v < mesh.vertex_count(); ++v)
        largest = std::max(
            largest, (read.origin + read.vertices[v].cast<double>() - place - mesh.vertices[v].cast<double>()).norm());
    return largest / bounding_box(mesh).diagonal();
}

TEST(Origin, GeographicCoordinatesKeepTheirShape) {
    const TriangleMesh ball = shapes::icosphere(3, 1);
    for (const MeshFile& file : {read_as("a.off", off_at(ball, k_place)), read_as("a.obj", obj_at(ball, k_place)),
                                 read_as("a.ply", ply_at<double>(ball, k_place))}) {
        EXPECT_LT(error_at(file.mesh, ball, k_place), 1e-7);
        EXPECT_LT(bounding_box(file.mesh).high.norm(), 10) << "near the origin";
        EXPECT_THAT(file.warnings, IsEmpty());
    }
}

TEST(Origin, EachAxisHasItsOwnUnit) {
    const TriangleMesh ball = shapes::icosphere(3, 1);
    const MeshFile file = read_as("a.off", off_at(ball, {11.5, 48.1, 3}, {1e-5, 1e-5, 1}));
    double largest = 0;
    for (std::size_t v = 0; v < ball.vertex_count(); ++v)
        largest = std::max(largest, std::abs(file.mesh.origin[0] + double{file.mesh.vertices[v][0]} - 11.5 -
                                             1e-5 * double{ball.vertices[v][0]}));
    EXPECT_LT(largest, 1e-11);
}

TEST(Origin, DegreesBesideAHeightGiveAWarning) {
    const TriangleMesh ball = shapes::icosphere(3, 1);
    const MeshFile file = read_as("a.off", off_at(ball, {11.5, 48.1, 500}, {1e-5, 1e-5, 1}));
    ASSERT_EQ(file.warnings.size(), 1U);
    EXPECT_THAT(file.warnings[0], testing::AllOf(HasSubstr("degrees"), HasSubstr("project them to meters")));
    EXPECT_THAT(read_as("a.off", off_at(ball, k_place)).warnings, IsEmpty());
    EXPECT_THAT(read_as("a.off", off_at(ball, {0, 0, 0}, {1e-5, 1e-5, 1})).warnings, IsEmpty());
}

TEST(Origin, FacesThatAreLeftOutDoNotCount) {
    const std::string vertices = "OFF\n3 1 0\n42949672952 3 0\n42949672954 0 8\n42949672957 4 1\n";
    EXPECT_NE(read_as("a.off", vertices + "3 0 1 2\n").mesh.origin, Vec3d::Zero());
    EXPECT_EQ(read_as("a.off", vertices + "2 0 1\n").mesh.origin, Vec3d::Zero());
}

TEST(Origin, OrdinaryFilesAreReadBitForBitAsFloats) {
    std::mt19937 random(7);
    const auto coordinate = [&](double middle) {
        return fmt::format("{:.12g}", middle + std::uniform_real_distribution<double>(-1, 1)(random));
    };
    for (const double middle : {0.0, 0.5, 30.0}) {
        std::string text = "OFF\n300 100 0\n";
        std::vector<float> expected;
        for (int i = 0; i < 900; ++i) {
            // The third coordinate is flat, but for the rounding of doubles.
            const std::string word = i % 3 == 2 ? fmt::format("{}", 0.1 + 1e-16 * (i % 2)) : coordinate(middle);
            expected.push_back(*mesh_io::parse_float(word));
            text += word + (i % 3 == 2 ? '\n' : ' ');
        }
        for (int f = 0; f < 100; ++f) text += fmt::format("3 {} {} {}\n", 3 * f, 3 * f + 1, 3 * f + 2);
        const MeshFile file = read_as("a.off", text);
        EXPECT_EQ(file.mesh.origin, Vec3d::Zero());
        for (std::size_t i = 0; i < 900; ++i)
            EXPECT_EQ(file.mesh.vertices[i / 3][static_cast<int>(i % 3)], expected[i]);
    }
}

TEST(Origin, LooseVerticesDoNotCount) {
    TriangleMesh ball = shapes::icosphere(2, 1);
    const std::size_t ball_vertices = ball.vertex_count();
    ball.vertices.push_back((-k_place).cast<float>());  // the file's origin
    MeshFile file = read_as("a.off", off_at(ball, k_place));
    ball.vertices.resize(ball_vertices);
    EXPECT_LT(error_at(file.mesh, ball, k_place), 1e-7);
}

TEST(Origin, FilesAreWrittenInTheirOwnFrame) {
    const TriangleMesh ball = shapes::icosphere(2, 1);
    const MeshFile file = read_as("a.off", off_at(ball, k_place));
    const mesh_files::TemporaryFolder folder;
    write_off(folder / "b.off", file.mesh);
    write_obj(folder / "b.obj", file.mesh);
    write_ply(folder / "b.ply", file.mesh);
    for (const char* name : {"b.off", "b.obj", "b.ply"})
        EXPECT_LT(error_at(read_mesh(folder / name).mesh, ball, k_place), 1e-7) << name;
    const FaceLabels labels{{"a"}, std::vector<std::int32_t>(ball.face_count(), 0)};
    write_gltf(folder / "b.glb", file.mesh, labels);
    const BoundingBox box = bounding_box(read_mesh(folder / "b.glb").mesh);
    EXPECT_LT(((box.low + box.high) / 2 - k_place).norm(), 1);
}

TEST(Origin, FloatsFarFromTheOriginGiveAWarning) {
    const TriangleMesh ball = shapes::icosphere(2, 1);
    const MeshFile file = read_as("a.ply", ply_at<float>(ball, k_place));
    ASSERT_EQ(file.warnings.size(), 1U);
    EXPECT_THAT(file.warnings[0],
                testing::AllOf(HasSubstr("times its size away from the origin"), HasSubstr("move it")));
    EXPECT_THAT(read_as("a.ply", ply_at<float>(ball, {100, 200, 100})).warnings, IsEmpty());
}

TEST(ParseNumber, RoundsToTheFloatThatIsNearestToTheText) {
    std::mt19937_64 random(11);
    const auto check = [](const std::string& word) {
        const auto number = mesh_io::parse_number(word);
        const auto expected = mesh_io::parse_float(word);
        ASSERT_EQ(number.has_value(), expected.has_value()) << word;
        if (!expected || std::isnan(*expected)) return;
        EXPECT_EQ(static_cast<float>(*number), *expected) << word;
    };
    for (int i = 0; i < 20'000; ++i) {
        const float x = std::bit_cast<float>(static_cast<std::uint32_t>(random()));
        if (!std::isfinite(x)) continue;
        const double middle = (double{x} + double{std::nextafter(x, INFINITY)}) / 2;  // exact
        const std::string digits = fmt::format("{:.760f}", middle);
        check(digits);
        check(digits + "1");
        check(fmt::format("{}", middle));
        check(fmt::format("{}", x));
    }
    for (const char* word :
         {"0", "-0", "nan", "inf", "1e39", "-1e39", "1e999", "1e-60", "+1", "1x", "", "-", "3.4028236e38"})
        check(word);
    EXPECT_EQ(mesh_io::parse_number("4581235.25"), 4581235.25) << "halfway between two floats";
}

}  // namespace
}  // namespace exemplar
