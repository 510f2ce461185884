#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "gpu/runtime/device/device.h"
#include "gpu/runtime/kernels/kernel.h"
#include "gpu/runtime/record/buffer.h"
#include "gpu/runtime/record/profiler.h"
#include "gpu/runtime/record/stream.h"
#include "host/hatching/style/style_prediction.h"

namespace exemplar {

/// Evaluates a style's rules and properties on the device, in tiles of rows that fit its limits. Uploads only the
/// fields and features in use. Agrees with CpuHatchingEvaluator up to the rounding of floats, exp and log:
/// directions within 1e-5 unless a rule's fields cancel out, properties within 1e-4 of their value. Repeated runs on
/// one device give the same bytes. Only one thread at a time may use it.
class GpuHatchingEvaluator final : public HatchingEvaluator {
  public:
    /// `tile_bytes` limits the memory of a tile's fields or features; the device's own limits apply, too.
    explicit GpuHatchingEvaluator(Device& device, Profiler* profiler = nullptr,
                                  std::size_t tile_bytes = std::size_t{256} << 20);
    std::vector<DoubledAngle> orientations(std::span<const OrientationFunction> functions,
                                           std::span<const std::int32_t> segment,
                                           const OrientationFields& fields) override;
    std::vector<float> property(const PropertyModel& model, std::span<const std::uint32_t> which,
                                const FeatureMatrix& base) override;

    // The same with inputs and results in buffers, recorded into a stream, for example of another program's commands.
    // They throw UsageError if a buffer is too small, and as Stream::dispatch.

    /// Returns the numbers of the fields that rules use, rising (OrientationFields::field).
    static std::vector<std::uint32_t> fields_of(std::span<const OrientationFunction> functions);
    /// Records the directions (doubled angles) of rows. `segments` has the number of a function for each row, `fields`
    /// the fields of fields_of, `stride` doubled angles each (at least `rows`). A row without direction gets (0, 0).
    /// Without fields, `fields` is not read, but must hold one.
    void record_orientations(Stream& stream, std::span<const OrientationFunction> functions, const Buffer& segments,
                             const Buffer& fields, std::size_t rows, std::size_t stride, const Buffer& directions);
    /// Returns the numbers of the base features that a property uses, rising.
    static std::vector<std::uint32_t> features_of(const PropertyModel& model);
    /// Records a property of rows. `columns` has the features of features_of, `stride` floats each: a multiple of 4, at
    /// least `rows`. Values must be finite, of magnitude 1e19 at most; -2e30 stands for no value. `values` needs
    /// `stride` floats, too. Without features, `columns` is not read, but must hold one column.
    void record_property(Stream& stream, const PropertyModel& model, const Buffer& columns, std::size_t rows,
                         std::size_t stride, const Buffer& values);

  private:
    std::size_t tile_rows(std::size_t rows, std::size_t row_bytes) const;

    Device& device_;
    std::size_t tile_bytes_;
    Stream stream_;
    Kernel orientations_, property_;
    Buffer segments_, columns_, values_;  // of a tile
};

}  // namespace exemplar
