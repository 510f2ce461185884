#pragma once

#include <memory>
#include <string>
#include <utility>

#include "gpu/labeling/cascade.h"
#include "gpu/labeling/context_histograms.h"
#include "gpu/learn/stump_scorer.h"
#include "gpu/runtime/device/device.h"
#include "host/labeling/features/fast_context.h"
#include "host/labeling/inference/labeler.h"

namespace exemplar {

/// A Vulkan device and the operations of labeling: compute shaders, or the host's vector units if the device is a
/// CPU. Only one thread at a time may use it.
class LabelingDevice {
  public:
    explicit LabelingDevice(const DeviceOptions& options = {}) : device_(options), labels_on_(device_.info().name) {
        if (device_.host_is_faster()) {
            labels_on_ = "the host";
            scorer_ = std::make_unique<CpuStumpScorer>();
            context_ = std::make_unique<FastContextHistograms>();
            return;
        }
        auto scorer = std::make_unique<GpuStumpScorer>(device_);
        cascade_ = std::make_unique<GpuCascade>(device_, *scorer);
        scorer_ = std::move(scorer);
        context_ = std::make_unique<GpuContextHistograms>(device_);
    }

    LabelingBackend labeling() { return {*scorer_, *context_, cascade_.get()}; }
    /// Returns what labeling() computes on: the device's name, or "the host".
    const std::string& labeling_device_name() const { return labels_on_; }
    Device& device() { return device_; }

  private:
    Device device_;
    std::string labels_on_;
    std::unique_ptr<StumpScorer> scorer_;
    std::unique_ptr<ContextHistograms> context_;
    std::unique_ptr<CascadeScorer> cascade_;  // uses the scorer
};

}  // namespace exemplar
