#include "host/data/catalog/catalog.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sqlite3.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <set>
#include <thread>

#include "host/core/errors.h"
#include "host/data/catalog/catalog_run.h"
#include "host/data/catalog/shape_scan.h"
#include "tests/support/mesh_files.h"

namespace exemplar {
namespace {

namespace fs = std::filesystem;
using mesh_files::error_of;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

CatalogShape shape_at(const std::string& path, const std::string& hash = "0123") {
    CatalogShape shape;
    shape.path = path;
    shape.name = output_name(fs::path(path).relative_path());
    shape.bytes = 100;
    shape.modified = 7;
    shape.hash = hash;
    shape.vertices = 8;
    shape.faces = 12;
    shape.components = 1;
    return shape;
}

ShapeRecord record_for(const CatalogShape& shape, const CatalogRun& run, const std::string& error = {}) {
    ShapeRecord record;
    record.run = run.key();
    record.content = content_of(shape);
    record.worker = "somebody";
    record.error = error;
    record.model = "cup";
    record.confidence = 0.75;
    record.labels = {{{"label", "handle"}, {"area_share", 0.25}}};
    record.seconds = {{"read", 0.5}, {"cut", 0.25}};
    record.finished = 1e9;
    return record;
}

class CatalogTest : public testing::Test {
  protected:
    std::vector<CatalogShape> all() {
        std::vector<CatalogShape> shapes;
        catalog_.for_each([&](const CatalogShape& shape) { shapes.push_back(shape); });
        return shapes;
    }
    std::vector<std::string> names() {
        std::vector<std::string> names;
        for (const CatalogShape& shape : all()) names.push_back(shape.name);
        return names;
    }
    void put(const std::vector<CatalogShape>& shapes) { catalog_.put(shapes); }
    TemporaryFolder folder_;
    Catalog catalog_{folder_ / "shapes.db", Database::Open::create};
};

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

class CatalogRunTest : public CatalogTest {
  protected:
    CatalogRunTest() { put({shape_at("/a.off"), shape_at("/b.off"), shape_at("/c.off"), shape_at("/d.off")}); }
    static std::vector<std::int64_t> ids(const std::vector<CatalogShape>& shapes) {
        std::vector<std::int64_t> ids;
        ids.reserve(shapes.size());
        for (const CatalogShape& shape : shapes) ids.push_back(shape.id);
        return ids;
    }
    CatalogRun run_{catalog_, "key", folder_.path(), "a model"};
};

TEST_F(CatalogRunTest, ShapesAreClaimedOnce) {
    EXPECT_THAT(ids(run_.claim("first", 2, 0)), ElementsAre(1, 2));
    EXPECT_THAT(ids(run_.claim("second", 5, 0)), ElementsAre(3, 4));
    EXPECT_THAT(ids(run_.claim("third", 5, 0)), ElementsAre());
    run_.release("first");
    EXPECT_THAT(ids(run_.claim("third", 5, 1)), ElementsAre(2));
    EXPECT_THAT(ids(run_.claim("third", 5, 0)), ElementsAre(1));
    EXPECT_THAT(run_.workers(), testing::UnorderedElementsAre("second", "third"));
    EXPECT_EQ(run_.counts().claimed, 4);
}

TEST_F(CatalogRunTest, WhatIsFinishedStaysSoUntilItsContentChanges) {
    const std::vector<CatalogShape> shapes = run_.claim("me", 4, 0);
    EXPECT_TRUE(run_.finish(1, record_for(shapes[0], run_)));
    EXPECT_FALSE(run_.finish(1, record_for(shapes[0], run_, "late")));  // once
    EXPECT_TRUE(run_.finish(2, record_for(shapes[1], run_, "no good")));
    ShapeRecord unknown = record_for(shapes[2], run_, "of no category");
    unknown.category = k_unknown_category;
    EXPECT_TRUE(run_.finish(3, unknown));
    run_.release("me");
    const CatalogRun::Counts counts = run_.counts();
    EXPECT_EQ(counts.done, 1);
    EXPECT_EQ(counts.failed, 1);
    EXPECT_EQ(counts.unknown, 1);
    EXPECT_EQ(counts.open, 1);
    EXPECT_THAT(ids(run_.claim("me", 4, 0)), ElementsAre(4));
    run_.release("me");
    put({shape_at("/a.off", "changed")});
    EXPECT_THAT(ids(run_.claim("me", 4, 0)), ElementsAre(1, 4));
    run_.release("me");
    CatalogShape b = shape_at("/b.off");
    b.category = "cup";  // labels depend on it
    put({b});
    run_.reopen(3);
    EXPECT_THAT(ids(run_.claim("me", 4, 0)), ElementsAre(1, 2, 3, 4));
}

TEST_F(CatalogRunTest, ARecordIsGivenBackAsItWas) {
    const std::vector<CatalogShape> shapes = run_.claim("me", 1, 0);
    const ShapeRecord record = record_for(shapes[0], run_);
    run_.finish(1, record);
    int seen = 0;
    run_.for_each([&](const CatalogRun::Labeled& labeled) {
        ++seen;
        EXPECT_EQ(labeled.state, "done");
        EXPECT_EQ(labeled.shape.id, 1);
        ShapeRecord back = labeled.record;
        back.run = record.run;
        EXPECT_EQ(to_json(back), to_json(record));
    });
    EXPECT_EQ(seen, 1);
}

TEST_F(CatalogRunTest, RunsOfOtherModelsOrFoldersAreTheirOwn) {
    run_.finish(1, record_for(run_.claim("me", 1, 0)[0], run_));
    CatalogRun other(catalog_, "other key", folder_.path(), "");
    CatalogRun elsewhere(catalog_, "key", folder_ / "elsewhere", "");
    EXPECT_EQ(other.counts().open, 4);
    EXPECT_EQ(elsewhere.counts().open, 4);
    EXPECT_EQ(CatalogRun(catalog_, "key", folder_.path(), "").counts().done, 1);
    EXPECT_EQ(CatalogRun(catalog_, 1).key(), "key");
    EXPECT_THAT(error_of<DataError>([&] { CatalogRun(catalog_, 17); }), HasSubstr("no run 17"));
    EXPECT_EQ(runs_of(catalog_).size(), 3u);
}

TEST_F(CatalogRunTest, RecordsInTheFolderAreMergedOnce) {
    const auto write = [&](const CatalogShape& shape, const ShapeRecord& record) {
        mesh_files::write_bytes(run_.record_path(shape), to_json(record).dump());
    };
    const std::vector<CatalogShape> shapes = all();
    write(shapes[0], record_for(shapes[0], run_));
    ShapeRecord of_other_run = record_for(shapes[1], run_);
    of_other_run.run = "other";
    write(shapes[1], of_other_run);
    write(shapes[2], record_for(shape_at("/c.off", "other content"), run_));
    mesh_files::write_bytes(run_.record_path(shapes[3]), "{\"run\": 3");
    std::size_t looked = 0;
    EXPECT_EQ(run_.merge_records([&](std::size_t n) { looked = n; }), 1u);
    EXPECT_EQ(looked, 4u);
    EXPECT_EQ(run_.merge_records([](std::size_t) {}), 0u);
    EXPECT_EQ(run_.counts().done, 1);
}

TEST_F(CatalogRunTest, TheRecordOfAFileThatHasChangedMeanwhileCounts) {
    const fs::path file = folder_ / "changing.off";
    mesh_files::write_bytes(file, "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
    CatalogShape now = describe_shape(file, std::size_t{1} << 30);
    now.name = "changing";
    CatalogShape before = now;
    before.hash = "of another content";
    before.faces = 99;
    put({before});
    ShapeRecord record = record_for(now, run_);
    record.finished = 1;  // in 1970, before there was such a file
    mesh_files::write_bytes(run_.record_path(now), to_json(record).dump());
    EXPECT_EQ(run_.merge_records([](std::size_t) {}), 0u);
    EXPECT_EQ(catalog_.find(file)->hash, before.hash) << "it was looked at";
    record.finished = seconds_since_1970() + 1;
    mesh_files::write_bytes(run_.record_path(now), to_json(record).dump());
    EXPECT_EQ(run_.merge_records([](std::size_t) {}), 1u);
    EXPECT_EQ(catalog_.find(file)->hash, now.hash);
    EXPECT_EQ(catalog_.find(file)->faces, 1);
    EXPECT_EQ(run_.counts().done, 1);
}

TEST_F(CatalogRunTest, ACategoryOfAnotherEncodingIsFoundAgain) {
    CatalogShape shape = shape_at("/latin.off");
    shape.category = "caf\xe9";
    put({shape});
    mesh_files::write_bytes(run_.record_path(shape), to_json(record_for(shape, run_)).dump());
    ASSERT_TRUE(run_.record_of(shape).has_value());
    EXPECT_EQ(run_.merge_records([](std::size_t) {}), 1u);
    EXPECT_EQ(run_.merge_records([](std::size_t) {}), 0u);
}

TEST_F(CatalogRunTest, ShapesWithoutNumbersEndNoLoop) {
    const TemporaryFolder folder;
    const fs::path path = folder / "made_up.db";
    Catalog(path, Database::Open::create).put(std::vector{shape_at("/a.off")});
    {
        Database database(path, Database::Open::existing);
        database.execute(
            "CREATE TABLE other AS SELECT * FROM shapes; DROP TABLE shapes; UPDATE other SET id = 'x'; ALTER TABLE "
            "other "
            "RENAME TO shapes");
    }
    Catalog catalog(path, Database::Open::existing);
    CatalogRun run(catalog, "key", folder.path(), "");
    EXPECT_THAT(error_of<DataError>([&] { run.claim("me", 4, 0); }), HasSubstr("is damaged"));
    EXPECT_THAT(error_of<DataError>([&] { run.merge_records([](std::size_t) {}); }), HasSubstr("is damaged"));
}

TEST_F(CatalogRunTest, ANameThatLeadsOutOfTheFolderIsRefused) {
    CatalogShape shape = all().front();
    shape.name = "../../etc/passwd";
    EXPECT_THAT(error_of<DataError>([&] { run_.record_path(shape); }), HasSubstr("leads out"));
}

TEST_F(CatalogRunTest, ProgramsAtOnceShareTheWork) {
    std::vector<CatalogShape> more;
    more.reserve(200);
    for (int i = 0; i < 200; ++i) more.push_back(shape_at("/more/" + std::to_string(i) + ".off"));
    put(more);
    std::vector<std::vector<std::int64_t>> taken(4);
    {
        std::vector<std::jthread> threads;
        threads.reserve(4);
        for (int t = 0; t < 4; ++t)
            threads.emplace_back([&, t] {
                Catalog mine(folder_ / "shapes.db", Database::Open::existing);
                CatalogRun run(mine, "key", folder_.path(), "");
                const std::string worker = "worker" + std::to_string(t);
                for (;;) {
                    const std::vector<CatalogShape> shapes = run.claim(worker, 3, 0);
                    if (shapes.empty()) break;
                    for (const CatalogShape& shape : shapes) {
                        run.finish(shape.id, record_for(shape, run));
                        taken[t].push_back(shape.id);
                    }
                }
            });
    }
    std::multiset<std::int64_t> all_taken;
    for (const auto& some : taken) all_taken.insert(some.begin(), some.end());
    EXPECT_EQ(all_taken.size(), 204u);
    EXPECT_EQ(std::set<std::int64_t>(all_taken.begin(), all_taken.end()).size(), 204u);
    EXPECT_EQ(run_.counts().done, 204);
}

}  // namespace
}  // namespace exemplar
