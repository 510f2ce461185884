#include "gpu/hatching/stroke_placer.h"

#include <algorithm>
#include <cstddef>
#include <numeric>

#include "embedded/hatching_claim_comp.h"
#include "embedded/hatching_end_round_comp.h"
#include "embedded/hatching_place_comp.h"
#include "embedded/hatching_seed_comp.h"
#include "embedded/hatching_trace_comp.h"
#include "host/core/interrupt.h"
#include "host/hatching/fields/occlusion_barriers.h"
#include "host/hatching/placement/clipped_strokes.h"
#include "host/hatching/placement/stroke_front.h"

namespace exemplar {
namespace {

using shared::PlacementCounts;
using shared::PlacementParameters;
using shared::SeedQueueRecord;
using shared::StrokeRecord;
using shared::TrialRecord;
using shared::uvec4;

static_assert(shared::k_pixel_bits == k_pixel_bits && shared::k_pixel == k_pixel && shared::k_unit == k_unit &&
              shared::k_unit_bits == k_unit_bits && shared::k_share_bits == k_share_bits &&
              shared::k_spacing_bits == k_spacing_bits && shared::k_length_bits == k_length_bits &&
              shared::k_step == k_step && shared::k_min_steps == k_min_steps &&
              shared::k_max_seeds_per_round == k_max_seeds_per_round && shared::k_right_barrier == k_barrier_right &&
              shared::k_lower_barrier == k_barrier_below);
static_assert(shared::k_part_source == static_cast<std::uint32_t>(SeedSource::part) &&
              shared::k_left_side_source == static_cast<std::uint32_t>(SeedSource::left_side) &&
              shared::k_right_side_source == static_cast<std::uint32_t>(SeedSource::right_side) &&
              shared::k_first_end_source == static_cast<std::uint32_t>(SeedSource::first_end) &&
              shared::k_last_end_source == static_cast<std::uint32_t>(SeedSource::last_end) &&
              shared::k_block_source == static_cast<std::uint32_t>(SeedSource::block));
static_assert(sizeof(PlacementTexel) == sizeof(uvec4) && sizeof(FinePoint) == 2 * sizeof(std::uint32_t));

/// Rounds per batch, after which the host reads the counters; a divisor of the number of rounds that claims count
/// down.
constexpr std::uint32_t k_batch = 16, k_claim_rounds = 4096;
static_assert(k_claim_rounds % k_batch == 0);

SeedQueueRecord record_of(const SeedQueue& list) {
    return {static_cast<std::uint32_t>(list.source) | list.layer << shared::k_layer_shift, list.first, list.second,
            list.next};
}

std::uint32_t groups_of(std::size_t items) {
    return static_cast<std::uint32_t>((items + shared::k_hatch_group - 1) / shared::k_hatch_group);
}

PlacementParameters parameters_of(const PlacementGrid& grid) {
    const PlacementRules& rules = grid.rules;
    return {.width = static_cast<std::uint32_t>(grid.width),
            .height = static_cast<std::uint32_t>(grid.height),
            .seed = rules.seed,
            .test_share = rules.test_share,
            .hole_share = rules.hole_share,
            .min_length_share = rules.min_length_share,
            .jitter = rules.jitter,
            .min_turn_cosine = rules.min_turn_cosine,
            .near_shift = rules.near_shift,
            .room = rules.room,
            .candidates = rules.candidates,
            .block_bits = rules.block_bits,
            .blocks = 0,
            .rounds_left = 0,
            .stroke_room = 0,
            .point_room = 0,
            .list_room = 0};
}

/// Estimates the numbers of points and strokes; buffers grow if these are too low.
struct Estimate {
    double points = 4096, strokes = 1024;
    explicit Estimate(const PlacementGrid& grid) {
        for (const PlacementTexel& texel : grid.texels)
            for (std::uint32_t layer = 0; layer < k_hatch_layers; ++layer) {
                if (!texel.hatched(layer)) continue;
                const double points_here = static_cast<double>(1 << k_spacing_bits) / texel.spacing();
                points += points_here;
                strokes += 2 * points_here / std::max(texel.length() >> k_length_bits, k_min_steps);
            }
    }
};

/// Doubles the capacity of a buffer and keeps its contents.
void double_room(Device& device, Stream& stream, Buffer& buffer, std::uint32_t& room, std::size_t item) {
    room *= 2;
    Buffer larger(device, room * item);
    stream.copy(buffer, 0, larger, 0, std::min(buffer.bytes(), larger.bytes()));
    stream.finish();
    buffer = std::move(larger);
}

}  // namespace

GpuStrokePlacer::GpuStrokePlacer(Device& device, Profiler* profiler) : device_(device), stream_(device, profiler) {
    const StructLayout word = layout_of<std::uint32_t>(), four = layout_of<uvec4>(), point = layout_of<FinePoint>(),
                       parameters = layout_of<PlacementParameters>(), trial = layout_of<TrialRecord>(),
                       list = layout_of<SeedQueueRecord>();
    seed_ = Kernel(device, shaders::hatching_seed_comp,
                   {.push_constants = parameters, .elements = {four, word, word, list, trial}});
    trace_ = Kernel(device, shaders::hatching_trace_comp,
                    {.push_constants = parameters, .elements = {four, word, list, trial, point}});
    claim_ = Kernel(device, shaders::hatching_claim_comp,
                    {.push_constants = parameters, .elements = {four, point, trial, word}, .constants = {{0, 0}}});
    check_claims_ =
        Kernel(device, shaders::hatching_claim_comp,
               {.push_constants = parameters, .elements = {four, point, trial, word}, .constants = {{0, 1}}});
    end_round_ =
        Kernel(device, shaders::hatching_end_round_comp, {.push_constants = parameters, .elements = {list, trial}});
    place_ = Kernel(device, shaders::hatching_place_comp,
                    {.push_constants = parameters, .elements = {four, point, trial, point, word}});
    count_buffer_ = Buffer(device, sizeof(PlacementCounts));
}

std::vector<HatchStroke> GpuStrokePlacer::place(const HatchingFields& fields, std::span<const std::uint8_t> barriers,
                                                const StrokeOptions& options, std::span<const HatchStroke> kept) {
    const PlacementGrid grid = make_placement_grid(fields, barriers, options);
    if (grid.size() == 0) return {};
    Clearance clearance(grid);
    const std::vector<FineStroke> first = clip_strokes(grid, kept, options, clearance);
    upload(grid, first, clearance.words());
    place_all();
    return finished_strokes(download(), fields);
}

void GpuStrokePlacer::upload(const PlacementGrid& grid, std::span<const FineStroke> kept,
                             std::span<const std::uint32_t> near) {
    parameters_ = parameters_of(grid);
    reserve(device_, grid_, grid.size() * sizeof(PlacementTexel));
    reserve(device_, near_, near.size_bytes());
    reserve(device_, claims_, near.size_bytes());
    const std::size_t candidates = grid.rules.candidates;
    reserve(device_, trials_, candidates * sizeof(TrialRecord));
    reserve(device_, ways_, candidates * grid.rules.room * sizeof(FinePoint));
    stream_.upload<PlacementTexel>(grid_, grid.texels);
    if (kept.empty())
        stream_.fill(near_, Clearance::k_far);
    else
        stream_.upload(near_, near);
    upload_lists(grid, kept);
    upload_kept(kept);
    stream_.upload<PlacementCounts>(count_buffer_, std::span(&counts_, 1));
}

/// Uploads the lists of holes, then the front, in the order of the reference. Sets the counters.
void GpuStrokePlacer::upload_lists(const PlacementGrid& grid, std::span<const FineStroke> kept) {
    std::vector<SeedQueueRecord> lists;
    for (const SeedQueue& list : block_seeds(grid)) lists.push_back(record_of(list));
    parameters_.blocks = static_cast<std::uint32_t>(lists.size());
    for (const SeedQueue& list : first_seeds(grid, kept)) lists.push_back(record_of(list));
    std::uint32_t points = 0;
    for (const FineStroke& stroke : kept) {
        const auto count = static_cast<std::uint32_t>(stroke.points.size());
        for (const SeedQueue& list : stroke_seeds(stroke.layer, points, count)) lists.push_back(record_of(list));
        points += count;
    }
    const auto front = static_cast<std::uint32_t>(lists.size()) - parameters_.blocks;
    const std::uint32_t trials = front ? std::min(front, parameters_.candidates) : parameters_.blocks;
    counts_ = {.trials = trials,
               .in_blocks = front ? 0U : 1U,
               .front = front,
               .strokes = static_cast<std::uint32_t>(kept.size()),
               .points = points,
               .full = 0,
               .held_groups = 0,
               .seed_groups = {device_.runs_card_kernels() ? trials : groups_of(trials), 1, 1},
               .trial_groups = {groups_of(trials), 1, 1},
               .candidate_groups = {0, 1, 1},
               .place_groups = {0, 1, 1}};
    const Estimate estimate(grid);
    const auto rooms = [&](Buffer& buffer, double wanted, std::size_t needed, std::size_t item) {
        const std::size_t room = std::max(static_cast<std::size_t>(wanted), needed);
        reserve(device_, buffer, room * item);
        return static_cast<std::uint32_t>(room);
    };
    parameters_.stroke_room = rooms(strokes_, estimate.strokes, kept.size(), sizeof(StrokeRecord));
    parameters_.point_room = rooms(points_, estimate.points, points, sizeof(FinePoint));
    parameters_.list_room =
        rooms(lists_, parameters_.blocks + 4 * estimate.strokes, lists.size(), sizeof(SeedQueueRecord));
    stream_.upload<SeedQueueRecord>(lists_, lists);
}

void GpuStrokePlacer::upload_kept(std::span<const FineStroke> kept) {
    std::vector<FinePoint> points;
    std::vector<StrokeRecord> strokes;
    for (const FineStroke& stroke : kept) {
        strokes.push_back({static_cast<std::uint32_t>(points.size()), static_cast<std::uint32_t>(stroke.points.size()),
                           stroke.layer, 0});
        points.insert(points.end(), stroke.points.begin(), stroke.points.end());
    }
    if (kept.empty()) return;
    stream_.upload<FinePoint>(points_, points);
    stream_.upload<StrokeRecord>(strokes_, strokes);
}

void GpuStrokePlacer::record_round(std::uint32_t rounds_left) {
    parameters_.rounds_left = rounds_left;
    constexpr std::size_t k_seeds = offsetof(PlacementCounts, seed_groups),
                          k_trials = offsetof(PlacementCounts, trial_groups),
                          k_candidates = offsetof(PlacementCounts, candidate_groups);
    stream_.dispatch_indirect(seed_, count_buffer_, k_seeds, {grid_, near_, points_, lists_, trials_, count_buffer_},
                              parameters_);
    stream_.dispatch_indirect(trace_, count_buffer_, k_trials, {grid_, near_, lists_, trials_, ways_, count_buffer_},
                              parameters_);
    stream_.dispatch_indirect(claim_, count_buffer_, k_candidates, {grid_, ways_, trials_, claims_}, parameters_);
    stream_.dispatch_indirect(check_claims_, count_buffer_, k_candidates, {grid_, ways_, trials_, claims_},
                              parameters_);
    record_end();
}

/// Records the end of a round: finds the winners and places them.
void GpuStrokePlacer::record_end() {
    constexpr std::size_t k_placed = offsetof(PlacementCounts, place_groups);
    stream_.dispatch(end_round_, Threads(shared::k_end_round_group), {lists_, trials_, count_buffer_, strokes_},
                     parameters_);
    stream_.dispatch_indirect(place_, count_buffer_, k_placed, {grid_, ways_, trials_, points_, near_}, parameters_);
}

void GpuStrokePlacer::place_all() {
    for (std::uint32_t round = 0; counts_.trials > 0; round = (round + k_batch) % k_claim_rounds) {
        if (round == 0) stream_.fill(claims_, ~0U);
        check_interrupt();
        for (std::uint32_t i = 0; i < k_batch; ++i) record_round(k_claim_rounds - 1 - round - i);
        stream_.fetch(count_buffer_, std::span(&counts_, 1));
        while (counts_.full) {
            grow_buffers();
            record_end();
            stream_.fetch(count_buffer_, std::span(&counts_, 1));
        }
    }
}

/// Doubles the buffers that were too small, and prepares the end of the round to be repeated.
void GpuStrokePlacer::grow_buffers() {
    const auto enlarge = [&](std::uint32_t what, Buffer& buffer, std::uint32_t& room, std::size_t item) {
        if (counts_.full & what) double_room(device_, stream_, buffer, room, item);
    };
    enlarge(shared::k_full_strokes, strokes_, parameters_.stroke_room, sizeof(StrokeRecord));
    enlarge(shared::k_full_points, points_, parameters_.point_room, sizeof(FinePoint));
    enlarge(shared::k_full_lists, lists_, parameters_.list_room, sizeof(SeedQueueRecord));
    counts_.full = 0;
    counts_.candidate_groups[0] = counts_.held_groups;
    stream_.upload<PlacementCounts>(count_buffer_, std::span(&counts_, 1));
}

std::vector<FineStroke> GpuStrokePlacer::download() {
    std::vector<StrokeRecord> records(counts_.strokes);
    std::vector<FinePoint> points(counts_.points);
    stream_.download(strokes_, std::span(records));
    stream_.download(points_, std::span(points));
    stream_.finish();
    std::vector<FineStroke> strokes;
    strokes.reserve(records.size());
    for (const StrokeRecord& record : records) {
        const auto first = points.begin() + record.first;
        strokes.push_back({record.layer, {first, first + record.count}});
    }
    return strokes;
}

}  // namespace exemplar
