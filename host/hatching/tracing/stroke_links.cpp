#include "host/hatching/tracing/stroke_links.h"

#include "host/core/statistics.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <optional>

namespace exemplar {
namespace {

constexpr float k_max_turn = 0.6f;              ///< max turn of a link, radians: an arc of radius 20 over a crossing
constexpr float k_direction_reach = 6;          ///< min length over which a direction is measured, pixels
constexpr std::size_t k_min_segment_reach = 4;  ///< pixels; shorter segments take the direction between their junctions
constexpr float k_pixel_error = 1;              ///< error of an end of a short segment across it, pixels
constexpr float k_max_slack = 0.35f;            ///< radians
constexpr float k_ink_step = 0.5f;              ///< pixels between samples of a gap

float angle_between(const Vec2& a, const Vec2& b) {
    return std::abs(std::atan2(a.x() * b.y() - a.y() * b.x(), a.dot(b)));
}

float median_segment_width(const SkeletonSegment& segment, const FloatImage& width) {
    std::vector<float> values;
    for (const auto& [x, y] : segment.pixels) values.push_back(width.pixel(x, y)[0]);
    return upper_median(values);
}

/// Returns the end at the front (side 0) or back (side 1) of a segment.
SkeletonEnd skeleton_end(const SkeletonGraph& graph, const SkeletonSegment& segment, std::size_t side, float width) {
    const std::size_t last = segment.pixels.size() - 1;
    const auto at = [&](std::size_t i) { return center_of(segment.pixels[side == 0 ? i : last - i]); };
    SkeletonEnd end;
    end.width = width;
    end.junction = segment.junction[side];
    const float bent = end.junction == k_no_junction ? 1 : 0.5f * width + 1;
    end.trim = std::min(static_cast<std::size_t>(std::lround(bent)), last / 2);
    end.position = at(end.trim);
    const auto wanted = static_cast<std::size_t>(std::lround(std::max(k_direction_reach, 2 * width)));
    const std::size_t reach = std::min(last, end.trim + wanted);
    Vec2 way = end.position - at(reach);
    if (reach - end.trim < k_min_segment_reach) {
        const int far = segment.junction[1 - side];
        way = (end.junction == k_no_junction ? at(0) : graph.junctions[end.junction]) -
              (far == k_no_junction ? at(last) : graph.junctions[far]);
    }
    const float length = way.norm();
    if (length > 0) end.direction = way / length, end.slack = std::min(k_max_slack, k_pixel_error / length);
    return end;
}

/// Returns by how much a stroke that continues from one end to the other bends: radians, summed over both bends.
/// Returns nothing if it bends too much.
std::optional<float> bend_between(const SkeletonEnd& a, const SkeletonEnd& b) {
    if (a.direction.isZero() || b.direction.isZero()) return std::nullopt;
    const float turn = angle_between(a.direction, -b.direction);
    if (turn > k_max_turn + a.slack + b.slack) return std::nullopt;
    const Vec2 gap = b.position - a.position;
    if (gap.norm() < 2) return 2 * turn;
    const float first = angle_between(a.direction, gap), second = angle_between(b.direction, -gap);
    if (first > k_max_turn + a.slack || second > k_max_turn + b.slack) return std::nullopt;
    return turn + first + second;
}

class Linker {
  public:
    Linker(const SkeletonGraph& graph, const FloatImage& width, const FloatImage& darkness, float min_darkness)
        : graph_(graph),
          width_(width),
          darkness_(darkness),
          faintest_(min_darkness),
          at_junction_(graph.junctions.size()) {
        for (const SkeletonSegment& segment : graph.segments) {
            const float own = median_segment_width(segment, width);
            for (const std::size_t side : {0u, 1u}) {
                links_.ends.push_back(skeleton_end(graph, segment, side, own));
                if (links_.ends.back().junction != k_no_junction)
                    at_junction_[links_.ends.back().junction].push_back(links_.ends.size() - 1);
            }
        }
        links_.partner.assign(links_.ends.size(), k_unlinked);
        links_.shared.assign(graph.segments.size(), false);
    }

    SegmentLinks run() {
        link_along_shared_segments();
        for (const std::vector<std::size_t>& ends : at_junction_) link_best(pairs_among(ends));
        link_best(pairs_across_ink());
        return std::move(links_);
    }

  private:
    struct Pair {
        float bend;
        std::size_t first, second;
        bool operator<(const Pair& o) const {
            return std::tie(bend, first, second) < std::tie(o.bend, o.first, o.second);
        }
    };

    bool free(std::size_t end) const { return links_.partner[end] == k_unlinked && !links_.shared[end / 2]; }
    void link(std::size_t a, std::size_t b) { links_.partner[a] = b, links_.partner[b] = a; }

    /// Links the straightest pairs first.
    void link_best(std::vector<Pair> pairs) {
        std::sort(pairs.begin(), pairs.end());
        for (const Pair& pair : pairs)
            if (free(pair.first) && free(pair.second)) link(pair.first, pair.second);
    }

