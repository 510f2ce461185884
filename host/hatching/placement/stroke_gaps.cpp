#include "host/hatching/placement/stroke_gaps.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "host/core/errors.h"
#include "host/hatching/placement/placement_grid.h"

namespace exemplar {
namespace {

constexpr float k_widest_gap = 3;  // spacings
constexpr float k_gap_cell = 8;    // pixels

/// A piece of a center line, from a point of a stroke to the next.
struct GapPiece {
    std::uint32_t stroke, point;
};

}  // namespace

/// The pieces of a layer's strokes in square cells of the picture.
class PieceCells {
  public:
    PieceCells(std::span<const HatchStroke> strokes, std::size_t layer, int width, int height)
        : strokes_(strokes), columns_(cells(width)), rows_(cells(height)) {
        pieces_.resize(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_));
        for (std::size_t i = 0; i < strokes.size(); ++i)
            for (std::size_t j = 0; strokes[i].layer == layer && j + 1 < strokes[i].points.size(); ++j)
                put({static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(j)});
    }

    /// Returns the distance along a ray to the first stroke other than `own`; StrokeGaps::k_invalid_index if it is over
    /// `most`.
    float hit(const Vec2& from, const Vec2& way, std::uint32_t own, float most) const {
        float nearest = StrokeGaps::k_invalid_index;
        // Steps are shorter than a cell, and pieces are in all cells within one step of them, so none is missed.
        for (float reached = 0; reached < most + k_step && nearest > reached; reached += k_step)
            for_pieces(from + reached * way, [&](const GapPiece& piece) {
                if (piece.stroke != own) nearest = std::min(nearest, crossing(from, way, piece));
            });
        return nearest <= most ? nearest : StrokeGaps::k_invalid_index;
    }

    /// Returns the distance of a point to strokes other than `own`; StrokeGaps::k_invalid_index if it is not below
    /// `most`.
    float distance(const Vec2& at, std::uint32_t own, float most) const {
        float nearest = most;
        for (float y = at.y() - most; y < at.y() + most + k_step; y += k_step)
            for (float x = at.x() - most; x < at.x() + most + k_step; x += k_step)
                for_pieces(Vec2(x, y), [&](const GapPiece& piece) {
                    if (piece.stroke != own) nearest = std::min(nearest, distance(at, piece));
                });
        return nearest < most ? nearest : StrokeGaps::k_invalid_index;
    }

  private:
    static constexpr float k_step = 4;  // pixels
    static int cells(int pixels) { return static_cast<int>(static_cast<float>(pixels) / k_gap_cell) + 1; }
    static int cell(float at, int count) {
        return static_cast<int>(std::clamp(std::floor(at / k_gap_cell), 0.0f, static_cast<float>(count - 1)));
    }

    void put(const GapPiece& piece) {
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
        for (const GapPiece& piece : pieces_[row * static_cast<std::size_t>(columns_) + column]) body(piece);
    }
    float crossing(const Vec2& from, const Vec2& way, const GapPiece& piece) const {
        const Vec2& a = strokes_[piece.stroke].points[piece.point];
        const Vec2 on = strokes_[piece.stroke].points[piece.point + 1] - a, to = a - from;
        const float slope = way.x() * on.y() - way.y() * on.x();
        if (slope == 0) return StrokeGaps::k_invalid_index;
        const float t = (to.x() * on.y() - to.y() * on.x()) / slope, u = (to.x() * way.y() - to.y() * way.x()) / slope;
        return t > 0 && u >= 0 && u <= 1 ? t : StrokeGaps::k_invalid_index;
    }
    float distance(const Vec2& at, const GapPiece& piece) const {
        const Vec2& a = strokes_[piece.stroke].points[piece.point];
        const Vec2 on = strokes_[piece.stroke].points[piece.point + 1] - a;
        const float squared = on.squaredNorm(),
                    t = squared > 0 ? std::clamp((at - a).dot(on) / squared, 0.0f, 1.0f) : 0;
        return (at - a - t * on).norm();
    }

    std::span<const HatchStroke> strokes_;
    int columns_, rows_;
    std::vector<std::vector<GapPiece>> pieces_;
};

StrokeGaps::StrokeGaps(std::span<const HatchStroke> strokes, const HatchingFields& fields)
    : strokes_(strokes), fields_(fields) {
    for (const HatchStroke& stroke : strokes)
        if (stroke.layer >= k_hatch_layers)
            throw UsageError(fmt::format("a stroke is of layer {}; there are 0 and 1", stroke.layer));
    for (std::size_t layer = 0; layer < k_hatch_layers; ++layer)
        cells_[layer] = std::make_unique<PieceCells>(strokes, layer, fields.width, fields.height);
}

StrokeGaps::~StrokeGaps() = default;

std::vector<StrokeGaps::Gaps> StrokeGaps::beside(std::uint32_t index) const {
    const HatchStroke& stroke = strokes_[index];
    std::vector<Gaps> all(stroke.points.size());
    for (std::size_t i = 0; i < all.size(); ++i) {
        const Vec2& at = stroke.points[i];
        const Vec2 way = stroke.points[std::min(i + 1, all.size() - 1)] - stroke.points[i ? i - 1 : 0];
        if (way.norm() == 0 || !is_hatched(at, stroke.layer)) continue;
        Gaps& gaps = all[i];
        gaps.across = Vec2(-way.y(), way.x()) / way.norm();
        gaps.spacing = spacing_at(at);
        for (std::size_t side = 0; side < 2; ++side) {
            const Vec2 to = side ? Vec2(-gaps.across) : gaps.across;
            const float gap = cells_[stroke.layer]->hit(at, to, index, k_widest_gap * gaps.spacing);
            if (gap != k_invalid_index && stays_hatched(at, to, gap, stroke.layer))
                gaps.ratio[side] = gap / gaps.spacing;
        }
    }
    return all;
}

float StrokeGaps::least(std::uint32_t index) const {
    const HatchStroke& stroke = strokes_[index];
    float least = 1;
    for (const Vec2& at : stroke.points) {
        if (!is_hatched(at, stroke.layer)) continue;
        const float spacing = spacing_at(at);
        least = std::min(least, cells_[stroke.layer]->distance(at, index, spacing) / spacing);
    }
    return least;
}

bool StrokeGaps::is_hatched(const Vec2& at, std::size_t layer) const {
    const int x = static_cast<int>(std::floor(at.x())), y = static_cast<int>(std::floor(at.y()));
    return x >= 0 && y >= 0 && x < fields_.width && y < fields_.height && fields_.level[fields_.index(x, y)] > layer;
}

float StrokeGaps::spacing_at(const Vec2& at) const {
    const float spacing = fields_.spacing[fields_.index(static_cast<int>(at.x()), static_cast<int>(at.y()))];
    return std::clamp(spacing, 1.0f, k_max_spacing);  // the range that placement uses
}

bool StrokeGaps::stays_hatched(const Vec2& from, const Vec2& way, float distance, std::size_t layer) const {
    for (float t = 0; t < distance; ++t)
        if (!is_hatched(from + t * way, layer)) return false;
    return true;
}

}  // namespace exemplar
