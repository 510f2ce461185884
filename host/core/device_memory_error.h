#pragma once

#include "host/core/errors.h"

namespace exemplar {

/// The memory of the device, or of the host for its sake, is used up: less at a time may work.
class DeviceMemoryError : public DeviceError {
  public:
    using DeviceError::DeviceError;
};

}  // namespace exemplar
