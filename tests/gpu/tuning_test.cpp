#include "gpu/runtime/device/tuning.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <ostream>

#include "host/core/errors.h"
#include "host/core/files.h"
#include "tests/support/temporary_folder.h"

namespace exemplar {
namespace {

constexpr std::array<std::uint32_t, 3> k_values{1, 2, 4};
constexpr TunableParameter k_parameter{"some/kernel.comp", "quads", k_values};

TEST(TuningTest, ChoosesWhatIsKeptIfItIsPossible) {
    Tuning tuning;
    EXPECT_TRUE(tuning.empty());
    EXPECT_EQ(tuning.choose(k_parameter, 2), 2u);
    tuning.set("some/kernel.comp", "quads", 4);
    EXPECT_EQ(tuning.choose(k_parameter, 2), 4u);
    tuning.set("some/kernel.comp", "quads", 3);
    EXPECT_EQ(tuning.choose(k_parameter, 2), 2u);
    EXPECT_EQ(tuning.find("some/kernel.comp", "quads"), 3u);
    tuning.forget("some/kernel.comp", "quads");
    EXPECT_TRUE(tuning.empty());
}

TEST(TuningTest, IsKeptInAFile) {
    const TemporaryFolder folder;
    const std::filesystem::path path = folder.path() / "below" / "tuning.json";
    EXPECT_TRUE(Tuning::load(path).empty());
    Tuning tuning;
    tuning.set("a", "group", 128);
    tuning.set("a", "quads", 2);
    tuning.set("b", "group", 32);
    tuning.save(path);
    EXPECT_EQ(Tuning::load(path), tuning);
}

TEST(TuningTest, ForgetsWhatWasFoundForAnotherShader) {
    const TemporaryFolder folder;
    const std::filesystem::path path = folder.path() / "tuning.json";
    static constexpr std::array<std::uint32_t, 2> k_words{1, 2};
    note_shader("noted/kernel.comp", k_words, k_words);
    Tuning tuning;
    tuning.set("noted/kernel.comp", "group", 128);
    tuning.set("other/kernel.comp", "group", 64);
    tuning.save(path);
    EXPECT_EQ(Tuning::load(path), tuning);

    std::string text = read_file(path);
    const std::size_t hash = text.find("noted/kernel.comp\": \"") + 21;
    text[hash] = text[hash] == '0' ? '1' : '0';
    write_file_atomically(path, [&](std::ostream& out) { out << text; });
    EXPECT_FALSE(Tuning::load(path).find("noted/kernel.comp", "group"));
    EXPECT_EQ(Tuning::load(path).find("other/kernel.comp", "group"), 64u);

    write_file_atomically(path,
                          [](std::ostream& out) { out << R"({"kernels": {"noted/kernel.comp": {"group": 32}}})"; });
    EXPECT_TRUE(Tuning::load(path).empty()) << "a file without hashes";
}

TEST(TuningTest, DamagedFilesAreRefusedByName) {
    const TemporaryFolder folder;
    const std::filesystem::path path = folder.path() / "tuning.json";
    for (const char* text : {"", "{", "[]", "{\"kernels\": 3}", "{\"kernels\": {\"a\": {\"group\": \"x\"}}}",
                             "{\"kernels\": {\"a\": 5}}"}) {
        write_file_atomically(path, [&](std::ostream& out) { out << text; });
        try {
            Tuning::load(path);
            FAIL() << text;
        } catch (const DataError& error) {
            EXPECT_NE(std::string(error.what()).find(path.string()), std::string::npos);
        }
    }
}

}  // namespace
}  // namespace exemplar
