# Everything that speaks Vulkan.
find_package(Vulkan REQUIRED)
