#include "tests/gpu/support/environment.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <memory>
#include <string>

namespace exemplar::test_support {
namespace {

std::unique_ptr<Device> device;

// Drivers want a runtime folder, and tests must not touch the user's cache. All test programs of a user share one
// folder that stays: ctest runs each test by itself, and compiling its kernels again takes up to ten times as long as
// the rest.
void prepare_folders() {
    const std::filesystem::path folder =
        std::filesystem::temp_directory_path() / ("exemplar-tests-" + std::to_string(getuid()));
    std::filesystem::create_directories(folder);
    std::filesystem::permissions(folder, std::filesystem::perms::owner_all);
    setenv("XDG_CACHE_HOME", folder.c_str(), 1);
    setenv("XDG_RUNTIME_DIR", folder.c_str(), 0);
}

class GpuEnvironment : public ::testing::Environment {
  public:
    void SetUp() override { prepare_folders(); }
    void TearDown() override {
        if (!device) return;
        // The layer reports objects that were left over when the device ends.
        const std::shared_ptr<const ValidationLog> log = device->validation_log();
        device.reset();
        for (const std::string& message : log->messages()) ADD_FAILURE() << message;
    }
};

const ::testing::Environment* const k_registered = ::testing::AddGlobalTestEnvironment(new GpuEnvironment);

}  // namespace

Device& shared_device() {
    if (!device) device = std::make_unique<Device>();
    return *device;
}

}  // namespace exemplar::test_support