    std::vector<Pair> pairs_among(const std::vector<std::size_t>& ends) const {
        std::vector<Pair> pairs;
        for (std::size_t i = 0; i < ends.size(); ++i)
            for (std::size_t k = i + 1; k < ends.size(); ++k)
                if (const auto bend = bend_between(links_.ends[ends[i]], links_.ends[ends[k]]))
                    pairs.push_back({*bend, ends[i], ends[k]});
        return pairs;
    }

    /// Links the strokes along shared segments: where two strokes cross at a small angle, or are wide, the skeleton
    /// has two junctions of three lines, joined by one line, in place of one junction of four.
    void link_along_shared_segments() {
        std::vector<std::size_t> order(graph_.segments.size());
        std::iota(order.begin(), order.end(), 0);
        std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
            return graph_.segments[a].pixels.size() < graph_.segments[b].pixels.size();
        });
        for (const std::size_t s : order) link_along(s);
    }

    /// Returns the two other ends at an end's junction; nothing unless there are exactly two and both are free.
    std::optional<std::array<std::size_t, 2>> others_at(std::size_t end) const {
        if (links_.ends[end].junction == k_no_junction) return std::nullopt;
        std::vector<std::size_t> others = at_junction_[links_.ends[end].junction];
        std::erase(others, end);
        if (others.size() != 2 || !free(others[0]) || !free(others[1])) return std::nullopt;
        return std::array{others[0], others[1]};
    }

    void link_along(std::size_t segment) {
        const std::size_t front = 2 * segment, back = front + 1;
        if (!free(front) || !free(back) || links_.ends[front].junction == links_.ends[back].junction) return;
        const auto in = others_at(front), out = others_at(back);
        if (!in || !out) return;
        const std::vector<SkeletonEnd>& ends = links_.ends;
        const float widths =
            ends[(*in)[0]].width + ends[(*in)[1]].width + ends[(*out)[0]].width + ends[(*out)[1]].width;
        if (static_cast<float>(graph_.segments[segment].pixels.size()) > widths + 2) return;
        float best = std::numeric_limits<float>::max();
        std::size_t straight = 2;
        for (const std::size_t swap : {0u, 1u}) {
            const auto first = bend_between(ends[(*in)[0]], ends[(*out)[swap]]);
            const auto second = bend_between(ends[(*in)[1]], ends[(*out)[1 - swap]]);
            if (first && second && std::max(*first, *second) < best) best = std::max(*first, *second), straight = swap;
        }
        if (straight == 2) return;
        link((*in)[0], (*out)[straight]);
        link((*in)[1], (*out)[1 - straight]);
        links_.shared[segment] = true;
    }

    /// Whether there is ink all the way between two places, wide enough for their distance (see reach_over).
    bool ink_between(const Vec2& a, const Vec2& b) const {
        float widest = 0;
        const int steps = std::max(1, static_cast<int>(std::ceil((b - a).norm() / k_ink_step)));
        for (int k = 0; k <= steps; ++k) {
            const Vec2 p = a + (b - a) * (static_cast<float>(k) / static_cast<float>(steps));
            const int x = std::clamp(static_cast<int>(p.x()), 0, darkness_.width - 1);
            const int y = std::clamp(static_cast<int>(p.y()), 0, darkness_.height - 1);
            if (darkness_.pixel(x, y)[0] < faintest_) return false;
            widest = std::max(widest, width_.pixel(x, y)[0]);
        }
        return (b - a).norm() <= reach_over(widest);
    }

    /// Returns the pairs of free ends that are near each other, with ink all the way between.
    std::vector<Pair> pairs_across_ink() const {
        std::multimap<float, std::size_t> by_x;
        for (std::size_t e = 0; e < links_.ends.size(); ++e)
            if (free(e) && !graph_.segments[e / 2].closed) by_x.emplace(links_.ends[e].position.x(), e);
        const float reach = reach_over(*std::max_element(width_.data.begin(), width_.data.end()));
        std::vector<Pair> pairs;
        for (auto a = by_x.begin(); a != by_x.end(); ++a)
            for (auto b = std::next(a); b != by_x.end() && b->first - a->first <= reach; ++b) {
                const SkeletonEnd &first = links_.ends[a->second], &second = links_.ends[b->second];
                if (a->second / 2 == b->second / 2 || (first.position - second.position).norm() > reach) continue;
                const auto bend = bend_between(first, second);
                if (bend && ink_between(first.position, second.position))
                    pairs.push_back({*bend, std::min(a->second, b->second), std::max(a->second, b->second)});
            }
        return pairs;
    }

    /// Max distance of two ends across a stroke of some width, pixels.
    static float reach_over(float width) { return 2.5f * width + 8; }

    const SkeletonGraph& graph_;
    const FloatImage& width_;
    const FloatImage& darkness_;
    float faintest_;
    std::vector<std::vector<std::size_t>> at_junction_;
    SegmentLinks links_;
};

}  // namespace

SegmentLinks link_segments(const SkeletonGraph& graph, const FloatImage& width, const FloatImage& darkness,
                           float min_darkness) {
    return Linker(graph, width, darkness, min_darkness).run();
}

}  // namespace exemplar
