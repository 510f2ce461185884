#include "gpu/runtime/vulkan/errors.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace exemplar {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

TEST(Errors, SuccessIsNone) {
    EXPECT_NO_THROW(check(VK_SUCCESS, "do nothing"));
}

TEST(Errors, ALostDeviceHasItsOwnType) {
    try {
        check(VK_ERROR_DEVICE_LOST, "finish the work on device 'H200'");
        FAIL() << "no error";
    } catch (const DeviceLostError& error) {
        EXPECT_THAT(error.what(), AllOf(HasSubstr("finish the work on device 'H200'"), HasSubstr("lost")));
    }
}

TEST(Errors, UsedUpMemoryIsSaidToBe) {
    for (const VkResult result : {VK_ERROR_OUT_OF_DEVICE_MEMORY, VK_ERROR_OUT_OF_HOST_MEMORY}) try {
            check(result, "allocate a buffer of 3 GiB on 'H200'");
            FAIL() << "no error";
        } catch (const DeviceMemoryError& error) {
            EXPECT_THAT(error.what(), AllOf(HasSubstr("3 GiB"), HasSubstr("H200"), HasSubstr("memory is used up")));
        }
}

TEST(Errors, OthersAreNamed) {
    try {
        check(VK_ERROR_FEATURE_NOT_PRESENT, "open device 'x'");
        FAIL() << "no error";
    } catch (const DeviceError& error) {
        EXPECT_STREQ(error.what(), "cannot open device 'x': VK_ERROR_FEATURE_NOT_PRESENT");
    }
    EXPECT_EQ(result_name(static_cast<VkResult>(-4711)), "VkResult -4711");
}

TEST(Errors, SizesAreReadable) {
    EXPECT_EQ(format_bytes(0), "0 bytes");
    EXPECT_EQ(format_bytes(1536), "1.5 KiB");
    EXPECT_EQ(format_bytes(std::uint64_t{128} << 20), "128 MiB");
}

}  // namespace
}  // namespace exemplar
