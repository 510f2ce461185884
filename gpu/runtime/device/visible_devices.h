#pragma once

#include <functional>
#include <span>
#include <string>
#include <string_view>

#include "gpu/runtime/device/device_info.h"

namespace exemplar {

/// Makes graphics cards unusable that the environment assigns to others, with the reason: CUDA_VISIBLE_DEVICES (of
/// NVIDIA) and ROCR_VISIBLE_DEVICES (of AMD) list the cards of their vendor to use, by number or as GPU-UUID, and where
/// neither is set, SLURM_STEP_GPUS or SLURM_JOB_GPUS list numbers of cards. Cards are numbered by their PCI addresses.
/// An entry that names no card ends the list, as in CUDA. A list with an entry for a part of a card (MIG-UUID) hides
/// nothing, because Vulkan does not tell which card that part belongs to. `environment` returns the value of a
/// variable or null.
void hide_devices_of_others(std::span<DeviceInfo> devices,
                            const std::function<const char*(const char* variable)>& environment);

/// Returns whether `text`, hexadecimal digits in any case with or without dashes, is the device's UUID or begins it.
bool is_uuid_of(std::string_view text, const DeviceInfo& device);

/// Returns whether `text` is the device's PCI address ("0000:41:00.0"; the domain may be left out).
bool is_pci_address_of(std::string_view text, const DeviceInfo& device);

/// "6c6f70a1-0000-...", as drivers' tools print it.
std::string uuid_text(const DeviceInfo& device);

}  // namespace exemplar
