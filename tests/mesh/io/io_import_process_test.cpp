// A hostile file might take control of exemplar-import. These tests run shell scripts in its place, which do not end,
// write too much, or crash.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>

#include "host/core/errors.h"
#include "host/mesh/io/io_import.h"
#include "tests/support/mesh_files.h"

namespace exemplar {
namespace {

using mesh_io::ImportBounds;
using mesh_io::ImportContent;
using namespace std::chrono_literals;
using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

constexpr ImportBounds k_wide{60s, 1 << 20};
constexpr const char* k_sleep = "exec sleep 600";

class ImportProcess : public testing::Test {
  protected:
    /// Runs a shell script in place of exemplar-import and returns what run_import() does.
    std::string output_of(const std::string& script, const ImportBounds& bounds,
                          ImportContent wanted = ImportContent::still) const {
        const std::filesystem::path program = folder_ / "program";
        mesh_files::write_bytes(program, "#!/bin/sh\n" + script + "\n");
        std::filesystem::permissions(program, std::filesystem::perms::owner_all);
        return mesh_io::run_import(file_, wanted, program, bounds);
    }

    std::string error_of(const std::string& script, const ImportBounds& bounds) const {
        try {
            output_of(script, bounds);
        } catch (const MeshError& error) {
            return error.what();
        }
        return {};
    }

    mesh_files::TemporaryFolder folder_;
    std::filesystem::path file_ = folder_ / "a.fbx";
};

TEST_F(ImportProcess, OutputIsReturnedWhole) {
    EXPECT_EQ(output_of(R"(printf '%s,' "$@")", k_wide), file_.string() + ",");
    EXPECT_EQ(output_of(R"(printf '%s,' "$@")", k_wide, ImportContent::animation),
              "--animation," + file_.string() + ",");
    EXPECT_EQ(output_of("head -c 1000000 /dev/zero", k_wide), std::string(1000000, '\0'));
}

TEST_F(ImportProcess, IsEndedAtItsDeadline) {
    const auto begin = std::chrono::steady_clock::now();
    const auto is_late = AllOf(StartsWith(file_.string()), HasSubstr("took too long"));
    EXPECT_THAT(error_of(k_sleep, {100ms, 1 << 20}), is_late);
    EXPECT_THAT(error_of(std::string("exec >&-; ") + k_sleep, {100ms, 1 << 20}), is_late) << "with its output closed";
    EXPECT_THAT(error_of("while true; do echo x; done", {100ms, 1 << 30}), is_late) << "while it writes";
    EXPECT_THAT(error_of(std::string("trap '' TERM INT; ") + k_sleep, {100ms, 1 << 20}), is_late);
    EXPECT_LT(std::chrono::steady_clock::now() - begin, 300s) << "it is not waited for";
}

TEST_F(ImportProcess, IsEndedWhenItWritesTooMuch) {
    EXPECT_THAT(error_of("exec cat /dev/zero", k_wide),
                AllOf(StartsWith(file_.string()), HasSubstr("holds far more than a file of its size should")));
}

TEST_F(ImportProcess, CrashesAndErrorsAreToldInOneLine) {
    EXPECT_THAT(error_of("kill -SEGV $$", k_wide), HasSubstr("its reader crashed on this file"));
    EXPECT_THAT(error_of("printf 'no\\nscene\\t\\033[1m'; exit 1", k_wide),
                AllOf(StartsWith(file_.string()), HasSubstr("scene"), testing::Not(HasSubstr("\n")),
                      testing::Not(HasSubstr("\033"))));
    EXPECT_THAT(error_of("exit 1", k_wide), HasSubstr("cannot be read"));
}

TEST_F(ImportProcess, AMissingProgramIsTold) {
    EXPECT_THROW(mesh_io::run_import(file_, ImportContent::still, folder_ / "none", k_wide), MeshError);
}

}  // namespace
}  // namespace exemplar
