#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "gpu/runtime/device/device.h"
#include "gpu/runtime/kernels/kernel.h"
#include "gpu/runtime/record/buffer.h"
#include "gpu/runtime/record/stream.h"
#include "host/labeling/features/context.h"

namespace exemplar {

/// Faces per invocation. On a CPU each loaded sample is used for many faces: D6 in docs/portability.md.
inline constexpr std::array<std::uint32_t, 4> k_faces_per_invocation{1, 2, 4, 8};
inline constexpr TunableParameter k_context_faces{"labeling/context_geodesic.comp", "faces", k_faces_per_invocation, 4,
                                                  1};

/// Histograms per class that are over geodesic distance. Those along axes follow, k_context_axes times as many.
constexpr std::size_t k_geodesic_columns = k_context_bins;
/// Classes that the kernels sum together, and samples whose ranges are packed together.
constexpr std::size_t k_class_block = 4, k_sample_block = 32;

/// A range of faces, samples or classes.
struct ContextRange {
    std::size_t first;
    std::size_t count;
};

/// A mesh, or some of its samples, faces and classes, and where its histograms go.
struct ContextWork {
    const ContextGeometry* geometry;
    ContextRange samples, faces, classes;
    std::vector<std::uint32_t> rows;  ///< of the samples, in the buffer of probabilities
    /// Places of the first face's first histogram in the two buffers, and the distance of columns, in floats.
    std::size_t first_geodesic, first_axes, stride;
};

/// Most works at a time: the workgroups along z that every device has.
constexpr std::size_t k_max_context_works = 65'535;

/// The size of a work: bytes in the buffer where it has most of them, and texels in the texel buffer where it has most.
struct ContextDemand {
    std::size_t bytes = 0, texels = 0;
};
ContextDemand demand_of(std::size_t samples, std::size_t faces, std::size_t classes);

/// The kernels of contextual label histograms (thesis Eq. A.1), and the buffers between them. The geometry of all works
/// is uploaded once. Then each call of record() turns probabilities into histograms, of all works together.
class ContextKernels {
  public:
    explicit ContextKernels(Device& device);
    /// Records the upload of the geometry of `works`, each of at least one sample, face and class. Their histograms
    /// over geodesic distance take `geodesic_floats`, those along axes k_context_axes times as many.
    void upload(Stream& stream, std::span<const ContextWork> works, std::size_t geodesic_floats);
    /// Records the histograms of `probabilities`: rows x all classes, of which a work uses its own.
    void record(Stream& stream, const Buffer& probabilities, std::size_t all_classes);
    /// Frees all buffers.
    void release();
    /// Column (measure * bins + bin) * classes + class begins at a work's first place plus the column times its stride;
    /// the measures of each buffer count from 0.
    const Buffer& geodesic() const { return geodesic_; }
    const Buffer& axes() const { return axes_; }

  private:
    void upload_ranges(Stream& stream, std::span<const ContextWork> works);
    void upload_positions(Stream& stream, std::span<const ContextWork> works);
    void upload_samples(Stream& stream, std::span<const ContextWork> works);
    Device& device_;
    std::uint32_t faces_per_thread_;
    Kernel mass_kernel_, prefix_kernel_, geodesic_kernel_, axes_kernel_;
    std::size_t works_ = 0, max_faces_ = 0, max_samples_ = 0, max_classes_ = 0;  // of what is uploaded
    std::size_t faces_ = 0, samples_ = 0, ranges_ = 0;                           // sums
    Buffer parts_;                                                               // ContextPart
    Buffer ranges_of_;    // blocks of 32 samples x faces x 32 samples, four bits each
    Buffer positions_;    // axes x faces
    Buffer sample_rows_;  // ContextSample
    Buffer sorted_;       // axes x samples: their positions, rising
    Buffer orders_;       // axes x samples: their numbers in this order
    Buffer masses_;       // class blocks x samples
    Buffer prefixes_;     // axes x class blocks x (samples + 1)
    Buffer geodesic_;     // bins x classes x faces: histograms
    Buffer axes_;         // axes x bins x classes x faces
};

}  // namespace exemplar
