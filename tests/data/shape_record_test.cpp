#include "host/data/catalog/shape_record.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <string>
#include <thread>
#include <vector>

#include "host/core/errors.h"
#include "host/core/files.h"
#include "tests/support/mesh_files.h"
#include "tests/support/temporary_folder.h"

namespace exemplar {
namespace {

namespace fs = std::filesystem;
using mesh_files::error_of;
using testing::HasSubstr;

TEST(ShapeRecord, ReadsBackWhatWasWritten) {
    const TemporaryFolder folder;
    ShapeRecord record;
    record.run = "r";
    record.content = "c";
    record.error = "e";
    record.seconds = {{"read", 1.5}};
    mesh_files::write_bytes(folder / "a.json", to_json(record).dump());
    const auto back = read_record(folder / "a.json");
    ASSERT_TRUE(back);
    EXPECT_EQ(to_json(*back), to_json(record));
    EXPECT_EQ(back->seconds_all(), 1.5);
    EXPECT_FALSE(read_record(folder / "b.json"));
    EXPECT_FALSE(read_record(folder.path()));
    for (const char* key : {"run", "labels", "seconds", "finished"}) {
        nlohmann::json broken = to_json(record);
        broken[key] = {{"x", "y"}};
        mesh_files::write_bytes(folder / "b.json", broken.dump());
        EXPECT_FALSE(read_record(folder / "b.json")) << key;
    }
}

TEST(ShapeRecord, DeepNestingIsLeftOut) {
    const TemporaryFolder folder;
    nlohmann::json json = to_json(ShapeRecord());
    json["labels"] = {{{"label", "body"}}, "PLACE"};
    std::string text = json.dump();
    constexpr std::size_t k_depth = 1'000'000;
    text.replace(text.find("\"PLACE\""), 7, std::string(k_depth, '[') + std::string(k_depth, ']'));
    mesh_files::write_bytes(folder / "a.json", text);
    const auto record = read_record(folder / "a.json");
    ASSERT_TRUE(record);
    EXPECT_EQ(record->labels[0]["label"], "body");
    EXPECT_LT(to_json(*record).dump().size(), 1000U);
}

TEST(ShapeRecord, OneOfSeveralCommits) {
    const TemporaryFolder folder;
    std::atomic<int> succeeded{0};
    std::string winner;
    {
        std::vector<std::jthread> threads;
        threads.reserve(8);
        for (int t = 0; t < 8; ++t)
            threads.emplace_back([&, t] {
                const fs::path mine = folder / ("mine" + std::to_string(t));
                mesh_files::write_bytes(mine, std::to_string(t));
                if (commit_file(mine, folder / "target")) {
                    ++succeeded;
                    winner = std::to_string(t);
                }
                EXPECT_FALSE(fs::exists(mine));
            });
    }
    EXPECT_EQ(succeeded, 1);
    EXPECT_EQ(read_file(folder / "target"), winner);
    EXPECT_THAT(error_of<DataError>([&] { commit_file(folder / "nothing", folder / "there"); }), HasSubstr("there"));
}

}  // namespace
}  // namespace exemplar
