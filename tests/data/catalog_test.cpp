#include "host/data/catalog/catalog.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sqlite3.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <set>

#include "host/core/errors.h"
#include "host/data/catalog/catalog_run.h"
#include "tests/data/catalog_fixture.h"

namespace exemplar {
namespace {

namespace fs = std::filesystem;
using mesh_files::error_of;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

TEST_F(CatalogTest, KeepsWhatIsPutIntoIt) {
    CatalogShape shape = shape_at("/shapes/cup \xff\xfe.off");  // no UTF-8
    shape.warnings = "one\ntwo";
    shape.category = "cup";
    put({shape, shape_at("/shapes/b.obj")});
    const Catalog again(folder_ / "shapes.db", Database::Open::existing);
    const auto found = catalog_.find(shape.path);
    ASSERT_TRUE(found);
    EXPECT_EQ(found->path, shape.path);
    EXPECT_EQ(found->warnings, "one\ntwo");
    EXPECT_EQ(found->category, "cup");
    EXPECT_EQ(found->faces, 12);
    EXPECT_FALSE(catalog_.find("/shapes/c.obj"));
    EXPECT_EQ(catalog_.count(), 2);
    EXPECT_EQ(catalog_.count("category = 'cup'"), 1);
}

TEST_F(CatalogTest, WhatChangesIsReplacedAndKeepsItsNameAndCategory) {
    CatalogShape shape = shape_at("/a.off", "old");
    shape.category = "cup";
    shape.features = "entry";
    put({shape});
    put({shape_at("/a.off", "old")});
    EXPECT_EQ(all().front().features, "entry");
    CatalogShape changed = shape_at("/a.off", "new");
    changed.name = "other";
    changed.faces = 99;
    put({changed});
    ASSERT_EQ(all().size(), 1u);
    EXPECT_EQ(all().front().name, "a");
    EXPECT_EQ(all().front().category, "cup");
    EXPECT_EQ(all().front().faces, 99);
    EXPECT_EQ(all().front().features, "");  // they were those of another content
}

TEST_F(CatalogTest, NamesAreUnique) {
    put({shape_at("/x/a.off"), shape_at("/x/a.obj"), shape_at("/x/b.off")});
    std::vector<CatalogShape> same;
    for (int i = 0; i < 3; ++i) {
        same.push_back(shape_at("/y" + std::to_string(i) + "/a.off"));
        same.back().name = "x/a";
    }
    put(same);
    EXPECT_THAT(names(), ElementsAre("x/a", "x/a.obj", "x/b", "x/a.off", "x/a.2", "x/a.3"));
}

TEST_F(CatalogTest, LongNamesAreCutToBeUnique) {
    for (const std::size_t length : {195U, 199U, 200U, 255U}) {
        const std::string name(length, static_cast<char>('a' + length % 26));
        put({shape_at("/l/" + name + ".off"), shape_at("/l/" + name + ".obj"), shape_at("/m/l/" + name + ".off")});
    }
    std::string deep;
    for (int i = 0; i < 30; ++i) deep += std::string(90, 'd') + "/";
    put({shape_at("/" + deep + "a.off"), shape_at("/" + deep + "a.obj")});
    CatalogShape long_one = shape_at("/other.off");  // as a program might name it
    for (int i = 0; i < 10; ++i) long_one.name = std::string(90, 'n') + "/" + long_one.name;
    long_one.name.resize(1000, 'n');
    CatalogShape as_long = long_one;
    as_long.path = "/other.obj";
    put({long_one, as_long});
    const std::vector<std::string> all_names = names();
    EXPECT_EQ(std::set(all_names.begin(), all_names.end()).size(), all_names.size());
    for (const std::string& name : all_names) EXPECT_TRUE(is_output_name(name)) << name;
}

TEST_F(CatalogTest, ManyShapesOfOneNameAreSoonTold) {
    std::vector<CatalogShape> same;
    for (int i = 0; i < 5000; ++i) {
        same.push_back(shape_at(std::to_string(i) + "/model.obj"));
        same.back().name = "model";
    }
    put(same);
    const std::vector<std::string> all_names = names();
    EXPECT_EQ(std::set(all_names.begin(), all_names.end()).size(), 5000u);
    EXPECT_EQ(all_names[1], "model.obj");
    EXPECT_EQ(all_names[4999], "model.4999");
}

TEST_F(CatalogTest, AllOrNothingIsAdded) {
    CatalogShape bad = shape_at("/b.off");
    bad.name = "../b";
    EXPECT_THROW(put({shape_at("/a.off"), bad}), UsageError);
    EXPECT_EQ(catalog_.count(), 0);
}

TEST_F(CatalogTest, OtherFilesAreNoCatalogs) {
    const auto refused = [&](const std::string& name) {
        return error_of<DataError>([&] { Catalog(folder_ / name, Database::Open::existing); });
    };
    EXPECT_THAT(refused("shape.db"), AllOf(HasSubstr("no such catalog"), HasSubstr("shapes.db")));
    mesh_files::write_bytes(folder_ / "text.db", std::string(2000, 'x'));
    EXPECT_THAT(refused("text.db"), HasSubstr("no catalog"));
    EXPECT_FALSE(is_database(folder_ / "text.db"));
    EXPECT_TRUE(is_database(folder_ / "shapes.db"));
    Database(folder_ / "other.db", Database::Open::create).execute("CREATE TABLE t(x)");
    EXPECT_THAT(refused("other.db"), HasSubstr("SQLite file of something else"));
    mesh_files::write_bytes(folder_ / "empty.db", "");
    EXPECT_THAT(refused("empty.db"), HasSubstr("is empty, no catalog"));
    catalog_.database().execute("PRAGMA user_version = 99");
    EXPECT_THAT(refused("shapes.db"), AllOf(HasSubstr("format 99"), HasSubstr("newer")));
}

TEST(NewCatalog, SeveralProgramsMayMakeItAtOnce) {
    constexpr int k_programs = 8;
    const TemporaryFolder folder;
    for (int round = 0; round < 40; ++round) {
        const fs::path path = folder / (std::to_string(round) + ".db");
        std::array<int, 2> start{};  // all begin when its end is closed
        ASSERT_EQ(pipe(start.data()), 0);
        std::vector<pid_t> children;
        for (int i = 0; i < k_programs; ++i) {
            const pid_t child = fork();
            if (child == 0) {
                char nothing = 0;
                close(start[1]);
                if (read(start[0], &nothing, 1) != 0) _exit(2);
                try {
                    Catalog catalog(path, Database::Open::create);
                    const CatalogShape shape = shape_at("/" + std::to_string(i) + ".off");
                    catalog.put(std::span(&shape, 1));
                    _exit(0);
                } catch (const Error&) {
                    _exit(1);
                }
            }
            children.push_back(child);
        }
        close(start[0]);
        close(start[1]);
        for (const pid_t child : children) {
            int status = 0;
            waitpid(child, &status, 0);
            EXPECT_EQ(status, 0) << round;
        }
        EXPECT_EQ(Catalog(path, Database::Open::existing).count(), k_programs);
    }
}

TEST_F(CatalogTest, ADamagedCatalogIsAnErrorNotACrash) {
    std::vector<CatalogShape> shapes;
    shapes.reserve(300);
    for (int i = 0; i < 300; ++i) shapes.push_back(shape_at("/shapes/" + std::to_string(i) + ".off"));
    put(shapes);
    catalog_.database().execute("PRAGMA wal_checkpoint(TRUNCATE)");
    const std::string whole = read_file(folder_ / "shapes.db");
    for (std::size_t at = 100; at < whole.size(); at += whole.size() / 60) {
        std::string bytes = whole;
        for (std::size_t i = at; i < std::min(at + 40, bytes.size()); ++i)
            bytes[i] = static_cast<char>(bytes[i] ^ 0x5a);
        mesh_files::write_bytes(folder_ / "damaged.db", bytes);
        try {
            Catalog damaged(folder_ / "damaged.db", Database::Open::existing);
            damaged.for_each([](const CatalogShape&) {});
        } catch (const DataError& error) {
            EXPECT_THAT(error.what(), HasSubstr("damaged.db"));
        }
        for (const char* file : {"damaged.db", "damaged.db-wal", "damaged.db-shm"}) fs::remove(folder_ / file);
    }
}

TEST_F(CatalogTest, NothingOfAStrangersCatalogIsRun) {
    CatalogRun run(catalog_, "key", folder_.path(), "a model");
    put({shape_at("/a.off")});
    ShapeRecord record = record_for(all().front(), run);
    ASSERT_TRUE(run.finish(1, record));
    Database stranger(folder_ / "shapes.db", Database::Open::existing);
    stranger.prepare("UPDATE labels SET labels = ?").bind(std::string(200'000, '[') + std::string(200'000, ']')).run();
    int seen = 0;
    run.for_each([&](const CatalogRun::Labeled& labeled) { seen += to_json(labeled.record).dump().size() < 1000; });
    EXPECT_EQ(seen, 1);
    // What the stranger's own SQLite would have let it do:
    sqlite3* other = nullptr;
    ASSERT_EQ(sqlite3_open((folder_ / "shapes.db").c_str(), &other), SQLITE_OK);
    EXPECT_EQ(sqlite3_exec(other, "CREATE TRIGGER t AFTER UPDATE ON shapes BEGIN DELETE FROM labels; END", nullptr,
                           nullptr, nullptr),
              SQLITE_OK);
    sqlite3_close(other);
    put({shape_at("/a.off")});
    EXPECT_EQ(catalog_.count("(SELECT count(*) FROM labels) = 1"), 1);
}

TEST(OutputName, NothingLeadsOutOfAFolder) {
    for (const char* name : {"", "/", "..", ".", "a/..", "../a", "a//b", "/a", "a/", ".a", "a/.b", "a\\b", "a\nb",
                             "a\x7f", "a.ply/b", "a/b_labels.txt/c"})
        EXPECT_FALSE(is_output_name(name)) << name;
    EXPECT_FALSE(is_output_name(std::string("a\0b", 3)));
    EXPECT_FALSE(is_output_name(std::string(201, 'a')));
    for (const char* name : {"a", "a/b", "a..b", "a b/c.d", "a/b.ply", "\xc3\xa4"})
        EXPECT_TRUE(is_output_name(name)) << name;
}

TEST(OutputName, AnyPathBecomesOne) {
    EXPECT_EQ(output_name("shapes/Cup/21.off"), "shapes/Cup/21");
    EXPECT_EQ(output_name("../../etc/passwd"), "etc/passwd");
    EXPECT_EQ(output_name("/a//b/./c.obj"), "a/b/c");
    EXPECT_EQ(output_name(".hidden/x.ply"), "_hidden/x");
    EXPECT_EQ(output_name("a\\b\nc.off"), "a_b_c");
    EXPECT_EQ(output_name("a.ply/b_labels.txt/c.json/d.seg.off"), "a_ply/b_labels_txt/c_json/d.seg");
    EXPECT_EQ(output_name(""), "shape");
    EXPECT_EQ(output_name("..."), "shape");
    for (const std::string& odd : {std::string(300, 'x') + ".off", "a/" + std::string(400, '\xc3') + "/b.off",
                                   std::string("x/\0y.off", 8), std::string(2000, '/') + "a.off"})
        EXPECT_TRUE(is_output_name(output_name(odd))) << output_name(odd);
}

}  // namespace
}  // namespace exemplar
