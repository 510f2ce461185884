#include "host/hatching/fields/ink.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "host/core/errors.h"
#include "host/core/parallel.h"

namespace exemplar {
namespace {

/// Rows of pixels that are drawn together.
constexpr int k_band = 16;
/// Samples per pixel along each axis. No two samples share a row or a column: so strokes along the axes are sampled
/// as finely as others.
constexpr int k_places = 4;
Vec2 place_of(int x, int y) {
    constexpr float k_part = 1.0f / k_places;
    return {(static_cast<float>(x) + (static_cast<float>(y) + 0.5f) * k_part) * k_part,
            (static_cast<float>(y) + (static_cast<float>(x) + 0.5f) * k_part) * k_part};
}

void check_stroke(const HatchStroke& stroke) {
    bool valid = stroke.points.size() == stroke.widths.size() && std::isfinite(stroke.darkness);
    for (const Vec2& point : stroke.points) valid &= point.allFinite();
    for (const float width : stroke.widths) valid &= std::isfinite(width);
    if (!valid) throw UsageError("a hatching stroke needs as many widths as points, all of them finite");
}

/// Pixels [begin, end) of an axis that are within [low, high].
struct Range {
    int begin, end;
    Range(float low, float high, int size)
        : begin(static_cast<int>(std::clamp(std::floor(low), 0.0f, static_cast<float>(size)))),
          end(static_cast<int>(std::clamp(std::floor(high) + 1, 0.0f, static_cast<float>(size)))) {}
};

/// A piece of a stroke's center line.
struct InkPiece {
    Vec2 from, way;
    float half_from, half_to;  ///< of its widths
    float inverse;             ///< of the squared length

    InkPiece(const HatchStroke& stroke, std::size_t i)
        : from(stroke.points[i]),
          way(stroke.points[i + 1] - from),
          half_from(stroke.widths[i] / 2),
          half_to(stroke.widths[i + 1] / 2),
          inverse(way.squaredNorm() > 0 ? 1 / way.squaredNorm() : 0) {}
    bool covers(const Vec2& at) const {
        const float t = std::clamp((at - from).dot(way) * inverse, 0.0f, 1.0f);
        const float half = half_from + t * (half_to - half_from);
        return (at - from - t * way).squaredNorm() < half * half;
    }
    Range along(int axis, int size) const {
        const float half = std::max(half_from, half_to), end = from[axis] + way[axis];
        return {std::min(from[axis], end) - half, std::max(from[axis], end) + half, size};
    }
};

/// A band of rows while strokes are drawn into it.
class Band {
  public:
    Band(int top, int width, int height)
        : top_(top), width_(width), height_(height), places_(k_per_pixel * static_cast<std::size_t>(width) * k_band) {
        for (int i = 0; i < k_per_pixel; ++i) offsets_[i] = place_of(i % k_places, i / k_places);
    }

    void draw(const HatchStroke& stroke, std::uint32_t name) {
        for (std::size_t i = 0; i + 1 < stroke.points.size(); ++i) {
            const InkPiece piece(stroke, i);
            const Range rows = piece.along(1, height_), columns = piece.along(0, width_);
            for (int y = std::max(rows.begin, top_); y < std::min(rows.end, top_ + k_band); ++y)
                for (int x = columns.begin; x < columns.end; ++x) draw(piece, x, y, 1 - stroke.darkness, name);
        }
    }

    void put(std::vector<float>& ink) const {
        for (int y = top_; y < std::min(top_ + k_band, height_); ++y)
            for (int x = 0; x < width_; ++x) {
                float light = 0;
                for (int i = 0; i < k_per_pixel; ++i) light += places_[first_of(x, y) + i].light;
                ink[static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x)] =
                    1 - light / k_per_pixel;
            }
    }

  private:
    static constexpr int k_per_pixel = k_places * k_places;
    struct Place {
        float light = 1;         ///< light that is left
        std::uint32_t name = 0;  ///< of the last stroke drawn over it
    };

