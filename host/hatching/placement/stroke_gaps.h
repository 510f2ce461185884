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

/// Gaps between strokes of a layer. It refers to both of its arguments; throws UsageError for a stroke of no layer.
class StrokeGaps {
  public:
    static constexpr float k_none = std::numeric_limits<float>::max();

    /// At a point of a stroke.
    struct Gaps {
        /// Unit vector perpendicular to the stroke; zero where its layer has no strokes, or the stroke no direction.
        Vec2 across{0, 0};
        float spacing = 0;  ///< the target there, 1 pixel at least
        /// How far it is along `across`, and the other way, to the next other stroke, in spacings; k_none where that
        /// is over three, or leaves the layer on the way.
        std::array<float, 2> ratio{k_none, k_none};
    };

    StrokeGaps(std::span<const HatchStroke> strokes, const HatchingFields& fields);
    ~StrokeGaps();
    StrokeGaps(const StrokeGaps&) = delete;
    StrokeGaps& operator=(const StrokeGaps&) = delete;

    /// Of each point of a stroke.
    std::vector<Gaps> beside(std::uint32_t stroke) const;
    /// How near other strokes come to the center line of one, in spacings; 1 if no nearer.
    float least(std::uint32_t stroke) const;
    /// Whether a layer has strokes at a point.
    bool is_hatched(const Vec2& at, std::size_t layer) const;

  private:
    float spacing_at(const Vec2& at) const;
    bool stays_hatched(const Vec2& from, const Vec2& way, float distance, std::size_t layer) const;

    std::span<const HatchStroke> strokes_;
    const HatchingFields& fields_;
    std::array<std::unique_ptr<PieceCells>, k_hatch_layers> cells_;
};

}  // namespace exemplar
