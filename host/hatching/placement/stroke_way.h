#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "host/hatching/placement/clearance.h"
#include "host/hatching/placement/placement_grid.h"

namespace exemplar {

/// Where a stroke is tried, and the direction of strokes there.
struct StrokeSeed {
    std::uint32_t layer = 0;
    FinePoint point;
    Direction heading;
};

/// A step of a stroke: where it leads, in which direction.
struct StrokeStep {
    FinePoint point;
    Direction heading;
};
/// The next step of a stroke (second-order Runge-Kutta); none where its layer has no strokes, at a barrier, and where
/// orientations turn too sharply or cancel out.
std::optional<StrokeStep> next_step(const PlacementGrid& grid, std::uint32_t layer, FinePoint tip, Direction heading);

/// What ends one side of a stroke: its length, or its layer, a barrier or a sharp turn, or another stroke or itself.
enum class StrokeEnd { none, length, region, crowd };

/// One side of a stroke, from the seed on.
struct StrokeBranch {
    FinePoint tip;
    Direction heading;
    std::vector<FinePoint> points;  ///< without the seed
    std::int32_t turn = 0;          ///< the sum of the sines of its turns, times k_unit
    std::int32_t quiet = 0;         ///< steps in which it cannot come back to itself
    std::int32_t steps = 0;         ///< that it would have by its length
    StrokeEnd end = StrokeEnd::none;

    std::int32_t reach() const { return static_cast<std::int32_t>(points.size()); }
};

/// The way of a stroke through its seed: to one side up to a share of its target length that the seed's hash chooses
/// (so that neighbors do not end in line), to the other up to all of it, and where that ends early, on at the first.
/// Where it ends by its length, it is walked on as far as a gap and the least of further strokes would take.
class StrokeWay {
  public:
    /// All must live as long as this.
    StrokeWay(const PlacementGrid& grid, const Clearance& clearance, const StrokeSeed& seed);

    const StrokeBranch& on() const { return branches_[0]; }
    const StrokeBranch& back() const { return branches_[1]; }
    /// Places are counted in steps, from the end of `back` to that of `on`: the number of the last.
    std::int32_t last() const { return on().reach() + back().reach(); }
    FinePoint point_at(std::int32_t place) const { return from_seed(place - back().reach()); }
    /// The texel that the seed is in.
    const PlacementTexel& texel() const { return texel_; }
    /// The target length at a pixel, of a stroke of a share of it, in steps.
    static std::int32_t target_steps(const PlacementTexel& texel, std::int32_t share) {
        return texel.length() * share >> (k_share_bits + k_length_bits);
    }
    /// The share of targets that this stroke's length is.
    std::int32_t length_share() const { return length_share_; }
    /// Steps of the gap between two strokes in line.
    std::int32_t gap_steps() const;

  private:
    FinePoint from_seed(std::int32_t i) const;
    void walk(StrokeBranch& branch, std::int32_t share);
    void look_ahead(StrokeBranch& branch);
    void step(StrokeBranch& branch);
    bool meets_itself(StrokeBranch& branch, FinePoint next, const PlacementTexel& texel) const;
    std::int32_t distance_to_itself(const StrokeBranch& branch, FinePoint next, std::int32_t test) const;

    const PlacementGrid& grid_;
    const Clearance& clearance_;
    const StrokeSeed& seed_;
    const PlacementTexel& texel_;
    std::int32_t length_share_ = 0;
    std::int32_t least_turn_ = 0, most_turn_ = 0;  // of all steps so far, from the seed on
    std::array<StrokeBranch, 2> branches_;
};

/// The least number of steps of a stroke around a pixel, of which other strokes end so many ends.
std::int32_t least_steps(const PlacementGrid& grid, const PlacementTexel& texel, std::int32_t crowded_ends);

}  // namespace exemplar
