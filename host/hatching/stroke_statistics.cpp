#include "host/hatching/stroke_statistics.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "host/core/errors.h"
#include "host/core/parallel.h"
#include "host/hatching/ink.h"

namespace exemplar {
namespace {

constexpr float k_far = std::numeric_limits<float>::max();
constexpr float k_widest_gap = 3;  // spacings
constexpr float k_cell = 8;        // pixels

double median(std::vector<double>& values) {
    if (values.empty()) return 0;
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::ranges::nth_element(values, middle);
    return *middle;
}

/// A piece of a center line, from a point of a stroke to the next.
struct Piece {
    std::uint32_t stroke, point;
};

/// The pieces of the strokes of a layer, by square cells of the picture.
class PieceCells {
  public:
    PieceCells(std::span<const HatchStroke> strokes, std::size_t layer, int width, int height)
        : strokes_(strokes), columns_(cells(width)), rows_(cells(height)) {
        pieces_.resize(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_));
        for (std::size_t i = 0; i < strokes.size(); ++i)
            for (std::size_t j = 0; strokes[i].layer == layer && j + 1 < strokes[i].points.size(); ++j)
                put({static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(j)});
    }

    /// How far a ray goes to the first stroke but its own; k_far if that is farther than `most`.
    float hit(const Vec2& from, const Vec2& way, std::uint32_t own, float most) const {
        float nearest = k_far;
        // A step less than a cell, as pieces are in all cells that are so near.
        for (float reached = 0; reached < most + k_step && nearest > reached; reached += k_step)
            for_pieces(from + reached * way, [&](const Piece& piece) {
                if (piece.stroke != own) nearest = std::min(nearest, crossing(from, way, piece));
            });
        return nearest <= most ? nearest : k_far;
    }

    /// How near strokes but its own come to a point; k_far if no nearer than `most`.
    float distance(const Vec2& at, std::uint32_t own, float most) const {
        float nearest = most;
        for (float y = at.y() - most; y < at.y() + most + k_step; y += k_step)
            for (float x = at.x() - most; x < at.x() + most + k_step; x += k_step)
                for_pieces(Vec2(x, y), [&](const Piece& piece) {
                    if (piece.stroke != own) nearest = std::min(nearest, distance(at, piece));
                });
        return nearest < most ? nearest : k_far;
    }

  private:
    static constexpr float k_step = 4;  // pixels
    static int cells(int pixels) { return static_cast<int>(static_cast<float>(pixels) / k_cell) + 1; }
    static int cell(float at, int count) {
        return static_cast<int>(std::clamp(std::floor(at / k_cell), 0.0f, static_cast<float>(count - 1)));
    }

    void put(const Piece& piece) {
        const Vec2 &a = strokes_[piece.stroke].points[piece.point], &b = strokes_[piece.stroke].points[piece.point + 1];
        const Vec2 low = a.cwiseMin(b).array() - k_step, high = a.cwiseMax(b).array() + k_step;
        for (int y = cell(low.y(), rows_); y <= cell(high.y(), rows_); ++y)
            for (int x = cell(low.x(), columns_); x <= cell(high.x(), columns_); ++x)
                pieces_[static_cast<std::size_t>(y) * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(x)]
                    .push_back(piece);
    }
    template <typename Body>
    void for_pieces(const Vec2& at, Body&& body) const {
        const auto row = static_cast<std::size_t>(cell(at.y(), rows_)),
                   column = static_cast<std::size_t>(cell(at.x(), columns_));
        for (const Piece& piece : pieces_[row * static_cast<std::size_t>(columns_) + column]) body(piece);
    }
    float crossing(const Vec2& from, const Vec2& way, const Piece& piece) const {
        const Vec2& a = strokes_[piece.stroke].points[piece.point];
        const Vec2 on = strokes_[piece.stroke].points[piece.point + 1] - a, to = a - from;
        const float slope = way.x() * on.y() - way.y() * on.x();
        if (slope == 0) return k_far;
        const float t = (to.x() * on.y() - to.y() * on.x()) / slope, u = (to.x() * way.y() - to.y() * way.x()) / slope;
        return t > 0 && u >= 0 && u <= 1 ? t : k_far;
    }
    float distance(const Vec2& at, const Piece& piece) const {
        const Vec2& a = strokes_[piece.stroke].points[piece.point];
        const Vec2 on = strokes_[piece.stroke].points[piece.point + 1] - a;
        const float squared = on.squaredNorm(),
                    t = squared > 0 ? std::clamp((at - a).dot(on) / squared, 0.0f, 1.0f) : 0;
        return (at - a - t * on).norm();
    }

