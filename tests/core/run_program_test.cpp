#include "host/core/run_program.h"

#include <gtest/gtest.h>

#include <new>

#include "host/core/errors.h"

namespace exemplar {
namespace {

template <typename Thrown>
int fails(int /*argc*/, char** /*argv*/) {
    throw Thrown("what is wrong");
}

struct Ended {
    int code;
    std::string errors;
    bool operator==(const Ended&) const = default;
};

Ended end_of(int (*run)(int, char**)) {
    ::testing::internal::CaptureStderr();
    const int code = run_program(run, 0, nullptr);
    return {code, ::testing::internal::GetCapturedStderr()};
}

TEST(RunProgram, GivesTheExitCodeOfWhatItRuns) {
    EXPECT_EQ(end_of([](int, char**) { return 0; }), (Ended{0, ""}));
    EXPECT_EQ(end_of([](int, char**) { return 7; }), (Ended{7, ""}));
}

TEST(RunProgram, TellsErrorsFromWrongUsage) {
    EXPECT_EQ(end_of(fails<MeshError>), (Ended{1, "error: what is wrong\n"}));
    EXPECT_EQ(end_of(fails<std::runtime_error>), (Ended{1, "error: what is wrong\n"}));
    EXPECT_EQ(end_of(fails<UsageError>), (Ended{2, "error: what is wrong\n"}));
}

TEST(RunProgram, SaysWhatToDoWithoutMemory) {
    const Ended ended = end_of([](int, char**) -> int { throw std::bad_alloc(); });
    EXPECT_EQ(ended.code, 1);
    EXPECT_EQ(ended.errors, "error: out of memory; use fewer or smaller meshes\n");
}

TEST(RunProgram, AnInterruptionIsNoError) {
    EXPECT_EQ(end_of([](int, char**) -> int { throw Interrupted(); }), (Ended{130, "interrupted\n"}));
}

}  // namespace
}  // namespace exemplar
