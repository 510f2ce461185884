#include "gpu/hatching/buffer_cache.h"

#include <gtest/gtest.h>

#include <array>
#include <memory>
#include <span>

#include "tests/gpu/support/environment.h"

namespace exemplar {
namespace {

using test_support::shared_device;

std::shared_ptr<Buffer> keep(BufferCache& kept, std::uint64_t content, std::size_t bytes, int& made) {
    const std::array<std::uint64_t, 1> contents{content};
    return kept.get(content_key("test", {std::as_bytes(std::span(contents))}), [&] {
        ++made;
        return Buffer(shared_device(), bytes);
    });
}

TEST(BufferCache, MakeWhatIsNotThereAndGiveUpTheOldest) {
    BufferCache kept(1000);
    int made = 0;
    const auto first = keep(kept, 1, 400, made);
    keep(kept, 2, 400, made);
    EXPECT_EQ(keep(kept, 1, 400, made), first);
    EXPECT_EQ(made, 2);
    keep(kept, 3, 400, made);  // in place of 2
    EXPECT_EQ(kept.bytes(), 800U);
    EXPECT_EQ(keep(kept, 1, 400, made), first);
    EXPECT_EQ(made, 3);
    keep(kept, 2, 400, made);
    EXPECT_EQ(made, 4);
    // One that is larger than all stays as long as nothing else is asked for.
    keep(kept, 4, 5000, made);
    keep(kept, 4, 5000, made);
    EXPECT_EQ(made, 5);
    EXPECT_EQ(kept.bytes(), 5000U);
    EXPECT_EQ(first->bytes(), 400U);
}

TEST(BufferCache, KeysTellContentsUseAndParts) {
    const std::array<std::uint32_t, 4> values{1, 2, 3, 4};
    const std::span<const std::byte> bytes = std::as_bytes(std::span(values));
    const ContentKey key = content_key("a", {bytes});
    EXPECT_EQ(key, content_key("a", {bytes}));
    EXPECT_NE(key, content_key("b", {bytes}));
    EXPECT_NE(key, content_key("a", {bytes.first(8), bytes.last(8)}));
    EXPECT_NE(key, content_key("a", {bytes, {}}));
    EXPECT_NE(key, content_key("a", {bytes.first(15)}));
}

}  // namespace
}  // namespace exemplar
