#include "host/hatching/drawing/drawing_alignment.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "host/core/errors.h"
#include "host/hatching/drawing/alignment_search.h"
#include "host/hatching/drawing/placement_loss.h"
#include "host/hatching/tracing/drawing_filters.h"
#include "host/hatching/tracing/region_outline.h"

namespace exemplar {
namespace {

constexpr float k_border_smoothing = 0.7f;  ///< pixels
constexpr float k_overview = 256;           ///< longer side of the image in which the drawing is searched, pixels
constexpr float k_search_size = 96;         ///< longer side of drawing and object in the search, pixels
constexpr std::size_t k_candidates = 5;
constexpr std::array<float, 4> k_losses{0.03f, 0.015f, 0.0075f,
                                        0.003f};  ///< distance that counts half, of the object's size
constexpr float k_min_loss_scale = 1;             ///< pixels
constexpr double k_quarter = std::numbers::pi / 2;
constexpr double k_fit_tilt_cost = 0.3, k_quarter_cost = 0.1;  ///< per radian, and per quarter turn
constexpr float k_border_tolerance = 0.02f;  ///< of the object's size: borders nearer than this lie on each other
constexpr float k_same_aspect = 0.01f;
constexpr float k_clearly_better = 0.8f, k_slack = 0.02f;  ///< max loss of another placement, relative to the frame's

/// The bounding box of the set pixels of a mask.
struct Box {
    Vec2 low = Vec2::Zero(), high = Vec2::Zero();
    float size() const { return (high - low).maxCoeff(); }
    Vec2 center() const { return 0.5f * (low + high); }
};

Box box_of(const PixelMask& mask) {
    Box box{Vec2::Constant(std::numeric_limits<float>::max()), Vec2::Constant(std::numeric_limits<float>::lowest())};
    for (int y = 0; y < mask.height; ++y)
        for (int x = 0; x < mask.width; ++x) {
            if (!mask.pixel(x, y)[0]) continue;
            const Vec2 corner(static_cast<float>(x), static_cast<float>(y));
            box.low = box.low.cwiseMin(corner);
            box.high = box.high.cwiseMax(corner + Vec2::Ones());
        }
    return box;
}

/// Transforms an image of zeros and ones, and sets the pixels of which at least `share` is covered by ones.
PixelMask resampled(const FloatImage& image, const Similarity& to, int width, int height, float share) {
    const FloatImage warped = warp_drawing(image, to, width, height);
    PixelMask mask(width, height, 1);
    for (std::size_t i = 0; i < mask.data.size(); ++i) mask.data[i] = warped.data[i] >= share;
    return mask;
}

/// Maps a box to the middle of a square image, its longer side to k_search_size pixels.
struct SearchFrame {
    Similarity to_frame;
    int size;

