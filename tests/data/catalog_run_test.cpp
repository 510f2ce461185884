#include "host/data/catalog/catalog_run.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>
#include <thread>

#include "host/core/errors.h"
#include "host/data/catalog/shape_scan.h"
#include "tests/data/catalog_fixture.h"

namespace exemplar {
namespace {

namespace fs = std::filesystem;
using mesh_files::error_of;
using testing::ElementsAre;
using testing::HasSubstr;

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
