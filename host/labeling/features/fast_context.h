#pragma once

#include "host/labeling/features/context.h"

namespace exemplar {

/// Contextual label histograms by a host's vector units: what a device that is a CPU should use, as a shader gets there
/// a fraction of the speed. Puts every sample into the bin that the reference puts it in. Sums are in single precision,
/// those along axes differences of prefix sums: with a thousand samples they agree with the reference's within 1e-5
/// (with more, rounding adds up), a bin without samples is exactly empty, and they do not depend on the number of
/// threads. Beside the output it needs memory for the samples and some hundred kilobytes per thread. Throws what
/// ContextHistograms says.
class FastContextHistograms final : public ContextHistograms {
  public:
    void accumulate_all(std::span<const ContextMesh> meshes, std::size_t classes) override;
};

}  // namespace exemplar
