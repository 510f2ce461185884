#include "gpu/runtime/measure/setup_check.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <ostream>
#include <string>

#include "host/core/files.h"
#include "tests/support/temporary_folder.h"

namespace exemplar {
namespace {

using Level = Finding::Level;

DeviceInfo device_info(std::size_t index, const std::string& name, DeviceType type) {
    DeviceInfo info;
    info.index = index;
    info.name = name;
    info.type = type;
    return info;
}

class SetupCheck : public ::testing::Test {
  protected:
    void write(const std::string& path, const std::string& text) {
        write_file_atomically(folder_.path() / path, [&](std::ostream& out) { out << text; });
    }
    void write_driver(const std::string& path, const std::string& library) {
        write(path, "{\"file_format_version\": \"1.0.0\", \"ICD\": {\"library_path\": \"" + library + "\"}}");
    }
    std::string root(const std::string& path) const { return (folder_.path() / path).string(); }
    MachineView machine() const {
        return {.root = folder_.path(), .environment = [this](const char* name) {
                    const auto found = variables_.find(name);
                    return found == variables_.end() ? std::string() : found->second;
                }};
    }
    std::map<std::string, std::string> variables_;

  private:
    TemporaryFolder folder_;
};

bool has(const std::vector<Finding>& findings, Level level, const std::string& part) {
    return std::ranges::any_of(findings, [&](const Finding& finding) {
        return finding.level == level && finding.what.find(part) != std::string::npos &&
               (level == Level::good || !finding.mend.empty());
    });
}

TEST_F(SetupCheck, WithoutDriversThereIsAFault) {
    EXPECT_TRUE(has(check_drivers(machine()), Level::fault, "no Vulkan driver"));
}

TEST_F(SetupCheck, DriversOfTheEnvironmentPrecedeThoseInstalled) {
    write_driver("usr/share/vulkan/icd.d/a.json", "libm.so.6");
    write_driver("etc/vulkan/icd.d/b.json", "libm.so.6");
    variables_["VK_DRIVER_FILES"] = "/one.json:/other.json";
    EXPECT_EQ(driver_files(machine()),
              (std::vector<std::filesystem::path>{"/one.json", "/other.json", root("etc/vulkan/icd.d/b.json"),
                                                  root("usr/share/vulkan/icd.d/a.json")}));
}

TEST_F(SetupCheck, DriversThatLoadAreGood) {
    write_driver("usr/share/vulkan/icd.d/some.x86_64.json", "libm.so.6");
    const auto findings = check_drivers(machine());
    ASSERT_EQ(findings.size(), 1u);
    EXPECT_TRUE(has(findings, Level::good, "some.x86_64"));
}

TEST_F(SetupCheck, DriversWithoutTheirLibraryAreNamed) {
    write_driver("etc/vulkan/icd.d/gone.json", "libgone_driver.so");
    write_driver("usr/share/vulkan/icd.d/relative.json", "./libgone_too.so");
    write("usr/share/vulkan/icd.d/odd.json", "not json");
    const auto findings = check_drivers(machine());
    EXPECT_TRUE(has(findings, Level::remark, "libgone_driver.so"));
    EXPECT_TRUE(has(findings, Level::remark, root("usr/share/vulkan/icd.d/./libgone_too.so")));
    EXPECT_TRUE(has(findings, Level::remark, root("usr/share/vulkan/icd.d/odd.json")));
}

TEST_F(SetupCheck, VariablesThatNameNoFileAreFaults) {
    write_driver("usr/share/vulkan/icd.d/some.json", "libm.so.6");
    variables_["VK_ICD_FILENAMES"] = "/no/such/driver.json:" + root("usr/share/vulkan/icd.d/some.json");
    const auto findings = check_drivers(machine());
    EXPECT_TRUE(has(findings, Level::fault, "/no/such/driver.json"));
    EXPECT_TRUE(has(findings, Level::good, "some"));
}

TEST_F(SetupCheck, HardwareWithoutADriverIsNamed) {
    write("sys/bus/pci/devices/0000:01:00.0/class", "0x030000\n");
    write("sys/bus/pci/devices/0000:01:00.0/vendor", "0x10de\n");
    write("sys/bus/pci/devices/0000:02:00.0/class", "0x020000\n");  // a network card
    write("sys/bus/pci/devices/0000:02:00.0/vendor", "0x8086\n");
    DeviceInfo device = device_info(0, "llvmpipe", DeviceType::cpu);
    auto findings = check_hardware(machine(), std::vector{device});
    ASSERT_EQ(findings.size(), 1u);
    EXPECT_TRUE(has(findings, Level::remark, "NVIDIA"));
    device = device_info(0, "NVIDIA H100", DeviceType::discrete);
    findings = check_hardware(machine(), std::vector{device});
    EXPECT_TRUE(has(findings, Level::good, "NVIDIA"));
    device.unusable = "Vulkan 1.1 is older than 1.3";
    EXPECT_TRUE(has(check_hardware(machine(), std::vector{device}), Level::remark, "NVIDIA"));
}

TEST_F(SetupCheck, DevicesThatCannotBeUsedSayWhy) {
    const DeviceInfo cpu = device_info(0, "llvmpipe", DeviceType::cpu);
    DeviceInfo old = device_info(1, "Old", DeviceType::discrete);
    old.unusable = "it lacks synchronization2";
    auto findings = check_devices(std::vector{cpu, old}, "");
    EXPECT_TRUE(has(findings, Level::good, "llvmpipe"));
    EXPECT_TRUE(has(findings, Level::remark, "synchronization2"));
    EXPECT_TRUE(has(findings, Level::remark, "is a CPU"));
    EXPECT_TRUE(has(check_devices(std::vector{cpu, old}, "Old"), Level::fault, "Old"));
    EXPECT_TRUE(has(check_devices(std::vector{cpu}, "nvidia"), Level::fault, "nvidia"));
    EXPECT_TRUE(has(check_devices(std::vector{old}, ""), Level::fault, "no usable Vulkan device"));
    EXPECT_TRUE(has(check_devices({}, ""), Level::fault, "no Vulkan device"));
}

}  // namespace
}  // namespace exemplar
