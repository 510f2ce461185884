#include "host/core/pipeline.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <stdexcept>
#include <thread>

#include "host/core/memory_budget.h"

namespace exemplar {
namespace {

using namespace std::chrono_literals;
using testing::Each;
using testing::ElementsAre;
using testing::Le;

/// Gives 0, 1, ..., count - 1.
std::function<std::optional<int>()> counting_to(int count) {
    return [next = 0, count]() mutable { return next < count ? std::optional(next++) : std::nullopt; };
}

TEST(Pipeline, EveryItemGoesThroughEveryStageOnce) {
    std::vector<int> arrived;
    std::atomic<int> first{0};
    Pipeline<int> pipeline(counting_to(1000),
                           {{"a", 3, 1, 2, [&](std::span<int> items) { first += static_cast<int>(items.size()); }},
                            {"b", 2, 5, 4,
                             [](std::span<int> items) {
                                 for (int& item : items) item *= 2;
                             }},
                            {"c", 1, 1, 1, [&](std::span<int> items) { arrived.push_back(items.front()); }}});
    pipeline.run();
    EXPECT_EQ(first, 1000);
    ASSERT_EQ(arrived.size(), 1000u);
    std::ranges::sort(arrived);
    for (int i = 0; i < 1000; ++i) ASSERT_EQ(arrived[i], 2 * i);
    std::vector<std::size_t> counts;
    for (const StageStatistics& report : pipeline.reports()) counts.push_back(report.items);
    EXPECT_THAT(counts, ElementsAre(1000u, 1000u, 1000u));
}

TEST(Pipeline, KeepsTheOrderOfSingleWorkers) {
    std::vector<int> arrived;
    Pipeline<int> pipeline(counting_to(100),
                           {{"a", 1, 3, 3, [](std::span<int>) {}},
                            {"b", 1, 1, 1, [&](std::span<int> items) { arrived.push_back(items.front()); }}});
    pipeline.run();
    EXPECT_TRUE(std::ranges::is_sorted(arrived));
    EXPECT_EQ(arrived.size(), 100u);
}

TEST(Pipeline, WithoutItemsItEnds) {
    Pipeline<int> pipeline(counting_to(0), {{"a", 2, 1, 1, [](std::span<int>) { FAIL(); }}});
    pipeline.run();
}

TEST(Pipeline, NoMoreItemsAreOnTheirWayThanFit) {
    std::atomic<int> on_their_way{0}, most{0};
    int given = 0;
    const auto source = [&]() -> std::optional<int> {
        if (given == 200) return {};
        most = std::max(most.load(), ++on_their_way);
        return given++;
    };
    Pipeline<int> pipeline(source, {{"quick", 1, 1, 2, [](std::span<int>) {}}, {"slow", 1, 1, 3, [&](std::span<int>) {
                                                                                    std::this_thread::sleep_for(100us);
                                                                                    --on_their_way;
                                                                                }}});
    pipeline.run();
    // 2 wait for the first stage and 3 for the second; one is in each, and one in the hands of the source.
    EXPECT_LE(most, 2 + 3 + 2 + 1);
}

TEST(Pipeline, GroupsTakeWhatWaitsAndNoMoreThanAllowed) {
    std::vector<std::size_t> sizes;
    Pipeline<int> pipeline(counting_to(60), {{"a", 1, 4, 8, [&](std::span<int> items) {
                                                  sizes.push_back(items.size());
                                                  std::this_thread::sleep_for(1ms);
                                              }}});
    pipeline.run();
    EXPECT_THAT(sizes, Each(Le(4u)));
    EXPECT_EQ(*std::ranges::max_element(sizes), 4u);
    EXPECT_EQ(pipeline.reports().front().groups, sizes.size());
}

TEST(Pipeline, AnExceptionOfAnyStageEndsAll) {
    for (int failing = 0; failing < 3; ++failing) {
        std::atomic<bool> told{false};
        const auto stage = [failing](int number) {
            return [=](std::span<int> items) {
                if (number == failing && items.front() == 20) throw std::runtime_error("twenty");
            };
        };
        // It would never end by itself.
        Pipeline<int> pipeline([next = 0]() mutable { return std::optional(next++); },
                               {{"a", 2, 1, 1, stage(0)}, {"b", 1, 1, 2, stage(1)}, {"c", 3, 1, 1, stage(2)}});
        EXPECT_THROW(pipeline.run([&] { told = true; }), std::runtime_error);
        EXPECT_TRUE(told);
    }
}

TEST(Pipeline, AnExceptionOfTheSourceEndsAll) {
    Pipeline<int> pipeline([]() -> std::optional<int> { throw std::runtime_error("no"); },
                           {{"a", 2, 1, 1, [](std::span<int>) {}}});
    EXPECT_THROW(pipeline.run(), std::runtime_error);
}

TEST(Pipeline, TheSlowestStageIsTheBusiest) {
    const auto lasting = [](std::chrono::milliseconds time) {
        return [=](std::span<int>) { std::this_thread::sleep_for(time); };
    };
    Pipeline<int> pipeline(counting_to(30),
                           {{"a", 1, 1, 2, lasting(1ms)}, {"b", 1, 1, 2, lasting(8ms)}, {"c", 1, 1, 2, lasting(1ms)}});
    pipeline.run();
    const auto slowest = std::ranges::max_element(pipeline.reports(), {}, &StageStatistics::load);
    EXPECT_EQ(slowest->name, "b");
    EXPECT_GT(slowest->load, 0.5);
    EXPECT_LE(slowest->load, 1.0);
}

TEST(MemoryBudget, SharesNeverExceedIt) {
    MemoryBudget budget(100);
    std::atomic<int> taken{0}, most{0};
    std::vector<std::jthread> threads;
    threads.reserve(4);
    for (int t = 0; t < 4; ++t)
        threads.emplace_back([&, t] {
            for (int i = 0; i < 200; ++i) {
                const int bytes = 10 + (7 * i + 13 * t) % 50;
                const MemoryBudget::Share share = budget.take(static_cast<std::size_t>(bytes));
                const int now = taken += bytes;
                if (now > most) most = now;
                taken -= bytes;
            }
        });
    threads.clear();
    EXPECT_LE(most, 100);
    EXPECT_EQ(taken, 0);
}

TEST(MemoryBudget, WhatIsLargerThanItIsHadAlone) {
    MemoryBudget budget(100);
    { const MemoryBudget::Share large = budget.take(1000); }
    std::atomic<bool> got{false};
    MemoryBudget::Share small = budget.take(10);
    std::jthread waiting([&] {
        const MemoryBudget::Share large = budget.take(1000);
        got = true;
    });
    std::this_thread::sleep_for(20ms);
    EXPECT_FALSE(got);
    small = {};
    waiting.join();
    EXPECT_TRUE(got);
}

TEST(MemoryBudget, WhatShrinksLetsOthersBegin) {
    MemoryBudget budget(100);
    MemoryBudget::Share share = budget.take(90);
    share.resize(20);
    const MemoryBudget::Share second = budget.take(80);
    share.resize(500);  // never waits
}

TEST(MemoryBudget, AbandonedNobodyWaits) {
    MemoryBudget budget(100);
    const MemoryBudget::Share share = budget.take(90);
    std::jthread waiting([&] { const MemoryBudget::Share second = budget.take(90); });
    budget.abandon();
}

TEST(MemoryBudget, TheMachineHasSome) {
    EXPECT_GT(usable_memory(), std::size_t{64} << 20);
}

}  // namespace
}  // namespace exemplar
