#include "gpu/runtime/device/visible_devices.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <optional>
#include <string_view>
#include <vector>

#include "host/core/text.h"

namespace exemplar {
namespace {

constexpr std::uint32_t k_nvidia = 0x10de, k_amd = 0x1002;  // PCI vendors

std::string hexadecimal_digits(std::string_view text) {
    std::string digits = lower_case(text);
    std::erase(digits, '-');
    return digits;
}

std::optional<std::size_t> number_of(std::string_view text) {
    std::size_t number = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
    return number;
}

// Returns the card that an entry of a list names, or null.
DeviceInfo* named_card(std::string_view entry, std::span<DeviceInfo* const> cards) {
    if (const std::optional<std::size_t> number = number_of(entry))
        return *number < cards.size() ? cards[*number] : nullptr;
    constexpr std::string_view k_prefix = "GPU-";
    if (!entry.starts_with(k_prefix)) return nullptr;
    const auto found = std::ranges::find_if(
        cards, [&](const DeviceInfo* card) { return is_uuid_of(entry.substr(k_prefix.size()), *card); });
    return found == cards.end() ? nullptr : *found;
}

// Hides the cards that the value of a variable does not list.
void keep_listed(std::span<DeviceInfo* const> cards, std::string_view variable, std::string_view value) {
    if (value.find("MIG-") != std::string_view::npos) return;
    std::vector<DeviceInfo*> listed;
    for (std::size_t begin = 0; begin <= value.size();) {
        const std::size_t end = std::min(value.find(',', begin), value.size());
        DeviceInfo* card = named_card(value.substr(begin, end - begin), cards);
        if (!card) break;
        listed.push_back(card);
        begin = end + 1;
    }
    for (DeviceInfo* card : cards)
        if (std::ranges::find(listed, card) == listed.end() && card->unusable.empty())
            card->unusable = fmt::format("{}={:.40} assigns others to this program", variable, value);
}

// Returns the graphics cards of a vendor (0: of any) by their PCI addresses.
std::vector<DeviceInfo*> cards_of(std::span<DeviceInfo> devices, std::uint32_t vendor) {
    std::vector<DeviceInfo*> cards;
    for (DeviceInfo& device : devices)
        if (vendor ? device.vendor == vendor : device.type == DeviceType::discrete) cards.push_back(&device);
    std::ranges::stable_sort(cards, {}, [](const DeviceInfo* card) { return card->pci_address; });
    return cards;
}

}  // namespace

bool is_uuid_of(std::string_view text, const DeviceInfo& device) {
    const std::string digits = hexadecimal_digits(text);
    return !digits.empty() && hexadecimal_digits(uuid_text(device)).starts_with(digits);
}

bool is_pci_address_of(std::string_view text, const DeviceInfo& device) {
    const std::string address = lower_case(text);
    return !device.pci_address.empty() && (address == device.pci_address || "0000:" + address == device.pci_address);
}

std::string uuid_text(const DeviceInfo& device) {
    std::string text;
    for (std::size_t i = 0; i < device.uuid.size(); ++i) {
        if (i == 4 || i == 6 || i == 8 || i == 10) text += '-';
        text += fmt::format("{:02x}", device.uuid[i]);
    }
    return text;
}

void hide_devices_of_others(std::span<DeviceInfo> devices,
                            const std::function<const char*(const char* variable)>& environment) {
    bool assigned = false;
    const auto of_vendor = [&](std::uint32_t vendor, const char* variable) {
        const char* value = environment(variable);
        if (!value) return;
        assigned = true;
        keep_listed(cards_of(devices, vendor), variable, value);
    };
    of_vendor(k_nvidia, "CUDA_VISIBLE_DEVICES");
    of_vendor(k_amd, "ROCR_VISIBLE_DEVICES");
    if (assigned) return;
    for (const char* variable : {"SLURM_STEP_GPUS", "SLURM_JOB_GPUS"}) {
        const char* value = environment(variable);
        if (!value || !*value) continue;
        // Where Slurm hides the cards of others itself, those left are this program's, whatever their numbers.
        const std::vector<DeviceInfo*> cards = cards_of(devices, 0);
        const auto listed = 1 + std::ranges::count(std::string_view(value), ',');
        if (std::ssize(cards) > listed) keep_listed(cards, variable, value);
        return;
    }
}

}  // namespace exemplar