    std::span<const HatchStroke> strokes_;
    int columns_, rows_;
    std::vector<std::vector<Piece>> pieces_;
};

/// What the gaps beside one stroke are.
struct StrokeGaps {
    std::vector<double> ratios;
    double least = 1;
};

class GapMeter {
  public:
    GapMeter(std::span<const HatchStroke> strokes, const HatchingFields& fields)
        : strokes_(strokes),
          fields_(fields),
          cells_{PieceCells(strokes, 0, fields.width, fields.height),
                 PieceCells(strokes, 1, fields.width, fields.height)} {}

    StrokeGaps measure(std::uint32_t index) const {
        StrokeGaps gaps;
        const HatchStroke& stroke = strokes_[index];
        for (std::size_t i = 0; i < stroke.points.size(); ++i) {
            const Vec2& at = stroke.points[i];
            if (!is_hatched(at, stroke.layer)) continue;
            const float spacing = spacing_at(at);
            const float nearest = cells_[stroke.layer].distance(at, index, spacing);
            gaps.least = std::min(gaps.least, static_cast<double>(nearest / spacing));
            const Vec2 way = stroke.points[std::min(i + 1, stroke.points.size() - 1)] - stroke.points[i ? i - 1 : 0];
            if (way.norm() == 0) continue;
            const Vec2 across(-way.y() / way.norm(), way.x() / way.norm());
            for (const Vec2& side : {across, Vec2(-across)}) {
                const float gap = cells_[stroke.layer].hit(at, side, index, k_widest_gap * spacing);
                if (gap != k_far && stays_hatched(at, side, gap, stroke.layer))
                    gaps.ratios.push_back(static_cast<double>(gap / spacing));
            }
        }
        return gaps;
    }

  private:
    bool is_hatched(const Vec2& at, std::size_t layer) const {
        const int x = static_cast<int>(std::floor(at.x())), y = static_cast<int>(std::floor(at.y()));
        return x >= 0 && y >= 0 && x < fields_.width && y < fields_.height &&
               fields_.level[fields_.index(x, y)] > layer;
    }
    float spacing_at(const Vec2& at) const {
        return std::max(1.0f, fields_.spacing[fields_.index(static_cast<int>(at.x()), static_cast<int>(at.y()))]);
    }
    bool stays_hatched(const Vec2& from, const Vec2& way, float distance, std::size_t layer) const {
        for (float t = 0; t < distance; ++t)
            if (!is_hatched(from + t * way, layer)) return false;
        return true;
    }

    std::span<const HatchStroke> strokes_;
    const HatchingFields& fields_;
    std::array<PieceCells, k_hatch_layers> cells_;
};

}  // namespace

SpacingMeasure measure_spacing(std::span<const HatchStroke> strokes, const HatchingFields& fields) {
    for (const HatchStroke& stroke : strokes)
        if (stroke.layer >= k_hatch_layers)
            throw UsageError(fmt::format("a stroke is of layer {}; there are 0 and 1", stroke.layer));
    const GapMeter meter(strokes, fields);
    std::vector<StrokeGaps> gaps(strokes.size());
    parallel_for(
        strokes.size(), [&](std::size_t i) { gaps[i] = meter.measure(static_cast<std::uint32_t>(i)); }, 16);

    SpacingMeasure result{.least_ratio = 1};
    std::vector<double> errors;
    for (const StrokeGaps& own : gaps) {
        result.least_ratio = std::min(result.least_ratio, own.least);
        for (const double ratio : own.ratios) {
            errors.push_back(std::abs(ratio - 1));
            result.mean_ratio += ratio;
        }
    }
    result.gaps = errors.size();
    if (result.gaps) result.mean_ratio /= static_cast<double>(result.gaps);
    result.median_error = median(errors);
    return result;
}

int tone_reach(float spacing) {
    return static_cast<int>(std::clamp(std::round(1.5f * spacing), 1.0f, 1e6f));
}

ToneMeasure measure_tone(std::span<const HatchStroke> strokes, const HatchingFields& fields) {
    const std::vector<float> ink = drawn_ink(strokes, fields.width, fields.height), target = target_tone(fields);
    const WindowMeans inks(ink, fields.width, fields.height), targets(target, fields.width, fields.height);
    std::vector<double> errors;
    for (int y = 0; y < fields.height; ++y)
        for (int x = 0; x < fields.width; ++x) {
            const std::size_t i = fields.index(x, y);
            if (target[i] == 0) continue;
            const int reach = tone_reach(fields.spacing[i]);
            errors.push_back(std::abs(inks.mean(x, y, reach) / targets.mean(x, y, reach) - 1));
        }
    ToneMeasure result{.pixels = errors.size(), .median_error = median(errors), .mean_ratio = 0};
    double drawn = 0, wanted = 0;
    for (std::size_t i = 0; i < ink.size(); ++i) {
        drawn += static_cast<double>(ink[i]);
        wanted += static_cast<double>(target[i]);
    }
    if (wanted > 0) result.mean_ratio = drawn / wanted;
    return result;
}

}  // namespace exemplar
