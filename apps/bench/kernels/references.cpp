#include "apps/bench/kernels/references.h"

#include <bit>
#include <cmath>
#include <utility>

#include "embedded/runtime_copy_comp.h"
#include "embedded/runtime_multiply_add_comp.h"
#include "gpu/runtime/device/device.h"
#include "gpu/runtime/kernels/kernel.h"
#include "gpu/runtime/record/buffer.h"
#include "gpu/runtime/record/stream.h"
#include "shaders/shared/ceilings.h"

namespace exemplar {
namespace {

constexpr double k_reference_seconds = 5e-4;
constexpr std::size_t k_reference_vectors = 100'000, k_reference_items = 16'384;
constexpr std::uint32_t k_reference_rounds = 64;

// Returns the power of four, up to `max_scale`, by which a reference is larger than its smallest size. It must not
// change with the noise of the ceilings: on CPU devices, whose speed changes most, and where the smallest size is
// enough, it is 1.
std::size_t reference_scale(const DeviceInfo& device, double smallest_seconds, std::size_t max_scale) {
    std::size_t scale = 1;
    if (device.type == DeviceType::cpu) return scale;
    while (static_cast<double>(scale) * smallest_seconds < k_reference_seconds && 4 * scale <= max_scale) scale *= 4;
    return scale;
}

// Copies scale * 100,000 vec4s.
struct CopyReference {
    CopyReference(Device& device, Profiler& profiler, std::size_t scale)
        : parameters{static_cast<std::uint32_t>(scale * k_reference_vectors)},
          source(device, 16 * scale * k_reference_vectors),
          target(device, source.bytes()),
          kernel(device, shaders::runtime_copy_comp, {.push_constants = layout_of<shared::CopyParameters>()}),
          stream(device, &profiler) {
        stream.fill(source, std::bit_cast<std::uint32_t>(1.0f));
        stream.finish();
    }
    void run() {
        stream.dispatch(kernel, parameters.count, {source, target}, parameters);
        stream.finish();
    }
    shared::CopyParameters parameters;
    Buffer source, target;
    Kernel kernel;
    Stream stream;
};

// Runs 16,384 items over scale * 64 rounds.
struct MultiplyAddReference {
    MultiplyAddReference(Device& device, Profiler& profiler, std::size_t scale)
        : parameters{.rounds = k_reference_rounds, .factor = 0.9999f, .summand = 1e-4f},
          result(device, 4 * scale * k_reference_items),
          kernel(device, shaders::runtime_multiply_add_comp,
                 {.push_constants = layout_of<shared::MultiplyAddParameters>()}),
          stream(device, &profiler) {}
    void run() {
        stream.dispatch(kernel, result.bytes() / sizeof(float), {result}, parameters);
        stream.finish();
    }
    shared::MultiplyAddParameters parameters;
    Buffer result;
    Kernel kernel;
    Stream stream;
};

}  // namespace

struct References::Reference {
    template <typename State>
    static std::unique_ptr<Reference> of(Device& device, std::string name, std::size_t scale) {
        auto reference = std::make_unique<Reference>();
        reference->name = std::move(name);
        reference->scale = static_cast<double>(scale);
        const auto state = std::make_shared<State>(device, reference->profiler, scale);
        reference->operation.run = [state] { state->run(); };
        reference->operation.run();
        return reference;
    }
    std::string name;
    double scale = 1;
    Profiler profiler;
    Operation operation;
};

References::References(Device& device, const Ceilings& ceilings) {
    const double copied_bytes = 32.0 * k_reference_vectors;
    const double operations = 2.0 * k_reference_items * k_reference_rounds * shared::k_multiply_adds_per_round;
    const std::uint64_t max_bytes = buffer_limit(device.info(), std::uint64_t{1} << 30);
    references_.push_back(
        Reference::of<CopyReference>(device, "copy",
                                     reference_scale(device.info(), copied_bytes / ceilings.copy_gb_per_s * 1e-9,
                                                     max_bytes / (16 * k_reference_vectors))));
    references_.push_back(
        Reference::of<MultiplyAddReference>(device, "multiply_add",
                                            reference_scale(device.info(), operations / ceilings.fma_gflop_per_s * 1e-9,
                                                            max_bytes / (4 * k_reference_items))));
}

References::~References() = default;

void References::append(std::vector<Timed>& timed) const {
    for (const auto& reference : references_)
        timed.push_back({reference->name, &reference->operation, &reference->profiler});
}

KernelTimes References::times(std::span<const OperationTimes> measured) const {
    KernelTimes times;
    for (std::size_t i = 0; i < references_.size(); ++i)
        for (const auto& [kernel, milliseconds] : measured[i].kernels) {
            std::vector<double>& scaled = times[kernel];
            scaled.reserve(milliseconds.size());
            for (const double one : milliseconds) scaled.push_back(one / references_[i]->scale);
        }
    return times;
}

}  // namespace exemplar
