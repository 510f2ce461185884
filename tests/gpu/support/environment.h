#pragma once

#include "gpu/runtime/device/device.h"

namespace exemplar::test_support {

/// The device that all GPU tests of a program share: the one of EXEMPLAR_DEVICE, else the best. With
/// EXEMPLAR_VALIDATION=1 the program fails if the validation layer has said anything by its end.
Device& shared_device();

}  // namespace exemplar::test_support
