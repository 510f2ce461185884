#include <gtest/gtest.h>

#include <bit>
#include <cstring>
#include <ostream>
#include <span>
#include <string>

#include "apps/bench/spirv/comparison.h"
#include "apps/bench/spirv/inputs.h"
#include "apps/bench/spirv/module_check.h"
#include "embedded/learn_stumps_comp.h"
#include "embedded/runtime_copy_comp.h"
#include "embedded/runtime_multiply_add_comp.h"
#include "gpu/runtime/kernels/scalars.h"
#include "host/core/errors.h"
#include "host/core/files.h"
#include "tests/support/temporary_folder.h"

namespace exemplar {
namespace {

template <typename T>
Bytes bytes_of_list(std::initializer_list<T> values) {
    Bytes bytes(values.size() * sizeof(T));
    std::memcpy(bytes.data(), std::data(values), bytes.size());
    return bytes;
}

std::string file_of(const Shader& shader) {
    return {reinterpret_cast<const char*>(shader.words.data()), shader.words.size_bytes()};
}

template <typename Failure, typename Call>
std::string message_of(Call&& call) {
    try {
        call();
    } catch (const Failure& error) {
        return error.what();
    }
    return "nothing was thrown";
}

TEST(SpirvInputs, CountsHaveSuffixes) {
    EXPECT_EQ(parse_count("--x", "4096"), 4096u);
    EXPECT_EQ(parse_count("--x", "4M"), std::uint64_t{4} << 20);
    EXPECT_EQ(parse_count("--x", "2G"), std::uint64_t{2} << 30);
    for (const char* text : {"", "M", "-1", "1.5", "4m", "0x4", "99999999999999999999", "99999999999G"})
        EXPECT_THROW(parse_count("--x", text), UsageError) << text;
    EXPECT_EQ(parse_box("--x", "7,8"), (std::array<std::uint64_t, 3>{7, 8, 1}));
    for (const char* text : {"", "1,", "1,2,3,4", "0", "1,0,1", "5G"})
        EXPECT_THROW(parse_box("--x", text), UsageError) << text;
}

TEST(SpirvInputs, Bindings) {
    const BindingSource file = parse_binding("--bind", "12=a=b.bin");
    EXPECT_EQ(file.binding, 12u);
    EXPECT_EQ(file.kind, BindingSource::Kind::file);
    EXPECT_EQ(file.path, "a=b.bin");
    EXPECT_EQ(contents_of(parse_binding("--bind", "0=:8")), Bytes(8));
    EXPECT_EQ(contents_of(parse_binding("--bind", "0=count:3")), bytes_of_list<std::uint32_t>({0, 1, 2}));
    const Bytes random = contents_of(parse_binding("--bind", "0=random:100"));
    EXPECT_EQ(random, contents_of(parse_binding("--bind", "0=random:100")));
    EXPECT_NE(random, contents_of(parse_binding("--bind", "1=random:100")));
    for (std::size_t i = 0; i < 100; ++i) {
        float value = 0;
        std::memcpy(&value, random.data() + 4 * i, sizeof value);
        EXPECT_GE(value, 0.0f);
        EXPECT_LT(value, 1.0f);
    }
    for (const char* text :
         {"", "=", "1", "1=", "x=file", "-1=file", "1=:", "1=random:", "1=count:x", "5000000000=file"})
        EXPECT_THROW(parse_binding("--bind", text), UsageError) << text;
}

TEST(SpirvInputs, PushConstantsHaveTheTypesOfTheirMembers) {
    const ShaderScalars scalars = reflect_scalars(shaders::runtime_multiply_add_comp);
    ASSERT_EQ(scalars.push.size(), 3u);
    EXPECT_EQ(scalars.push[0].name, "parameters.rounds");
    EXPECT_EQ(scalars.push[1].type, ScalarType::float32);
    const Bytes bytes = push_bytes("64,0.5,-1e-3", scalars.push, 12);
    Bytes expected =
        bytes_of_list<std::uint32_t>({64, std::bit_cast<std::uint32_t>(0.5f), std::bit_cast<std::uint32_t>(-1e-3f)});
    EXPECT_EQ(bytes, expected);
    for (const char* text : {"", "64", "64,1", "64,1,1,1", "1.5,1,1", "-1,1,1", "64,x,1", "64,,1", "64, 1,1"})
        EXPECT_NE(message_of<UsageError>([&] { push_bytes(text, scalars.push, 12); }).find("parameters."),
                  std::string::npos)
            << text;
    EXPECT_THROW(push_bytes("1", {}, 0), UsageError);
    EXPECT_TRUE(push_bytes("", {}, 0).empty());
}

TEST(SpirvInputs, SpecializationConstants) {
    const ShaderScalars scalars = reflect_scalars(shaders::learn_stumps_comp);
    ASSERT_FALSE(scalars.constants.empty());
    EXPECT_EQ(scalars.constants[0].id, 0u);
    EXPECT_EQ(constant_bits("--spec", {0, "8"}, scalars.constants), (std::pair<std::uint32_t, std::uint32_t>{0, 8}));
    EXPECT_THROW(constant_bits("--spec", {0, "eight"}, scalars.constants), UsageError);
    const std::string unknown = message_of<UsageError>([&] { constant_bits("--spec", {77, "1"}, scalars.constants); });
    EXPECT_NE(unknown.find("77"), std::string::npos);
    EXPECT_NE(unknown.find(scalars.constants[0].name), std::string::npos) << unknown;
    EXPECT_EQ(scalar_bits("true", ScalarType::boolean), 1u);
    EXPECT_EQ(scalar_bits("-2", ScalarType::int32), 0xfffffffeu);
    EXPECT_EQ(scalar_bits("0xff", ScalarType::uint32), 255u);
    EXPECT_FALSE(scalar_bits("1", ScalarType::float64));
}

TEST(SpirvInputs, ArraysOfNumpy) {
    const TemporaryFolder folder;
    const auto written = [&](const std::string& content) {
        std::filesystem::path path = folder.path() / "a.npy";
        write_file_atomically(path, [&](std::ostream& out) { out << content; });
        return path;
    };
    const std::string header = "{'descr': '<f4', 'fortran_order': False, 'shape': (1,), }\n";
    const std::string start = std::string("\x93NUMPY\x01\x00", 8) + static_cast<char>(header.size()) + '\0' + header;
    EXPECT_EQ(read_values(written(start + std::string(4, '\1'))).size(), 4u);
    EXPECT_THROW(read_values(written("")), DataError);
    EXPECT_THROW(read_values(written(start.substr(0, 30))), DataError);
    EXPECT_THROW(read_values(written(std::string("\x93NUMPY\x02\x00\xff\xff\xff\xff", 12))), DataError);
    std::string swapped = start;
    swapped[swapped.find('<')] = '>';
    EXPECT_THROW(read_values(written(swapped)), DataError);
}

TEST(SpirvModule, SoundModulesPass) {
    for (const Shader* shader : {&shaders::runtime_copy_comp, &shaders::learn_stumps_comp})
        EXPECT_TRUE(std::ranges::equal(checked_words("a.spv", file_of(*shader)), shader->words));
}

TEST(SpirvModule, EveryTruncationIsFoundOrHasItsInstructionsWhole) {
    const std::string file = file_of(shaders::runtime_copy_comp);
    std::size_t refused = 0;
    for (std::size_t bytes = 0; bytes < file.size(); ++bytes) {
        const std::string message =
            message_of<ShaderError>([&] { checked_words("a.spv", std::string_view(file).substr(0, bytes)); });
        refused += message.starts_with("a.spv: ");
        EXPECT_TRUE(bytes % 4 == 0 || message.starts_with("a.spv: ")) << bytes;
    }
    EXPECT_GT(refused, file.size() * 3 / 4);
}

TEST(SpirvModule, NoDamageOfAWordHarmsTheCheck) {
    const std::string file = file_of(shaders::runtime_copy_comp);
    for (std::size_t at = 0; at + 4 <= file.size(); at += 4)
        for (const std::uint32_t word : {0u, 1u, 0xffffffffu, 0x00010000u, 0x7fff000fu}) {
            std::string damaged = file;
            std::memcpy(damaged.data() + at, &word, sizeof word);
            try {
                checked_words("a.spv", damaged);
            } catch (const ShaderError&) {
            }
        }
}

BlockScalars floats_block() {
    BlockScalars block;
    block.stride = 4;
    block.element = {{"", 0, ScalarType::float32}};
    return block;
}

TEST(SpirvComparison, FloatsOverOneAreComparedRelatively) {
    const Bytes actual = bytes_of_list({1000.0f, 0.5f, 2.0f}), expected = bytes_of_list({1001.0f, 0.5f, 2.0f});
    const BufferComparison close = compare_buffers(actual, expected, floats_block(), 1e-2);
    EXPECT_TRUE(close.fits());
    EXPECT_NEAR(close.largest, 1.0 / 1001, 1e-9);
    EXPECT_EQ(close.place, "element 0");
    EXPECT_EQ(close.actual, "1000");
    EXPECT_EQ(close.expected, "1001");
    EXPECT_EQ(compare_buffers(actual, expected, floats_block(), 1e-4).differing, 1u);
}

TEST(SpirvComparison, NoNumberIsCloseToNan) {
    const float nan = std::numeric_limits<float>::quiet_NaN(), infinity = std::numeric_limits<float>::infinity();
    EXPECT_FALSE(compare_buffers(bytes_of_list({nan}), bytes_of_list({1.0f}), floats_block(), 1e30).fits());
    EXPECT_FALSE(compare_buffers(bytes_of_list({1.0f}), bytes_of_list({nan}), floats_block(), 1e30).fits());
    EXPECT_TRUE(compare_buffers(bytes_of_list({nan}), bytes_of_list({nan}), floats_block(), 0).fits());
    EXPECT_FALSE(compare_buffers(bytes_of_list({infinity}), bytes_of_list({-infinity}), floats_block(), 1e30).fits());
    EXPECT_TRUE(compare_buffers(bytes_of_list({infinity}), bytes_of_list({infinity}), floats_block(), 0).fits());
}

TEST(SpirvComparison, IntegersAreComparedAbsolutely) {
    BlockScalars block = floats_block();
    block.head_bytes = 4;
    block.head = {{"count", 0, ScalarType::uint32}};
    block.element = {{"index", 0, ScalarType::int32}};
    const Bytes expected = bytes_of_list<std::int32_t>({1, -5, 1'000'000}),
                actual = bytes_of_list<std::int32_t>({1, -5, 1'000'001});
    const BufferComparison comparison = compare_buffers(actual, expected, block, 0.5);
    EXPECT_EQ(comparison.largest, 1);
    EXPECT_EQ(comparison.numbers, 3u);
    EXPECT_EQ(comparison.place, "element 1.index");
    EXPECT_FALSE(comparison.fits());
}

TEST(SpirvComparison, BytesBetweenNumbersAreNotCompared) {
    BlockScalars block = floats_block();
    block.stride = 8;
    const Bytes expected = bytes_of_list({1.0f, 2.0f, 3.0f, 4.0f}), actual = bytes_of_list({1.0f, 7.0f, 3.0f, 8.0f});
    EXPECT_TRUE(compare_buffers(actual, expected, block, 0).fits());
    block.complete = false;
    EXPECT_EQ(compare_buffers(actual, expected, block, 0).differing, 2u);
}

TEST(SpirvComparison, HalvesAndDoubles) {
    BlockScalars block;
    block.stride = 2;
    block.element = {{"", 0, ScalarType::float16}};
    const Bytes one = bytes_of_list<std::uint16_t>({0x3c00}), two = bytes_of_list<std::uint16_t>({0x4000});
    EXPECT_DOUBLE_EQ(compare_buffers(one, two, block, 0).largest, 0.5);
    block.stride = 8;
    block.element = {{"", 0, ScalarType::float64}};
    EXPECT_DOUBLE_EQ(compare_buffers(bytes_of_list({4.0}), bytes_of_list({2.0}), block, 0).largest, 1);
}

}  // namespace
}  // namespace exemplar
