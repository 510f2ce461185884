#include "host/mesh/curvature/tensor_diffusion.h"

#include <fmt/format.h>
#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>

#include "host/core/errors.h"
#include "host/core/parallel.h"

namespace exemplar {

namespace {

constexpr std::size_t k_chunk = 256;  // vertices

// The kernel exp(-d^2 / (2 s^2)) - exp(-k_cutoff) is zero from d^2 = 2 k_cutoff s^2 on. It is continuous there, so
// that no vertex of a moving mesh enters it with a jump. The cutoff lowers its variance by the factor k_kept, the
// ratio of the integrals of t and 1 under (exp(-t) - exp(-k_cutoff)) dt; a larger s makes up for that.
constexpr double k_cutoff = 4, k_rest = 0.018315638888734179;  // exp(-k_cutoff)
constexpr double k_kept = (1 - (1 + k_cutoff + k_cutoff * k_cutoff / 2) * k_rest) / (1 - (1 + k_cutoff) * k_rest);

/// Splits a symmetric form into components that rotate by 0 and by 2 times the angle: (mean, half the difference of
/// the diagonal, off-diagonal).
Form to_angular_components(const Form& form) {
    return {0.5f * (form[0] + form[2]), 0.5f * (form[0] - form[2]), form[1]};
}
Form from_angular_components(const Form& spins) {
    return {spins[0] + spins[1], spins[2], spins[0] - spins[1]};
}
/// Splits a symmetric third-order tensor into components that rotate by 1 and by 3 times the angle.
FormDerivative to_angular_components(const FormDerivative& d) {
    return {d[0] + d[2], d[1] + d[3], d[0] - 3 * d[2], 3 * d[1] - d[3]};
}
FormDerivative from_angular_components(const FormDerivative& s) {
    return {0.25f * (3 * s[0] + s[2]), 0.25f * (s[1] + s[3]), 0.25f * (s[0] - s[2]), 0.25f * (3 * s[1] - s[3])};
}

/// Adds weight times the rotated tensor to `sum`. Rotating these components costs half as much as rotating those of
/// the tensor.
void add_rotated(Form& sum, const Form& s, float weight, TangentRotation turn) {
    const float c = turn.cosine * turn.cosine - turn.sine * turn.sine, d = 2 * turn.cosine * turn.sine;
    sum[0] += weight * s[0];
    sum[1] += weight * (c * s[1] + d * s[2]);
    sum[2] += weight * (c * s[2] - d * s[1]);
}
void add_rotated(FormDerivative& sum, const FormDerivative& s, float weight, TangentRotation turn) {
    const float c1 = turn.cosine, d1 = turn.sine;
    const float c2 = c1 * c1 - d1 * d1, d2 = 2 * c1 * d1;
    const float c3 = c2 * c1 - d2 * d1, d3 = c2 * d1 + d2 * c1;
    sum[0] += weight * (c1 * s[0] + d1 * s[1]);
    sum[1] += weight * (c1 * s[1] - d1 * s[0]);
    sum[2] += weight * (c3 * s[2] + d3 * s[3]);
    sum[3] += weight * (c3 * s[3] - d3 * s[2]);
}

}  // namespace

TensorDiffusion::TensorDiffusion(const VertexNeighbors& neighbors, std::size_t max_bytes)
    : neighbors_(&neighbors),
      max_entries_(max_bytes / sizeof(Entry)),
      chunks_((neighbors.vertex_count() + k_chunk - 1) / k_chunk) {}

void TensorDiffusion::prepare(std::span<const Vec3> vertices, const std::vector<TangentFrame>& frames,
                              const std::vector<float>& areas, double width, std::size_t enough) {
    std::atomic<std::size_t> total = 0;
    tbb::enumerable_thread_specific<NearFlood> floods(*neighbors_, enough);
    parallel_for(chunks_.size(), [&](std::size_t c) {
        NearFlood& flood = floods.local();
        Chunk& chunk = chunks_[c];
        chunk.entries.clear();
        chunk.end.clear();
        for (std::size_t v = c * k_chunk; v < std::min((c + 1) * k_chunk, vertices.size()); ++v) {
            const std::size_t before = chunk.entries.size();
            add_kernel(static_cast<std::uint32_t>(v), vertices, frames, areas, width, chunk, flood);
            const std::size_t more = chunk.entries.size() - before;
            if (total.fetch_add(more, std::memory_order_relaxed) + more > max_entries_)
                throw UsageError(fmt::format(
                    "smoothing over {:.3g} mesh units reaches too many of {} vertices for the memory there is; smooth "
                    "less (--smoothing 0: not at all), or simplify the mesh",
                    width, vertices.size()));
        }
    });
}

void TensorDiffusion::add_kernel(std::uint32_t center, std::span<const Vec3> vertices,
                                 const std::vector<TangentFrame>& frames, const std::vector<float>& areas, double width,
                                 Chunk& chunk, NearFlood& flood) const {
    const auto inverse = static_cast<float>(-0.5 * k_kept / (width * width));
    const auto limit = static_cast<float>(2 * k_cutoff / k_kept * width * width);
    const TangentFrame& frame = frames[center];
    const std::size_t first = chunk.entries.size();
    // A vertex without faces, or with degenerate faces only, keeps its value.
    float total = std::max(areas[center], std::numeric_limits<float>::min()) * static_cast<float>(1 - k_rest);
    chunk.entries.push_back({center, total, {}});
    flood.around(center, [&](std::uint32_t vertex) {
        const float squared = (vertices[vertex] - vertices[center]).squaredNorm();
        if (!(squared < limit)) return Nearness::outside;
        const TangentFrame& there = frames[vertex];
        // Transport over a sharp fold has no meaning; the cosine fades it out.
        const float cosine = std::max(there.normal.dot(frame.normal), 0.0f);
        const float weight = areas[vertex] * cosine * (std::exp(squared * inverse) - static_cast<float>(k_rest));
        chunk.entries.push_back({vertex, weight, rotation_to(there, frame.tangent, frame.normal)});
        total += weight;
        return Nearness::inside;
    });
    for (std::size_t i = first; i < chunk.entries.size(); ++i) chunk.entries[i].weight /= total;
    chunk.end.push_back(chunk.entries.size());
}

template <typename Tensor>
void TensorDiffusion::apply_to(std::vector<Tensor>& tensors, std::vector<Tensor>& scratch) {
    scratch.resize(tensors.size());
    for (std::size_t i = 0; i < tensors.size(); ++i) scratch[i] = to_angular_components(tensors[i]);
    parallel_for(chunks_.size(), [&](std::size_t c) {
        const Chunk& chunk = chunks_[c];
        std::size_t entry = 0;
        for (std::size_t i = 0; i < chunk.end.size(); ++i) {
            Tensor sum{};
            for (; entry < chunk.end[i]; ++entry) {
                const Entry& e = chunk.entries[entry];
                add_rotated(sum, scratch[e.vertex], e.weight, e.turn);
            }
            tensors[c * k_chunk + i] = from_angular_components(sum);
        }
    });
}

void TensorDiffusion::apply(std::vector<Form>& forms) {
    apply_to(forms, form_scratch_);
}
void TensorDiffusion::apply(std::vector<FormDerivative>& derivatives) {
    apply_to(derivatives, derivative_scratch_);
}

}  // namespace exemplar
