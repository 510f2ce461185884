#include "host/hatching/tracing/skeleton_graph.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

#include "host/hatching/tracing/thinning.h"

namespace exemplar {
namespace {

constexpr int k_bend_reach = 5;                              ///< reach of the bend's angle, pixels to both sides
constexpr float k_bend = std::numbers::pi_v<float> * 0.37f;  ///< max turn, radians: that of a circle of radius 4
constexpr float k_spur = 1;                                  ///< max length of a spur in widths, plus a pixel
constexpr int k_prunings = 3;
constexpr int k_line = -1, k_outside = -2;  ///< labels of pixels outside of junctions

/// Labels the pixels of each junction (connected pixels of three or more neighbors) with its number.
class Junctions {
  public:
    explicit Junctions(const PixelMask& skeleton) : label_(skeleton.width, skeleton.height, 1, k_outside) {
        PixelMask crowded(skeleton.width, skeleton.height, 1);
        for (int y = 0; y < skeleton.height; ++y)
            for (int x = 0; x < skeleton.width; ++x) {
                if (!skeleton.pixel(x, y)[0]) continue;
                label_.pixel(x, y)[0] = k_line;
                const std::array<bool, 8> n = ring_neighbors(skeleton, x, y);
                crowded.pixel(x, y)[0] = std::count(n.begin(), n.end(), true) >= 3;
            }
        for (int y = 0; y < skeleton.height; ++y)
            for (int x = 0; x < skeleton.width; ++x)
                if (crowded.pixel(x, y)[0] && label_.pixel(x, y)[0] == k_line) flood(crowded, {x, y});
    }

    int at(int x, int y) const {
        return x < 0 || y < 0 || x >= label_.width || y >= label_.height ? k_outside : label_.pixel(x, y)[0];
    }
    const std::vector<Vec2>& centers() const { return centers_; }

  private:
    void flood(const PixelMask& crowded, const Pixel& start) {
        const int number = static_cast<int>(centers_.size());
        std::vector<Pixel> found{start};
        label_.pixel(start[0], start[1])[0] = number;
        for (std::size_t i = 0; i < found.size(); ++i)
            for (const auto& [dx, dy] : k_neighbor_offsets) {
                const int x = found[i][0] + dx, y = found[i][1] + dy;
                if (at(x, y) != k_line || !crowded.pixel(x, y)[0]) continue;
                label_.pixel(x, y)[0] = number;
                found.push_back({x, y});
            }
        Vec2 sum = Vec2::Zero();
        for (const Pixel& pixel : found) sum += center_of(pixel);
        centers_.emplace_back(sum / static_cast<float>(found.size()));
    }

    BasicImage<int> label_;
    std::vector<Vec2> centers_;
};

/// Walks along the lines between junctions, each once.
class Walker {
  public:
    Walker(const PixelMask& skeleton, const Junctions& junctions)
        : junctions_(junctions), width_(skeleton.width), height_(skeleton.height), walked_(width_, height_, 1) {}

    std::vector<SkeletonSegment> all_segments() {
        std::vector<SkeletonSegment> segments;
        for (const bool closed : {false, true})
            for (int y = 0; y < height_; ++y)
                for (int x = 0; x < width_; ++x)
                    if (junctions_.at(x, y) == k_line && !walked_.pixel(x, y)[0] &&
                        (closed || on_line(x, y).size() <= 1))
                        segments.push_back(walk({x, y}, closed));
        return segments;
    }

  private:
    std::vector<Pixel> on_line(int x, int y) const {
        std::vector<Pixel> found;
        for (const auto& [dx, dy] : k_neighbor_offsets)
            if (junctions_.at(x + dx, y + dy) == k_line) found.push_back({x + dx, y + dy});
        return found;
    }

    /// The junctions beside a pixel, each once.
    std::vector<int> junctions_beside(const Pixel& pixel) const {
        std::vector<int> found;
        for (const auto& [dx, dy] : k_neighbor_offsets) {
            const int label = junctions_.at(pixel[0] + dx, pixel[1] + dy);
            if (label >= 0 && std::find(found.begin(), found.end(), label) == found.end()) found.push_back(label);
        }
        return found;
    }

