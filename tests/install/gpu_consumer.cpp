// Scores a stump on every usable Vulkan device, and on the CPU.

#include <cmath>
#include <cstdio>
#include <vector>

#include "gpu/learn/stump_scorer.h"
#include "gpu/runtime/device/device_info.h"
#include "host/core/errors.h"

int main() try {
    exemplar::FeatureMatrix features;
    features.rows = 3;
    features.add("height");
    features.values = {-1, 0.5F, 2};
    const exemplar::BoostedStumps classifier{2, {{0, 1, 3, -3, 1}}, {0, 0}};
    std::vector<float> expected(6), scored(6);
    exemplar::CpuStumpScorer().probabilities(classifier, features, exemplar::Link::softmax, 1, expected);
    std::printf("CPU: %.4f %.4f %.4f\n", expected[0], expected[2], expected[4]);
    for (const exemplar::DeviceInfo& info : exemplar::list_devices()) {
        if (!info.unusable.empty()) continue;
        exemplar::Device device({.name = std::to_string(info.index)});
        exemplar::GpuStumpScorer(device).probabilities(classifier, features, exemplar::Link::softmax, 1, scored);
        std::printf("%s: %.4f %.4f %.4f\n", info.name.c_str(), scored[0], scored[2], scored[4]);
        for (std::size_t i = 0; i < scored.size(); ++i)
            if (!(std::abs(scored[i] - expected[i]) < 1e-5F)) return 1;
    }
    return 0;
} catch (const exemplar::Error& error) {
    std::printf("error: %s\n", error.what());
    return 1;
}
