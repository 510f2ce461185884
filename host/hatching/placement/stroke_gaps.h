#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "host/hatching/fields/hatch_stroke.h"
#include "host/hatching/fields/hatching_fields.h"

namespace exemplar {

class PieceCells;

/// Measures gaps between strokes of the same layer. Keeps references to both arguments. Throws UsageError for a
/// stroke whose layer does not exist.
class StrokeGaps {
  public:
    static constexpr float k_invalid_index = std::numeric_limits<float>::max();

    /// The gaps on both sides of a point of a stroke.
    struct Gaps {
        /// Unit vector perpendicular to the stroke; zero where its layer is not hatched or the stroke has no
        /// direction.
        Vec2 across{0, 0};
        float spacing = 0;  ///< target spacing there, at least 1 pixel
        /// Distance to the next other stroke, along `across` and against it, in spacings; k_invalid_index if it is over
        /// three, or if the path leaves the hatched area of the layer.
        std::array<float, 2> ratio{k_invalid_index, k_invalid_index};
    };

    StrokeGaps(std::span<const HatchStroke> strokes, const HatchingFields& fields);
    ~StrokeGaps();
    StrokeGaps(const StrokeGaps&) = delete;
    StrokeGaps& operator=(const StrokeGaps&) = delete;

    /// Returns the gaps at each point of a stroke.
    std::vector<Gaps> beside(std::uint32_t stroke) const;
    /// Returns the minimum distance from the points of a stroke to other strokes' center lines, in spacings; at most
    /// 1.
    float least(std::uint32_t stroke) const;
    /// Returns whether a layer is hatched at a point.
    bool is_hatched(const Vec2& at, std::size_t layer) const;

  private:
    float spacing_at(const Vec2& at) const;
    bool stays_hatched(const Vec2& from, const Vec2& way, float distance, std::size_t layer) const;

    std::span<const HatchStroke> strokes_;
    const HatchingFields& fields_;
    std::array<std::unique_ptr<PieceCells>, k_hatch_layers> cells_;
};

}  // namespace exemplar
