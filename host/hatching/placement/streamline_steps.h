#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "host/hatching/placement/clearance.h"
#include "host/hatching/placement/placement_grid.h"

namespace exemplar {

/// A point at which a stroke is tried, and the direction of strokes there.
struct StrokeSeed {
    std::uint32_t layer = 0;
    FinePoint point;
    Direction heading;
};

/// A tracing step: the point that it leads to, and its direction.
struct StrokeStep {
    FinePoint point;
    Direction heading;
};
/// Returns the next step of a stroke (second-order Runge-Kutta); none if its layer is not hatched there, at a
/// barrier, or where orientations turn too sharply or cancel out.
std::optional<StrokeStep> next_step(const PlacementGrid& grid, std::uint32_t layer, FinePoint tip, Direction heading);

/// Why one side of a stroke ends: its length; its layer, a barrier or a sharp turn (`region`); or another stroke or
/// itself (`crowd`).
enum class StrokeEnd { none, length, region, crowd };

/// One side of a stroke, from the seed on.
struct StrokeBranch {
    FinePoint tip;
    Direction heading;
    std::vector<FinePoint> points;     ///< without the seed
    std::int32_t turn = 0;             ///< sum of the sines of its turns, times k_unit
    std::int32_t unchecked_steps = 0;  ///< steps for which it cannot meet itself
    std::int32_t steps = 0;            ///< within its length; the rest of `points` is look-ahead
    StrokeEnd end = StrokeEnd::none;

    std::int32_t reach() const { return static_cast<std::int32_t>(points.size()); }
};

/// The streamline through a seed. It is traced forward to a pseudo-random share of the target length (a hash of the
/// seed, so that neighbors do not end side by side), backward until it has all of it, and forward again if that
/// ended early. An end that is reached by length is traced further, by a gap and the minimum length of another
/// stroke.
class Streamline {
  public:
    /// Keeps references to all arguments.
    Streamline(const PlacementGrid& grid, const Clearance& clearance, const StrokeSeed& seed);

    /// The sides forward and backward from the seed.
    const StrokeBranch& on() const { return branches_[0]; }
    const StrokeBranch& back() const { return branches_[1]; }
    /// Returns the last place. Places count steps from the end of back() to the end of on(), starting at 0.
    std::int32_t last() const { return on().reach() + back().reach(); }
    FinePoint point_at(std::int32_t place) const { return from_seed(place - back().reach()); }
    /// Returns the texel that contains the seed.
    const PlacementTexel& texel() const { return texel_; }
    /// Returns a share of the target length at a pixel, in steps.
    static std::int32_t target_steps(const PlacementTexel& texel, std::int32_t share) {
        return texel.length() * share >> (k_share_bits + k_length_bits);
    }
    /// Returns the length of this stroke as a share of its target, with jitter.
    std::int32_t length_share() const { return length_share_; }
    /// Returns the number of steps of the gap between two strokes in line.
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
    std::int32_t min_turn_ = 0, max_turn_ = 0;  // extremes of StrokeBranch::turn so far, on both sides
    std::array<StrokeBranch, 2> branches_;
};

/// Returns the minimum length of a stroke at a pixel in steps, given how many of its ends are blocked by other
/// strokes.
std::int32_t min_stroke_steps(const PlacementGrid& grid, const PlacementTexel& texel, std::int32_t crowded_ends);

}  // namespace exemplar