    explicit SearchFrame(const Box& box) : size(static_cast<int>(1.5f * k_search_size)) {
        const float scale = k_search_size / box.size();
        const Vec2 shift = Vec2::Constant(0.5f * static_cast<float>(size)) - scale * box.center();
        to_frame =
            Similarity(static_cast<double>(scale), 0, static_cast<double>(shift.x()), static_cast<double>(shift.y()));
    }
};

FloatImage zeros_and_ones(const Image& mask) {
    FloatImage image(mask.width, mask.height, 1);
    for (std::size_t i = 0; i < image.data.size(); ++i) image.data[i] = mask.data[i] ? 1.0f : 0.0f;
    return image;
}

/// The ink of a drawing, 1 or 0, and the bounding box of the drawing in it.
struct FoundInk {
    FloatImage ink;
    Box box;
};

FoundInk find_ink(const FloatImage& darkness) {
    FoundInk found{gaussian_blur(darkness, k_border_smoothing), {}};
    for (float& value : found.ink.data) value = value >= k_smoothed_ink_darkness ? 1.0f : 0.0f;
    const double scale = std::min(1.0, static_cast<double>(k_overview) / std::max(darkness.width, darkness.height));
    const int width = std::max(1, static_cast<int>(std::lround(scale * darkness.width)));
    const int height = std::max(1, static_cast<int>(std::lround(scale * darkness.height)));
    const PixelMask overview = resampled(found.ink, Similarity(scale, 0), width, height, 1e-3f);
    const PixelMask region = inked_region(overview, static_cast<float>(std::max(width, height)));
    found.box = box_of(region);
    if (!(found.box.size() > 0))
        throw DataError("the drawing has no ink to align with the view; give dark strokes on light paper");
    found.box.low /= static_cast<float>(scale);
    found.box.high /= static_cast<float>(scale);
    return found;
}

/// A placement in the view and its loss.
struct DrawingPlace {
    Similarity to_view;
    double loss = std::numeric_limits<double>::max();
};

float loss_scale(std::size_t stage, const ViewObject& object) {
    return std::max(k_min_loss_scale, k_losses[stage] * object.size);
}

/// Returns a cost of rotation, so that the least rotated of equally good placements wins.
double turn_cost(const Similarity& to_view) {
    const double turn = std::abs(to_view.rotation()), quarters = std::round(turn / k_quarter);
    return k_quarter_cost * quarters + k_fit_tilt_cost * std::abs(turn - quarters * k_quarter);
}

DrawingPlace judged(const FloatImage& darkness, const Similarity& to_view, const ViewObject& object) {
    return {to_view,
            placement_loss(drawing_in_view(darkness, to_view, object, false), object, {}, loss_scale(1, object)) +
                turn_cost(to_view)};
}

Similarity refined_in_view(const FloatImage& darkness, const Similarity& to_view, const ViewObject& object, float half,
                           bool with_ends) {
    const ViewDrawing drawing = drawing_in_view(darkness, to_view, object, with_ends);
    return to_view.then(refined({}, object.center, 0.5f * object.size, half,
                                [&](const Similarity& s) { return placement_loss(drawing, object, s, half); }));
}

/// Returns the placements that the coarse search finds, in the view.
std::vector<Similarity> likely_places(const FoundInk& found, const Image& object_mask,
                                      const AlignmentOptions& options) {
    const SearchFrame drawing_frame(found.box), object_frame(box_of(object_mask));
    const PixelMask ink = resampled(found.ink, drawing_frame.to_frame, drawing_frame.size, drawing_frame.size, 0.02f);
    const PixelMask region = inked_region(ink, k_search_size);
    const PixelMask object =
        resampled(zeros_and_ones(object_mask), object_frame.to_frame, object_frame.size, object_frame.size, 0.5f);
    if (box_of(region).size() <= 0 || box_of(object).size() <= 0) return {};
    std::vector<Similarity> places =
        best_places(region_shape(region, intersection(ink, region)), region_shape(object, object),
                    {options.max_tilt, options.quarter_turns}, k_candidates);
    for (Similarity& place : places) place = drawing_frame.to_frame.then(place).then(object_frame.to_frame.inverse());
    return places;
}

/// Returns the placement rotated about the object's center to the nearest quarter turn.
Similarity straightened(const Similarity& to_view, const Vec2& center) {
    const Similarity turn(1, -std::remainder(to_view.rotation(), k_quarter));
    const Vec2 shift = center - turn.apply(center);
    return to_view.then(turn.moved(static_cast<double>(shift.x()), static_cast<double>(shift.y())));
}

/// Refines the likely placements and returns the best. A border without corners fits in any rotation, and the search
/// ends at an arbitrary one; so the straightened placement is tried as well.
DrawingPlace best_likely(const FloatImage& darkness, const std::vector<Similarity>& places, const ViewObject& object) {
    DrawingPlace best;
    const auto consider = [&](Similarity to_view, std::size_t first_stage) {
        for (const std::size_t stage : {0u, 1u})
            if (stage >= first_stage)
                to_view = refined_in_view(darkness, to_view, object, loss_scale(stage, object), false);
        if (const DrawingPlace candidate = judged(darkness, to_view, object); candidate.loss < best.loss)
            best = candidate;
    };
    for (const Similarity& place : places) consider(place, 0);
    if (places.empty()) return best;
    consider(straightened(best.to_view, object.center), 1);
    // A better placement gives better votes and insets: so the first stage is repeated.
    for (const std::size_t stage : {1u, 1u, 1u, 2u, 3u})
        best.to_view = refined_in_view(darkness, best.to_view, object, loss_scale(stage, object), true);
    best = judged(darkness, best.to_view, object);
    const DrawingPlace straight = judged(darkness, straightened(best.to_view, object.center), object);
    return straight.loss <= best.loss ? straight : best;
}

/// Returns the drawing scaled to the view's size, if it has the view's aspect ratio.
DrawingPlace same_frame(const FloatImage& darkness, const ViewObject& object) {
    const double across = static_cast<double>(object.distance.width) / darkness.width;
    const double down = static_cast<double>(object.distance.height) / darkness.height;
    if (std::abs(across / down - 1) > static_cast<double>(k_same_aspect)) return {};
    return judged(darkness, Similarity(std::sqrt(across * down), 0), object);
}

/// Measures residual, explained and outside of an alignment.
void measure(const FloatImage& darkness, const ViewObject& object, DrawingAlignment& alignment) {
    const ViewDrawing drawing = drawing_in_view(darkness, alignment.to_view, object, false);
    const float near = std::max(2.0f, k_border_tolerance * object.size);
    double squares = 0, explained = 0, outside = 0;
    for (const Vec2& p : object.border) {
        const float distance = std::abs(distance_at(drawing.distance, p) + 0.5f);
        if (distance > near) continue;
        squares += static_cast<double>(distance * distance);
        ++explained;
    }
    for (const Vec2& p : drawing.ink) outside += distance_at(object.distance, p) > near ? 1 : 0;
    alignment.residual = explained > 0 ? static_cast<float>(std::sqrt(squares / explained)) : near;
    alignment.explained = static_cast<float>(explained / static_cast<double>(object.border.size()));
    alignment.outside = drawing.ink.empty() ? 1 : static_cast<float>(outside / static_cast<double>(drawing.ink.size()));
}

void check_drawing(const FloatImage& darkness, const Image& object) {
    if (darkness.channels != 1 || object.channels != 1)
        throw UsageError(fmt::format("images of one channel are aligned; the drawing has {}, the object's mask {}",
                                     darkness.channels, object.channels));
    if (darkness.data.empty()) throw UsageError("the drawing has no pixels");
    if (std::all_of(object.data.begin(), object.data.end(), [](std::uint8_t inside) { return inside == 0; }))
        throw UsageError("the object covers no pixel of the view: nothing can be drawn over it");
}

void refuse_misfits(const DrawingAlignment& alignment, const AlignmentOptions& options) {
    if (alignment.explained >= options.min_explained && alignment.outside <= options.max_outside) return;
    throw DataError(
        fmt::format("the drawing does not fit the view: at best its border lies on {:.0f}% of the object's ({:.0f}% "
                    "needed), with a "
                    "residual of {:.1f} pixels, and {:.0f}% of its ink outside ({:.0f}% allowed); draw over this view, "
                    "or crop the scan "
                    "to the drawing",
                    100 * static_cast<double>(alignment.explained), 100 * static_cast<double>(options.min_explained),
                    static_cast<double>(alignment.residual), 100 * static_cast<double>(alignment.outside),
                    100 * static_cast<double>(options.max_outside)));
}

}  // namespace

// The loss measures how well the border of the inked region lies on the object's where it is near it, how much of
// the object's border has ink at it, and how much ink is outside. A coarse grid covers all scales, tilts and places;
// the best of them are refined, the very best at the view's full resolution. There the loss tolerates strokes that
// end short of the border: only parts where the two borders run alike attract each other, and strokes along the
// border are expected half a spacing inside.
DrawingAlignment align_drawing(const FloatImage& darkness, const Image& object_mask, const AlignmentOptions& options) {
    check_drawing(darkness, object_mask);
    const Box box = box_of(object_mask);
    const ViewObject object{signed_distance(object_mask), border_points(object_mask, k_border_points), box.center(),
                            box.size()};
    const FoundInk found = find_ink(darkness);
    const DrawingPlace frame = same_frame(darkness, object);
    const DrawingPlace best = best_likely(darkness, likely_places(found, object_mask, options), object);
    DrawingAlignment alignment;
    alignment.same_frame =
        frame.loss < std::numeric_limits<double>::max() &&
        best.loss >= static_cast<double>(k_clearly_better) * frame.loss - static_cast<double>(k_slack);
    alignment.to_view = alignment.same_frame ? frame.to_view : best.to_view;
    measure(darkness, object, alignment);
    refuse_misfits(alignment, options);
    return alignment;
}

}  // namespace exemplar
