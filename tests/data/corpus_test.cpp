#include "host/data/corpus.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "host/core/errors.h"
#include "host/core/files.h"
#include "host/mesh/io/io.h"
#include "tests/support/temporary_folder.h"

namespace exemplar {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

class CorpusFolder : public testing::Test {
  protected:
    void write(const std::string& name, const std::string& content) const {
        write_file_atomically(folder_ / name, [&](std::ostream& out) { out << content; });
    }
    std::string error_of(const std::vector<fs::path>& paths, const std::vector<std::string>& names = {}) const {
        try {
            load_corpus(paths, names);
        } catch (const Error& error) {
            return error.what();
        }
        return "no error";
    }
    TemporaryFolder folder_;
    static constexpr const char* k_quad_and_triangle =
        "OFF\n5 2 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n2 0 0\n4 0 1 2 3\n3 1 4 2\n";
};

TEST_F(CorpusFolder, ListsFoldersInNaturalOrder) {
    for (const char* name : {"10.off", "9.off", "a2.obj", "notes.txt", "a10.PLY"}) write(name, "");
    std::vector<std::string> names;
    for (const fs::path& path : list_meshes(folder_.path())) names.push_back(path.filename().string());
    EXPECT_THAT(names, ElementsAre("9.off", "10.off", "a2.obj", "a10.PLY"));
}

TEST_F(CorpusFolder, ReadsListsRelativeToThemselves) {
    write("m.off", k_quad_and_triangle);
    write("list.txt", "# meshes\n  m.off   # the only one\n\n");
    EXPECT_THAT(list_meshes(folder_ / "list.txt"), ElementsAre(folder_ / "m.off"));
    write("odd.txt", "m.off\r\n m.off\t# and\r\n#m.off\r\n");
    EXPECT_THAT(list_meshes(folder_ / "odd.txt"), ElementsAre(folder_ / "m.off", folder_ / "m.off"));
    write("a#1.off", k_quad_and_triangle);
    write("hash.txt", "a#1.off\n");
    EXPECT_THAT(list_meshes(folder_ / "hash.txt"), ElementsAre(folder_ / "a#1.off"));
    write("bad.txt", "m.off\nn.off\n");
    try {
        list_meshes(folder_ / "bad.txt");
        FAIL();
    } catch (const DataError& error) {
        EXPECT_THAT(error.what(), HasSubstr("bad.txt:2"));
        EXPECT_THAT(error.what(), HasSubstr("n.off"));
    }
}

TEST_F(CorpusFolder, EmptyAndMissingSourcesAreErrors) {
    EXPECT_THROW(list_meshes(folder_.path()), DataError);
    EXPECT_THROW(list_meshes(folder_ / "none"), DataError);
}

TEST_F(CorpusFolder, LabelsOfPolygonsReachTheirTriangles) {
    write("m.off", k_quad_and_triangle);
    write("m_labels.txt", "seat\n1\nleg\n2\n");
    const LabeledCorpus corpus = load_corpus({folder_ / "m.off"});
    EXPECT_THAT(corpus.names, ElementsAre("leg", "seat"));
    EXPECT_THAT(corpus.meshes[0].label, ElementsAre(1, 1, 0));
    EXPECT_THAT(to_source_faces(corpus.meshes[0].mesh, corpus.meshes[0].label), ElementsAre(1, 0));
    const std::vector<std::int32_t> torn{0, 1, 0};
    EXPECT_EQ(to_source_faces(corpus.meshes[0].mesh, torn).size(), 2U);
}

TEST_F(CorpusFolder, PolygonsWithoutTrianglesTakeTheLabelBesideThem) {
    write("m.off", "OFF\n4 6 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n1 0\n0\n3 0 1 2\n2 0 1\n3 0 2 3\n1 3\n");
    const TriangleMesh mesh = read_mesh(folder_ / "m.off").mesh;
    EXPECT_THAT(to_source_faces(mesh, std::vector<std::int32_t>{2, 5}), ElementsAre(2, 2, 2, 2, 5, 5));
    FaceLabels labels{{"a", "b", "c", "d", "e", "f"}, to_source_faces(mesh, std::vector<std::int32_t>{2, 5})};
    write_labels_txt(folder_ / "m_labels.txt", labels);
    EXPECT_THAT(load_corpus({folder_ / "m.off"}).meshes[0].label, ElementsAre(0, 1));
}

TEST_F(CorpusFolder, UnknownLabelsSuggestTheNearest) {
    write("m.off", k_quad_and_triangle);
    write("m_labels.txt", "seet\n1\nleg\n2\n");
    EXPECT_THAT(error_of({folder_ / "m.off"}, {"leg", "seat"}), HasSubstr("'seet' (did you mean 'seat'?)"));
}

TEST_F(CorpusFolder, MissingLabelsNameWhatIsAccepted) {
    write("m.off", k_quad_and_triangle);
    EXPECT_THAT(error_of({folder_ / "m.off"}), HasSubstr("m_labels.txt"));
}

TEST_F(CorpusFolder, LabelsOfAnotherFolderReplaceThoseBesideTheMesh) {
    write("m.off", k_quad_and_triangle);
    write("m_labels.txt", "seat\n1\nleg\n2\n");
    write("style/m_labels.txt", "whole\n1 2\n");
    const LabeledCorpus corpus = load_corpus({folder_ / "m.off"}, {}, folder_ / "style");
    EXPECT_THAT(corpus.names, ElementsAre("whole"));
    EXPECT_THAT(corpus.meshes[0].label, ElementsAre(0, 0, 0));
    try {
        load_corpus({folder_ / "m.off"}, {}, folder_ / "other");  // not those beside the mesh: styles must not mix
        FAIL() << "labels were found in a folder that is not there";
    } catch (const DataError& error) {
        EXPECT_THAT(error.what(), AllOf(HasSubstr((folder_ / "other" / "m_labels.txt").string()), HasSubstr("m.off")));
    }
}

TEST_F(CorpusFolder, LabelsOfEqualNamesAreOneLabel) {
    write("a.off", k_quad_and_triangle);
    write("a_labels.txt", "leg\n1\nseat\n2\n");
    write("b.off", k_quad_and_triangle);
    write("b_labels.txt", "arm\n1\nleg\n2\n");
    const LabeledCorpus corpus = load_corpus({folder_ / "a.off", folder_ / "b.off"});
    EXPECT_THAT(corpus.names, ElementsAre("arm", "leg", "seat"));
    EXPECT_THAT(corpus.meshes[0].label, ElementsAre(1, 1, 2));
    EXPECT_THAT(corpus.meshes[1].label, ElementsAre(0, 0, 1));
}

TEST_F(CorpusFolder, MissingMeshesOfAListNameTheLineAndTheNearestFile) {
    write("chair.off", k_quad_and_triangle);
    write("list.txt", "chair.off\n\nchiar.off\n");
    try {
        list_meshes(folder_ / "list.txt");
        FAIL() << "a missing mesh was accepted";
    } catch (const DataError& error) {
        EXPECT_THAT(error.what(), AllOf(HasSubstr("list.txt:3: no such mesh: chiar.off"),
                                        HasSubstr("did you mean '" + (folder_ / "chair.off").string() + "'")));
    }
}

TEST_F(CorpusFolder, EmptyMeshesAreRefused) {
    write("m.off", "OFF\n3 0 0\n0 0 0\n1 0 0\n0 1 0\n");
    write("m_labels.txt", "");
    EXPECT_NE(error_of({folder_ / "m.off"}), "no error");
}

}  // namespace
}  // namespace exemplar
