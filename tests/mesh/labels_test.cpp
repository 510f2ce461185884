#include "host/mesh/labels.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>

#include "tests/support/mesh_files.h"
#include "tests/support/shapes.h"

namespace exemplar {
namespace {

using mesh_files::error_of;
using mesh_files::TemporaryFolder;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

/// CIE L*a*b* of an sRGB color (D65).
Vec3d lab_of(const Color& color) {
    Vec3d linear;
    for (int i = 0; i < 3; ++i) {
        const double s = color[static_cast<std::size_t>(i)] / 255.0;
        linear[i] = s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4);
    }
    Eigen::Matrix3d xyz_of_rgb;
    xyz_of_rgb << 0.4124564, 0.3575761, 0.1804375, 0.2126729, 0.7151522, 0.0721750, 0.0193339, 0.1191920, 0.9503041;
    Vec3d f = (xyz_of_rgb * linear).cwiseQuotient(Vec3d(0.95047, 1, 1.08883));
    for (double& t : f) t = t > 216.0 / 24389 ? std::cbrt(t) : (24389.0 / 27 * t + 16) / 116;
    return {116 * f[1] - 16, 500 * (f[0] - f[1]), 200 * (f[1] - f[2])};
}

TEST(LabelColor, TwentyColorsAreFarApart) {
    for (std::size_t i = 0; i < 20; ++i) {
        EXPECT_GT((lab_of(label_color(i)) - lab_of(k_unlabeled_color)).norm(), 25) << i;
        for (std::size_t j = 0; j < i; ++j)
            EXPECT_GT((lab_of(label_color(i)) - lab_of(label_color(j))).norm(), 35) << i << " " << j;
    }
}

TEST(LabelColor, RepeatsWithOtherLightness) {
    for (std::size_t i = 0; i < 20; ++i) {
        const double lightness = lab_of(label_color(i))[0];
        EXPECT_LT(lab_of(label_color(i + 20))[0], lightness - 5) << i;
        EXPECT_GT(lab_of(label_color(i + 40))[0], lightness + 3) << i;
    }
    EXPECT_NO_THROW(label_color(static_cast<std::size_t>(-1)));
}

FaceLabels read_labels(const std::string& text, std::size_t faces) {
    const TemporaryFolder folder;
    mesh_files::write_bytes(folder / "a_labels.txt", text);
    return read_labels_txt(folder / "a_labels.txt", faces);
}
std::string labels_error(const std::string& text, std::size_t faces) {
    return error_of<DataError>([&] { read_labels(text, faces); });
}

TEST(LabelsTxt, BlankLinesSpacesAndRepeatedNamesAreFine) {
    const FaceLabels labels = read_labels("leg \r\n 2 4 \r\n\r\n\nupper arm\n\nleg\n1\n\nhead\n3", 4);
    EXPECT_THAT(labels.names, ElementsAre("leg", "upper arm", "head"));
    EXPECT_THAT(labels.label, ElementsAre(0, 0, 2, 0));
}

TEST(LabelsTxt, NamesAreUtf8) {
    const std::string wing = "Fl\xc3\xbcgel";
    EXPECT_THAT(read_labels("\xef\xbb\xbf" + wing + "\n1 2\n", 2).names, ElementsAre(wing));
    EXPECT_THAT(labels_error("leg\n1\nFl\xfcgel\n2\n", 2), AllOf(HasSubstr(":3: "), HasSubstr("UTF-8")));
}

TEST(LabelsTxt, NamesMayBeNumbers) {
    EXPECT_THAT(read_labels("0\n1\n1\n2 3\n", 3).names, ElementsAre("0", "1"));
}

TEST(LabelsTxt, ErrorsNameFileAndLine) {
    EXPECT_THAT(labels_error("leg\n1 2\narm\n4\n", 5),
                AllOf(HasSubstr("a_labels.txt:4: "), HasSubstr("2 of 5"), HasSubstr("face 3")));
    EXPECT_THAT(labels_error("leg\n1 2\narm\n2 3\n", 3),
                AllOf(HasSubstr(":4: "), HasSubstr("face 2"), HasSubstr("'leg' and 'arm'")));
    EXPECT_THAT(labels_error("leg\n1 2 2\n", 2), AllOf(HasSubstr(":2: "), HasSubstr("two labels")));
    EXPECT_THAT(labels_error("leg\n1 4\n", 3), AllOf(HasSubstr(":2: "), HasSubstr("face 4"), HasSubstr("3 faces")));
    EXPECT_THAT(labels_error("leg\n0 1\n", 3), AllOf(HasSubstr(":2: "), HasSubstr("counted from 1")));
    EXPECT_THAT(labels_error("leg\n-1\n", 3), HasSubstr(":2: "));
    EXPECT_THAT(labels_error("leg\n1 two\n", 3), AllOf(HasSubstr(":2: "), HasSubstr("'two'")));
    EXPECT_THAT(labels_error("leg\n99999999999999999999\n", 3), HasSubstr(":2: "));
    EXPECT_THAT(labels_error("leg\n1 2\n3 4\n", 4), AllOf(HasSubstr(":3: "), HasSubstr("label name")));
    EXPECT_THAT(labels_error("", 1), HasSubstr("1 of 1"));
}

TEST(LabelsTxt, MissingFilesAndFoldersAreDataErrors) {
    const TemporaryFolder folder;
    EXPECT_THAT(error_of<DataError>([&] { read_labels_txt(folder / "none.txt", 3); }), HasSubstr("none.txt"));
    EXPECT_THAT(error_of<DataError>([&] { read_seg(folder / "none.seg", 3); }), HasSubstr("none.seg"));
    EXPECT_THROW(read_labels_txt(folder / "", 3), DataError);
}

TEST(Seg, SegmentsAreConnectedPartsInOrderOfFirstFace) {
    // Two separate squares of two triangles each, and a strip of four squares with a stripe of another label.
    const TemporaryFolder folder;
    const TriangleMesh strip = shapes::grid(4, 1, 4);
    write_seg(folder / "strip.seg", strip, {{"a", "b"}, {0, 0, 1, 1, 0, 0, 0, 0}});
    EXPECT_THAT(read_seg(folder / "strip.seg", 8), ElementsAre(0, 0, 1, 1, 2, 2, 2, 2));
    const TriangleMesh two = shapes::joined(shapes::grid(1, 1, 1), shapes::grid(1, 1, 1));
    write_seg(folder / "two.seg", two, {{"a"}, {0, 0, 0, 0}});
    EXPECT_THAT(read_seg(folder / "two.seg", 4), ElementsAre(0, 0, 1, 1));
    write_seg(folder / "unlabeled.seg", two, {{"a"}, {-1, 0, -1, -1}});
    EXPECT_THAT(read_seg(folder / "unlabeled.seg", 4), ElementsAre(0, 1, 2, 2));
}

TEST(Seg, NumbersAreOfSourceFaces) {
    // Quads 0 1 2 in a row, and a face 3 of two corners that has no triangle.
    const MeshFile file = mesh_files::read_as("a.off",
                                              "OFF\n8 4 0\n0 0 0\n1 0 0\n2 0 0\n3 0 0\n0 1 0\n1 1 0\n2 1 0\n3 1 0\n"
                                              "4 0 1 5 4\n4 1 2 6 5\n4 2 3 7 6\n2 0 1\n");
    const TemporaryFolder folder;
    write_seg(folder / "a.seg", file.mesh, {{"a", "b"}, {0, 1, 1, 0}});
    EXPECT_EQ(read_file(folder / "a.seg"), "0\n1\n1\n2\n");
}

TEST(Seg, ErrorsNameFileAndLine) {
    const TemporaryFolder folder;
    const auto seg_error = [&](const std::string& text, std::size_t faces) {
        mesh_files::write_bytes(folder / "a.seg", text);
        return error_of<DataError>([&] { read_seg(folder / "a.seg", faces); });
    };
    EXPECT_THAT(seg_error("0\n1\n-1\n", 3), HasSubstr("a.seg:3: "));
    EXPECT_THAT(seg_error("0\nx\n1\n", 3), AllOf(HasSubstr(":2: "), HasSubstr("'x'")));
    EXPECT_THAT(seg_error("0\n0 1\n1\n", 3), HasSubstr(":2: "));
    EXPECT_THAT(seg_error("0\n1\n", 3), AllOf(HasSubstr("2 segment numbers"), HasSubstr("3 faces")));
    EXPECT_THAT(seg_error("0\n1\n2\n3\n", 3), HasSubstr(":4: "));
    EXPECT_THAT(seg_error("4000000000\n", 1), HasSubstr(":1: "));
    mesh_files::write_bytes(folder / "a.seg", "2\r\n\r\n0\r\n");
    EXPECT_THAT(read_seg(folder / "a.seg", 2), ElementsAre(2, 0));
}

/// Reads every mesh, label and segment file of the benchmark, if there is one.
TEST(SlowBenchmarkFiles, AllCanBeRead) {
    const char* const data = std::getenv("EXEMPLAR_DATA");
    if (!data || !*data)
        GTEST_SKIP() << "set EXEMPLAR_DATA to the folder that holds labeled/ and seg/ (docs/testing.md)";
    const std::filesystem::path labeled = std::filesystem::path(data) / "labeled";
    ASSERT_TRUE(std::filesystem::is_directory(labeled)) << labeled << " is no folder of meshes with labels";
    std::size_t meshes = 0;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(labeled)) {
        if (entry.path().extension() != ".off") continue;
        const MeshFile file = read_mesh(entry.path());
        EXPECT_THAT(file.warnings, testing::IsEmpty()) << entry.path();
        const auto labels_path = entry.path().parent_path() / (entry.path().stem().string() + "_labels.txt");
        EXPECT_GE(read_labels_txt(labels_path, file.mesh.source_face_count).names.size(), 1u) << labels_path;
        const auto segments = std::filesystem::path(data) / "seg" / entry.path().stem();
        if (std::filesystem::is_directory(segments)) {
            for (const auto& seg : std::filesystem::directory_iterator(segments))
                EXPECT_NO_THROW(read_seg(seg.path(), file.mesh.source_face_count)) << seg.path();
        }
        ++meshes;
    }
    EXPECT_GT(meshes, 0u);
}

}  // namespace
}  // namespace exemplar
