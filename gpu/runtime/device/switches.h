#pragma once

namespace exemplar {

/// What environment variables ask of every device that is opened. All are for tests, and off by default.
struct DeviceSwitches {
    bool validates = false;       ///< EXEMPLAR_VALIDATION=1: load the validation layer and check accesses of buffers
    bool checks_shaders = false;  ///< EXEMPLAR_VALIDATION=gpu: also let the layer report what shaders access out of
                                  ///< bounds (GPU-assisted validation)
    bool maps_memory = true;      ///< false by EXEMPLAR_MEMORY=unmapped: as on a graphics card, the host cannot see
                                  ///< the device's memory, and everything is copied through staging memory
    bool prefers_host = true;     ///< false by EXEMPLAR_HOST=never: run kernels also where the host is faster
    bool prefers_card_kernels = false;  ///< EXEMPLAR_KERNELS=card: run the build of shaders for cards, with the
                                        ///< parameters for cards, also on a CPU device
    bool poisons = false;  ///< EXEMPLAR_POISON=1: fill fresh memory with 0xff: NaN, and indices out of range
};

/// Reads the switches. Throws UsageError naming a value that is not known.
DeviceSwitches environment_switches();

}  // namespace exemplar
