#include "host/core/cancel.h"

#include <gtest/gtest.h>

#include <thread>

#include "host/core/errors.h"
#include "host/core/interrupt.h"
#include "host/core/parallel.h"

namespace exemplar {
namespace {

constexpr std::size_t k_items = 100000;

void count_all(std::atomic<std::size_t>& count) {
    parallel_for(k_items, [&](std::size_t) { ++count; });
}

TEST(Cancel, WorkThatIsNotCanceledIsDone) {
    const std::atomic<bool> canceled = false;
    std::atomic<std::size_t> count = 0;
    run_cancelable(canceled, [&] { count_all(count); });
    EXPECT_EQ(count, k_items);
}

TEST(Cancel, LoopsEndOnAllThreads) {
    std::atomic<bool> canceled = false;
    std::atomic<std::size_t> count = 0;
    // Loops within a loop: the inner ones run on whichever threads there are.
    const auto work = [&] {
        parallel_for(64, [&](std::size_t) {
            if (count > 2 * k_items) canceled = true;
            count_all(count);
        });
    };
    EXPECT_THROW(run_cancelable(canceled, work), Interrupted);
    EXPECT_GT(count, 2 * k_items);
    EXPECT_LT(count, 64 * k_items);
}

TEST(Cancel, OtherWorkGoesOn) {
    std::atomic<bool> canceled = true;
    std::atomic<std::size_t> count = 0;
    EXPECT_THROW(run_cancelable(canceled, [] { check_interrupt(); }), Interrupted);
    EXPECT_NO_THROW(check_interrupt());
    EXPECT_NO_THROW(count_all(count));
    EXPECT_EQ(count, k_items);
    // Also while there is canceled work that does not end.
    run_cancelable(canceled, [&] { std::thread([&] { count_all(count); }).join(); });
    EXPECT_EQ(count, 2 * k_items);
}

TEST(Cancel, NextWorkIsNotCanceledByTheLast) {
    std::atomic<std::size_t> count = 0;
    for (std::size_t turn = 1; turn <= 20; ++turn) {
        std::atomic<bool> canceled = false;
        const auto cancel = [&] {
            canceled = true;
            count_all(count);
        };
        const std::size_t before = count;
        EXPECT_THROW(run_cancelable(canceled, cancel), Interrupted);
        const std::size_t after = count;
        EXPECT_LT(after, before + k_items);
        canceled = false;
        run_cancelable(canceled, [&] { count_all(count); });
        EXPECT_EQ(count, after + k_items);
    }
}

TEST(Cancel, WorkBesideIsNotCanceled) {
    std::atomic<bool> canceled = false, ended = false;
    std::thread beside([&] {
        const auto endless = [&] {
            for (std::atomic<std::size_t> unused = 0;;) count_all(unused);
        };
        EXPECT_THROW(run_cancelable(canceled, endless), Interrupted);
        ended = true;
    });
    const std::atomic<bool> never = false;
    std::atomic<std::size_t> count = 0;
    run_cancelable(never, [&] { count_all(count); });
    EXPECT_FALSE(ended);
    canceled = true;
    run_cancelable(never, [&] { count_all(count); });
    beside.join();
    EXPECT_EQ(count, 2 * k_items);
}

TEST(Cancel, ErrorsAreThrownOn) {
    const std::atomic<bool> canceled = false;
    EXPECT_THROW(run_cancelable(canceled, [] { throw MeshError("bad"); }), MeshError);
}

}  // namespace
}  // namespace exemplar
