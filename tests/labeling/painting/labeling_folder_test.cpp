#include "host/labeling/painting/labeling_folder.h"

#include <gtest/gtest.h>

#include <chrono>
#include <fstream>

#include "host/core/errors.h"
#include "host/core/files.h"
#include "host/labeling/painting/painting_file.h"
#include "host/mesh/io/io.h"
#include "tests/support/shapes.h"
#include "tests/support/temporary_folder.h"

namespace exemplar {
namespace {

class InFolder : public ::testing::Test {
  protected:
    InFolder() {
        for (const char* name : {"a.off", "b.off"}) write_off(folder_.path() / name, shapes::icosphere(0, 1.0F));
    }
    void write(const std::string& name, const std::string& text) { std::ofstream(folder_.path() / name) << text; }
    std::vector<std::int32_t> halves() const {
        std::vector<std::int32_t> label(20, 0);
        for (std::size_t f = 10; f < 20; ++f) label[f] = 1;
        return label;
    }
    TemporaryFolder folder_;
};

using LabelingFolderTest = InFolder;
using PaintingFileTest = InFolder;

TEST_F(PaintingFileTest, ComesBackAsItWas) {
    const std::filesystem::path path = painting_path(folder_.path() / "a.off");
    EXPECT_EQ(path.filename(), "a_painting.json");
    Painting painting{{{"left \"arm\"", {1, 2, 3}}, {"b\xc3\xa4r", {255, 0, 127}}}, {}};
    for (std::int32_t f = 0; f < 20; ++f) painting.label.push_back(f % 7 < 3 ? -1 : f % 2);
    save_painting(path, painting);
    const Painting read = load_painting(path, 20);
    EXPECT_EQ(read.label, painting.label);
    ASSERT_EQ(read.palette.size(), 2u);
    EXPECT_EQ(read.palette[0].name, painting.palette[0].name);
    EXPECT_EQ(read.palette[1].color, painting.palette[1].color);
}

TEST_F(PaintingFileTest, RefusesWhatIsDamaged) {
    const std::filesystem::path path = folder_.path() / "x.json";
    const auto refused = [&](const std::string& text, const std::string& says) {
        write("x.json", text);
        try {
            load_painting(path, 20);
            ADD_FAILURE() << text << " was read";
        } catch (const DataError& error) {
            const std::string what = error.what();
            EXPECT_NE(what.find(says), std::string::npos) << what;
            EXPECT_NE(what.find("x.json"), std::string::npos) << what;
            EXPECT_EQ(what.find('\n'), std::string::npos) << what;
        }
    };
    const std::string head = R"({"kind": "exemplar painting", "format_version": 1, "faces": 20, "labels": )";
    refused("", "it is damaged");
    refused("[]", "it is damaged");
    refused(R"({"kind": "other"})", "this is no painting");
    refused(R"({"kind": "exemplar painting", "format_version": 9})", "another version");
    refused(R"({"kind": "exemplar painting", "format_version": 1, "faces": 21})",
            "a mesh with 21 faces, and this one has 20");
    refused(head + R"([{"name": "a", "color": "#000000", "faces": [[19, 2]]}]})",
            "faces 19 + 2 of a mesh with 20 faces");
    refused(head + R"([{"name": "a", "color": "#000000", "faces": [[5, 18446744073709551615]]}]})",
            "of a mesh with 20 faces");
    refused(head + R"([{"name": "a", "color": "#000000", "faces": [[-1, 1]]}]})", "of a mesh with 20 faces");
    refused(head + R"([{"name": "", "color": "#000000", "faces": []}]})", "a label needs a name");
}

TEST(LabelNames, AreTrimmedAndChecked) {
    EXPECT_EQ(checked_label_name("  left arm "), "left arm");
    EXPECT_EQ(checked_label_name("12"), "12");
    EXPECT_THROW(checked_label_name("   "), UsageError);
    EXPECT_THROW(checked_label_name("a\nb"), UsageError);
    EXPECT_THROW(checked_label_name(std::string(101, 'a')), UsageError);
}

TEST_F(LabelingFolderTest, VerifiedLabelsAndStrokesAreInFilesBesideTheShapes) {
    LabelingFolder folder(folder_.path());
    ASSERT_EQ(folder.shapes().size(), 2u);
    EXPECT_EQ(folder.verified_count(), 0u);
    folder.set_palette({{"low", {1, 2, 3}}, {"high", {4, 5, 6}}});
    std::vector<std::int32_t> strokes(20, -1);
    strokes[3] = 1;
    folder.save_strokes(0, strokes);
    EXPECT_TRUE(folder.shapes()[0].begun);
    EXPECT_EQ(LabelingFolder(folder_.path()).read_strokes(0, 20), strokes);
    EXPECT_THROW(folder.save_labels(0, strokes), DataError) << "faces without a label";
    folder.save_labels(0, halves());
    EXPECT_FALSE(std::filesystem::exists(painting_path(folder.shapes()[0].path)));
    LabelingFolder again(folder_.path());
    EXPECT_TRUE(again.shapes()[0].verified);
    EXPECT_FALSE(again.shapes()[1].verified);
    EXPECT_EQ(again.palette()[1].color, (Color{4, 5, 6}));
    EXPECT_EQ(again.read_labels(0, 20), halves());
    EXPECT_EQ(again.read_strokes(0, 20), std::nullopt);
}

TEST_F(LabelingFolderTest, LabelsOfOthersJoinThePalette) {
    write("palette.json", R"({"labels": [{"name": "wing", "color": "#010203"}, {"name": "tail"}]})");
    write("a_labels.txt", "tail\n1 2 3 4 5 6 7 8 9 10\nbody\n11 12 13 14 15 16 17 18 19 20\n");
    LabelingFolder folder(folder_.path());
    ASSERT_EQ(folder.palette().size(), 3u);
    EXPECT_EQ(folder.palette()[0].color, (Color{1, 2, 3}));
    EXPECT_EQ(folder.palette()[2].name, "body");
    const std::vector<std::int32_t> labels = folder.read_labels(0, 20);
    EXPECT_EQ(labels[0], 1);
    EXPECT_EQ(labels[19], 2);
}

TEST_F(LabelingFolderTest, ADamagedPaletteIsToldAndLeft) {
    for (const char* text :
         {"{", "[]", R"({"labels": 3})", R"({"labels": [{"name": 3}]})", R"({"labels": [{"name": " "}]})"}) {
        write("palette.json", text);
        const LabelingFolder folder(folder_.path());
        EXPECT_EQ(folder.warnings().size(), 1u) << text;
        EXPECT_TRUE(folder.palette().empty());
    }
}

TEST_F(LabelingFolderTest, LabelsThatAnotherProgramChangedAreReplacedOnlyAtTheSecondTime) {
    LabelingFolder folder(folder_.path()), other(folder_.path());
    for (LabelingFolder* each : {&folder, &other}) each->set_palette({{"low", {}}, {"high", {}}});
    other.save_labels(0, std::vector<std::int32_t>(20, 1));
    EXPECT_THROW(folder.save_labels(0, halves()), DataError);
    EXPECT_EQ(other.read_labels(0, 20), std::vector<std::int32_t>(20, 1));
    folder.save_labels(0, halves());
    EXPECT_EQ(other.read_labels(0, 20), halves());
}

TEST_F(LabelingFolderTest, EqualOrTooManyNamesAreRefused) {
    LabelingFolder folder(folder_.path());
    EXPECT_THROW(folder.set_palette({{"a", {}}, {"a", {}}}), UsageError);
    EXPECT_THROW(folder.set_palette({{"a", {}}, {"", {}}}), UsageError);
    EXPECT_THROW(folder.set_palette(std::vector<PaletteEntry>(65, {"a", {}})), UsageError);
    EXPECT_TRUE(folder.palette().empty());
}

}  // namespace
}  // namespace exemplar
