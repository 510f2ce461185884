#include "host/hatching/drawing/sheet_marks.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "host/core/parallel.h"
#include "host/hatching/drawing/drawing_input.h"
#include "host/hatching/drawing/drawing_sheet.h"
#include "host/hatching/drawing/drawing_warp.h"
#include "host/hatching/tracing/drawing_filters.h"
#include "host/hatching/tracing/ink_mask.h"

namespace exemplar {
namespace {

using Eigen::Vector2d;

constexpr float k_search_side = 1600;     ///< longer side of the picture in which marks are searched, pixels
constexpr float k_mark_contrast = 0.72f;  ///< max gray of a mark relative to its surroundings
constexpr double k_ring_share = 1 - (k_mark_hole * k_mark_hole) / (k_mark_radius * k_mark_radius);
constexpr double k_dot_share = (k_mark_dot * k_mark_dot) / (k_mark_radius * k_mark_radius);
constexpr double k_quarter_disc = 0.7853981633974483;  ///< pi / 4: of an ellipse in its bounding box

/// A connected piece of dark pixels.
struct DarkPiece {
    int left = 0, right = 0, top = 0, bottom = 0;  ///< inclusive
    double area = 0;
    Vector2d center = Vector2d::Zero();

    double width() const { return right - left + 1; }
    double height() const { return bottom - top + 1; }
    double ellipse() const { return k_quarter_disc * width() * height(); }
};

/// Pixels that are much darker than the paper around them, whatever the light.
PixelMask dark_pixels(const FloatImage& gray) {
    const FloatImage around = gaussian_blur(gray, 0.03f * static_cast<float>(std::max(gray.width, gray.height)));
    PixelMask dark(gray.width, gray.height, 1);
    for (std::size_t i = 0; i < dark.data.size(); ++i) dark.data[i] = gray.data[i] < k_mark_contrast * around.data[i];
    return dark;
}

/// Returns the pieces of a mask whose pixels touch by their sides.
std::vector<DarkPiece> pieces_of(PixelMask mask) {
    std::vector<DarkPiece> pieces;
    std::vector<Pixel> open;
    for (int y = 0; y < mask.height; ++y)
        for (int x = 0; x < mask.width; ++x) {
            if (!mask.pixel(x, y)[0]) continue;
            DarkPiece piece{x, x, y, y};
            open.push_back({x, y});
            mask.pixel(x, y)[0] = 0;
            while (!open.empty()) {
                const auto [u, v] = open.back();
                open.pop_back();
                piece.left = std::min(piece.left, u), piece.right = std::max(piece.right, u);
                piece.top = std::min(piece.top, v), piece.bottom = std::max(piece.bottom, v);
                piece.center += Vector2d(u + 0.5, v + 0.5);
                ++piece.area;
                for (const auto& [p, q] : {Pixel{u - 1, v}, Pixel{u + 1, v}, Pixel{u, v - 1}, Pixel{u, v + 1}}) {
                    if (p < 0 || q < 0 || p >= mask.width || q >= mask.height || !mask.pixel(p, q)[0]) continue;
                    mask.pixel(p, q)[0] = 0;
                    open.push_back({p, q});
                }
            }
            piece.center /= piece.area;
            pieces.push_back(piece);
        }
    return pieces;
}

bool is_ring(const DarkPiece& piece) {
    const double aspect = piece.width() / piece.height(), share = piece.area / piece.ellipse();
    const Vector2d middle(0.5 * (piece.left + piece.right + 1), 0.5 * (piece.top + piece.bottom + 1));
    return piece.width() >= 8 && aspect > 0.4 && aspect < 2.5 && std::abs(share - k_ring_share) < 0.17 &&
           (piece.center - middle).norm() < 0.1 * piece.width();
}

/// Returns whether a piece is the dot of a ring.
bool is_dot_of(const DarkPiece& piece, const DarkPiece& ring) {
    const double share = piece.area / ring.ellipse();
    return share > 0.4 * k_dot_share && share < 2 * k_dot_share &&
           (piece.center - ring.center).norm() < 0.12 * ring.width();
}

/// Returns whether nothing dark lies within a ring.
bool is_empty(const DarkPiece& ring, const std::vector<DarkPiece>& pieces) {
    return std::ranges::none_of(pieces, [&](const DarkPiece& piece) {
        return &piece != &ring && (piece.center - ring.center).norm() < 0.3 * ring.width();
    });
}

/// Orders marks: `plain` is the upper left one; the one across from it, then those beside it follow by their places.
std::optional<std::array<Vector2d, 4>> ordered(const Vector2d& plain, const std::array<Vector2d, 3>& dotted) {
    std::array<Vector2d, 4> best;
    double least = 0.35;  // of the diagonal: perspective makes a parallelogram uneven
    for (std::size_t k = 0; k < 3; ++k) {
        const Vector2d &across = dotted[k], &a = dotted[(k + 1) % 3], &b = dotted[(k + 2) % 3];
        const double uneven = (plain + across - a - b).norm() / (across - plain).norm();
        if (!(uneven < least)) continue;
        least = uneven;
        const Vector2d to_a = a - plain, to_b = b - plain;
        const bool a_first = to_a.x() * to_b.y() - to_a.y() * to_b.x() > 0;
        best = {plain, a_first ? a : b, across, a_first ? b : a};
    }
    if (least >= 0.35) return std::nullopt;
    return best;
}

/// Twice the area of the marks' quadrangle.
double doubled_area(const std::array<Vector2d, 4>& marks) {
    const Vector2d one = marks[2] - marks[0], other = marks[3] - marks[1];
    return std::abs(one.x() * other.y() - one.y() * other.x());
}

}  // namespace

std::optional<std::array<Vector2d, 4>> find_marks(const Image& picture) {
    FloatImage gray = gray_over_white(picture);
    const double scale = std::min(1.0, static_cast<double>(k_search_side) / std::max(gray.width, gray.height));
    if (scale < 1)
        gray = warp_drawing(gray, Similarity(scale, 0), static_cast<int>(scale * gray.width),
                            static_cast<int>(scale * gray.height));
    const std::vector<DarkPiece> pieces = pieces_of(dark_pixels(gray));
    std::vector<Vector2d> plain, dotted;
    for (const DarkPiece& ring : pieces) {
        if (!is_ring(ring)) continue;
        if (std::ranges::any_of(pieces, [&](const DarkPiece& piece) { return is_dot_of(piece, ring); }))
            dotted.push_back(ring.center / scale);
        else if (is_empty(ring, pieces))
            plain.push_back(ring.center / scale);
    }
    // Several sets of rings may fit. The marks lie in the corners of the sheet, so the largest quadrangle is taken.
    std::optional<std::array<Vector2d, 4>> best;
    for (const Vector2d& corner : plain)
        for (std::size_t i = 0; i < dotted.size(); ++i)
            for (std::size_t j = i + 1; j < dotted.size(); ++j)
                for (std::size_t k = j + 1; k < dotted.size(); ++k) {
                    const auto marks = ordered(corner, {dotted[i], dotted[j], dotted[k]});
                    if (marks && (!best || doubled_area(*marks) > doubled_area(*best))) best = marks;
                }
    return best;
}

}  // namespace exemplar