    std::size_t first_of(int x, int y) const {
        return k_per_pixel *
               (static_cast<std::size_t>(y - top_) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x));
    }
    void draw(const InkPiece& piece, int x, int y, float lets_through, std::uint32_t name) {
        Place* const places = places_.data() + first_of(x, y);
        const Vec2 corner(static_cast<float>(x), static_cast<float>(y));
        for (int i = 0; i < k_per_pixel; ++i) {
            if (places[i].name == name || !piece.covers(corner + offsets_[i])) continue;
            places[i].light *= lets_through;
            places[i].name = name;
        }
    }

    int top_, width_, height_;
    std::array<Vec2, k_per_pixel> offsets_;
    std::vector<Place> places_;
};

/// Returns the strokes that overlap each band.
std::vector<std::vector<std::uint32_t>> strokes_by_band(std::span<const HatchStroke> strokes, int height) {
    std::vector<std::vector<std::uint32_t>> bands(static_cast<std::size_t>((height + k_band - 1) / k_band));
    for (std::size_t i = 0; i < strokes.size(); ++i) {
        check_stroke(strokes[i]);
        if (strokes[i].points.size() < 2) continue;
        const auto by_y = [](const Vec2& a, const Vec2& b) { return a.y() < b.y(); };
        const auto [low, high] = std::ranges::minmax_element(strokes[i].points, by_y);
        const float half = *std::ranges::max_element(strokes[i].widths) / 2;
        const Range rows(low->y() - half, high->y() + half, height);
        for (int band = rows.begin / k_band; band * k_band < rows.end; ++band)
            bands[static_cast<std::size_t>(band)].push_back(static_cast<std::uint32_t>(i));
    }
    return bands;
}

}  // namespace

std::vector<float> render_ink(std::span<const HatchStroke> strokes, int width, int height) {
    std::vector<float> ink(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
    const auto bands = strokes_by_band(strokes, height);
    parallel_for(bands.size(), [&](std::size_t i) {
        if (bands[i].empty()) return;
        Band band(static_cast<int>(i) * k_band, width, height);
        for (const std::uint32_t stroke : bands[i]) band.draw(strokes[stroke], stroke + 1);
        band.put(ink);
    });
    return ink;
}

Image ink_picture(std::span<const float> ink, int width, int height) {
    Image image(width, height, 1);
    for (std::size_t i = 0; i < ink.size(); ++i)
        image.data[i] = static_cast<std::uint8_t>(std::lround(255 * (1 - ink[i])));
    return image;
}

std::vector<float> target_tone(const HatchingFields& fields) {
    std::vector<float> tone(fields.size());
    for (std::size_t i = 0; i < tone.size(); ++i) {
        if (fields.level[i] == k_no_hatching) continue;
        const float covered = fields.thickness[i] < fields.spacing[i] ? fields.thickness[i] / fields.spacing[i] : 1;
        const float one = covered * fields.intensity[i];
        tone[i] = fields.level[i] == k_cross_hatching ? 1 - (1 - one) * (1 - one) : one;
    }
    return tone;
}

WindowMeans::WindowMeans(std::span<const float> values, int width, int height)
    : width_(width),
      height_(height),
      sums_((static_cast<std::size_t>(width) + 1) * (static_cast<std::size_t>(height) + 1)) {
    const auto stride = static_cast<std::size_t>(width) + 1;
    for (std::size_t y = 0; y < static_cast<std::size_t>(height); ++y) {
        double row = 0;
        for (std::size_t x = 0; x + 1 < stride; ++x) {
            row += static_cast<double>(values[y * (stride - 1) + x]);
            sums_[(y + 1) * stride + x + 1] = sums_[y * stride + x + 1] + row;
        }
    }
}

double WindowMeans::mean(int x, int y, int reach) const {
    const auto left = static_cast<std::size_t>(std::max(x - reach, 0));
    const auto right = static_cast<std::size_t>(std::min(x + reach + 1, width_));
    const auto top = static_cast<std::size_t>(std::max(y - reach, 0));
    const auto bottom = static_cast<std::size_t>(std::min(y + reach + 1, height_));
    const auto stride = static_cast<std::size_t>(width_) + 1;
    const double sum = sums_[bottom * stride + right] - sums_[bottom * stride + left] - sums_[top * stride + right] +
                       sums_[top * stride + left];
    return sum / static_cast<double>((right - left) * (bottom - top));
}

}  // namespace exemplar
