#include "host/hatching/placement/streamlines.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "host/core/parallel.h"
#include "host/hatching/placement/clearance.h"
#include "host/hatching/placement/clipped_strokes.h"
#include "host/hatching/placement/stroke_claims.h"
#include "host/hatching/placement/stroke_front.h"
#include "host/hatching/placement/stroke_tracing.h"

namespace exemplar {
namespace {

/// Outcome of a seed list in a round: exhausted, no stroke yet, or a stroke that has lost or won.
enum class TrialState { closed, pending, lost, won };
struct Trial {
    TrialState state = TrialState::closed;
    std::uint32_t claim = 0;
    StrokeCandidate candidate;
};

/// Places strokes round by round.
class Placement {
  public:
    Placement(const PlacementGrid& grid, std::vector<FineStroke> kept, Clearance& clearance)
        : grid_(grid),
          clearance_(clearance),
          claims_(grid),
          front_(first_seeds(grid, kept)),
          blocks_(block_seeds(grid)) {
        for (FineStroke& stroke : kept) add(std::move(stroke));
    }

    /// Places strokes of the front or, if it is empty, in holes; returns whether there was anything to try.
    bool round() {
        const bool is_front = !front_.empty();
        std::vector<SeedQueue>& lists = is_front ? front_ : blocks_;
        trials_.resize(std::min<std::size_t>(lists.size(), grid_.rules.candidates));
        claims_.begin_round();
        parallel_for(
            trials_.size(), [&](std::size_t i) { try_next(lists[i], i); }, 8);
        parallel_for(
            trials_.size(), [&](std::size_t i) { resolve(trials_[i]); }, 8);
        const bool any = std::ranges::any_of(trials_, [](const Trial& t) { return t.state != TrialState::closed; });
        leave_won(lists);
        if (is_front) drop_closed();
        const std::size_t first = strokes_.size();
        for (Trial& trial : trials_)
            if (trial.state == TrialState::won) add(std::move(trial.candidate.stroke));
        parallel_for(
            strokes_.size() - first, [&](std::size_t i) { clearance_.add(strokes_[first + i]); }, 4);
        return any || is_front;
    }

    const std::vector<FineStroke>& strokes() const { return strokes_; }

  private:
    /// Traces a stroke from the next place of a list at which one may begin.
    void try_next(SeedQueue& list, std::size_t place) {
        Trial& trial = trials_[place];
        const auto seed = next_seed(list);
        trial.state = list.next < seed_count(grid_, list) ? TrialState::pending : TrialState::closed;
        if (!seed) return;
        if (!trace_stroke(grid_, clearance_, *seed, trial.candidate)) {
            ++list.next;
            return;
        }
        trial.state = TrialState::lost;
        trial.claim = claims_.claim_of(static_cast<std::uint32_t>(place), trial.candidate.shortness);
        claims_.claim(list.layer, trial.candidate.way, trial.claim);
    }

    std::optional<StrokeSeed> next_seed(SeedQueue& list) const {
        const std::uint32_t end = std::min(seed_count(grid_, list), list.next + k_max_seeds_per_round);
        for (; list.next < end; ++list.next)
            if (const auto seed = seed_at(grid_, clearance_, points_, list, list.next)) return seed;
        return {};
    }

    void resolve(Trial& trial) const {
        if (trial.state == TrialState::lost &&
            claims_.wins(trial.candidate.stroke.layer, trial.candidate.way, trial.claim))
            trial.state = TrialState::won;
    }

    /// Advances the lists of winners. Where strokes are a pixel apart, the clearance map may miss a stroke at its
    /// own seed: it would be placed again forever.
    void leave_won(std::vector<SeedQueue>& lists) const {
        for (std::size_t i = 0; i < trials_.size(); ++i)
            if (trials_[i].state == TrialState::won) ++lists[i].next;
    }

    /// Removes exhausted lists from the front, and those of parts that have their stroke.
    void drop_closed() {
        std::size_t kept = 0;
        for (std::size_t i = 0; i < front_.size(); ++i) {
            const TrialState state = i < trials_.size() ? trials_[i].state : TrialState::pending;
            const bool is_done =
                state == TrialState::closed || (state == TrialState::won && front_[i].source == SeedSource::part);
            if (!is_done) front_[kept++] = front_[i];
        }
        front_.resize(kept);
    }

    void add(FineStroke stroke) {
        const auto lists = stroke_seeds(stroke.layer, static_cast<std::uint32_t>(points_.size()),
                                        static_cast<std::uint32_t>(stroke.points.size()));
        front_.insert(front_.end(), lists.begin(), lists.end());
        points_.insert(points_.end(), stroke.points.begin(), stroke.points.end());
        strokes_.push_back(std::move(stroke));
    }

    const PlacementGrid& grid_;
    Clearance& clearance_;
    StrokeClaims claims_;
    std::vector<SeedQueue> front_, blocks_;
    std::vector<FineStroke> strokes_;
    std::vector<FinePoint> points_;  // of all of them
    std::vector<Trial> trials_;
};

}  // namespace

std::vector<HatchStroke> CpuStrokePlacer::place(const HatchingFields& fields, std::span<const std::uint8_t> barriers,
                                                const StrokeOptions& options, std::span<const HatchStroke> kept) {
    const PlacementGrid grid = make_placement_grid(fields, barriers, options);
    Clearance clearance(grid);
    Placement placement(grid, clip_strokes(grid, kept, options, clearance), clearance);
    while (placement.round()) {
    }
    return finished_strokes(placement.strokes(), fields);
}

}  // namespace exemplar
