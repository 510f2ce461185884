#pragma once

#include "host/core/errors.h"

namespace exemplar {

/// The memory of the device is exhausted, or host memory that the device needs. Processing less at a time may
/// succeed.
class DeviceMemoryError : public DeviceError {
  public:
    using DeviceError::DeviceError;
};

}  // namespace exemplar