    SkeletonSegment walk(Pixel pixel, bool closed) {
        SkeletonSegment segment;
        segment.closed = closed;
        for (bool more = true; more;) {
            walked_.pixel(pixel[0], pixel[1])[0] = 1;
            segment.pixels.push_back(pixel);
            more = false;
            for (const Pixel& next : on_line(pixel[0], pixel[1]))
                if (!walked_.pixel(next[0], next[1])[0] && !more) pixel = next, more = true;
        }
        const std::vector<int> front = junctions_beside(segment.pixels.front());
        const std::vector<int> back = junctions_beside(segment.pixels.back());
        if (!front.empty()) segment.junction[0] = front.front();
        if (segment.pixels.size() > 1 && !back.empty()) segment.junction[1] = back.front();
        if (segment.pixels.size() == 1 && front.size() > 1) segment.junction[1] = front.back();
        return segment;
    }

    const Junctions& junctions_;
    int width_, height_;
    PixelMask walked_;
};

/// Returns the angle by which the line turns at pixel i, radians; zero where it is too near to an end to tell.
float turn_at(const std::vector<Pixel>& pixels, std::size_t i) {
    if (i < k_bend_reach || i + k_bend_reach >= pixels.size()) return 0;
    const Vec2 here = center_of(pixels[i]);
    const Vec2 in = here - center_of(pixels[i - k_bend_reach]), out = center_of(pixels[i + k_bend_reach]) - here;
    return std::abs(std::atan2(in.x() * out.y() - in.y() * out.x(), in.dot(out)));
}

/// Cuts a segment at its sharpest bend if that is too sharp for a stroke; cuts the pieces likewise.
void cut_at_bends(const SkeletonSegment& segment, std::vector<SkeletonSegment>& out) {
    std::size_t sharpest = 0;
    float turn = k_bend;
    for (std::size_t i = 0; i < segment.pixels.size(); ++i)
        if (const float here = turn_at(segment.pixels, i); here > turn) turn = here, sharpest = i;
    if (sharpest == 0) {
        out.push_back(segment);
        return;
    }
    const auto at = segment.pixels.begin() + static_cast<std::ptrdiff_t>(sharpest);
    cut_at_bends({{segment.pixels.begin(), at}, {segment.junction[0], k_no_junction}, false}, out);
    cut_at_bends({{at, segment.pixels.end()}, {k_no_junction, segment.junction[1]}, false}, out);
}

std::vector<SkeletonSegment> segments_of(const PixelMask& skeleton, const Junctions& junctions) {
    return Walker(skeleton, junctions).all_segments();
}

}  // namespace

SkeletonGraph skeleton_graph(const PixelMask& skeleton) {
    const Junctions junctions(skeleton);
    SkeletonGraph graph;
    for (const SkeletonSegment& segment : segments_of(skeleton, junctions)) cut_at_bends(segment, graph.segments);
    graph.junctions = junctions.centers();
    return graph;
}

void prune_spurs(PixelMask& skeleton, const FloatImage& width) {
    for (int round = 0; round < k_prunings; ++round) {
        bool pruned = false;
        for (const SkeletonSegment& segment : segments_of(skeleton, Junctions(skeleton))) {
            if ((segment.junction[0] == k_no_junction) == (segment.junction[1] == k_no_junction)) continue;
            const Pixel& root = segment.junction[0] == k_no_junction ? segment.pixels.back() : segment.pixels.front();
            const float longest = k_spur * width.pixel(root[0], root[1])[0] + 1;
            if (static_cast<float>(segment.pixels.size()) > longest) continue;
            for (const Pixel& pixel : segment.pixels) skeleton.pixel(pixel[0], pixel[1])[0] = 0;
            pruned = true;
        }
        if (!pruned) return;
        remove_stair_corners(skeleton);
    }
}

}  // namespace exemplar
