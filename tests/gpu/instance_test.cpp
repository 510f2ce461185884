#include "gpu/runtime/device/instance.h"

#include <gtest/gtest.h>

namespace exemplar {
namespace {

// The instance of a window has extensions, that of work in the background has none; both live at once. ctest runs each
// test by itself, so that it is these instances that load functions.
TEST(Instance, OneWithoutExtensionsLeavesTheFunctionsOfAnother) {
    const Instance extended(Validation::none, {VK_EXT_DEBUG_UTILS_EXTENSION_NAME});
    ASSERT_NE(vkCreateDebugUtilsMessengerEXT, nullptr);
    const Instance plain(Validation::none, {});
    EXPECT_NE(vkCreateDebugUtilsMessengerEXT, nullptr);
    EXPECT_FALSE(extended.physical_devices().empty());
    EXPECT_FALSE(plain.physical_devices().empty());
}

TEST(Instance, OneWithExtensionsLoadsTheirFunctionsAfterAnotherWithout) {
    const Instance plain(Validation::none, {});
    const Instance extended(Validation::none, {VK_EXT_DEBUG_UTILS_EXTENSION_NAME});
    EXPECT_NE(vkCreateDebugUtilsMessengerEXT, nullptr);
}

}  // namespace
}  // namespace exemplar
