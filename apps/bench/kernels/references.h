#pragma once

#include <memory>
#include <span>
#include <vector>

#include "apps/bench/kernels/timing.h"
#include "gpu/runtime/device/device_info.h"

namespace exemplar {

/// The kernels that only copy, or only multiply and add. They are timed in turns with others: the speed of the device
/// at that time. On graphics cards, each takes at least half a millisecond, far above the cost of a dispatch.
class References {
  public:
    References(Device& device, const Ceilings& ceilings);
    ~References();

    /// Appends the kernels to what is timed. They must outlive the timing.
    void append(std::vector<Timed>& timed) const;
    /// Returns the times of the appended kernels, in milliseconds per 100,000 vec4s and per 16,384 items of 64 rounds,
    /// so that measurements with references of other sizes can be compared.
    KernelTimes times(std::span<const OperationTimes> measured) const;

  private:
    struct Reference;
    std::vector<std::unique_ptr<Reference>> references_;
};

}  // namespace exemplar
