#include "host/hatching/drawing/drawing_alignment.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>

#include "host/core/errors.h"
#include "host/hatching/drawing/alignment_search.h"
#include "host/hatching/tracing/drawing_filters.h"
#include "host/hatching/tracing/ink_mask.h"
#include "host/hatching/tracing/region_outline.h"
#include "host/hatching/tracing/traced_drawing.h"

namespace exemplar {
namespace {

constexpr float k_min_darkness = 0.1f;      ///< darkness of ink, after smoothing
constexpr float k_border_smoothing = 0.7f;  ///< pixels
constexpr float k_overview = 256;           ///< longer side of the image in which the drawing is searched, pixels
constexpr float k_search_size = 96;         ///< longer side of drawing and object in the search, pixels
constexpr float k_closing = 0.04f;          ///< of the size: radius that closes gaps between strokes
constexpr float k_min_piece = 0.05f;        ///< of the largest: smaller pieces of ink are dust, or a signature
constexpr std::size_t k_candidates = 5;
constexpr std::size_t k_border_points = 800;
constexpr std::array<float, 4> k_losses{0.03f, 0.015f, 0.0075f,
                                        0.003f};  ///< distance that counts half, of the object's size
constexpr float k_min_loss_scale = 1;             ///< pixels
constexpr double k_end_weight = 3;
constexpr double k_quarter = std::numbers::pi / 2;
constexpr double k_fit_tilt_cost = 0.3, k_quarter_cost = 0.1;  ///< per radian, and per quarter turn
constexpr float k_hull_weight = 0.25f, k_fit_outside_weight = 2;
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

/// Returns the region that strokes fill: closes gaps between them, removes dust, fills holes.
PixelMask inked_region(const PixelMask& ink, float size) {
    return without_holes(without_small_pieces(closed_region(ink, k_closing * size), k_min_piece));
}

PixelMask both(PixelMask first, const PixelMask& second) {
    for (std::size_t i = 0; i < first.data.size(); ++i) first.data[i] = first.data[i] && second.data[i];
    return first;
}

/// The ink of a drawing, 1 or 0, and the bounding box of the drawing in it.
struct FoundInk {
    FloatImage ink;
    Box box;
};

FoundInk find_ink(const FloatImage& darkness) {
    FoundInk found{gaussian_blur(darkness, k_border_smoothing), {}};
    for (float& value : found.ink.data) value = value >= k_min_darkness ? 1.0f : 0.0f;
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

/// The object at the view's resolution.
struct ViewObject {
    FloatImage distance;
    std::vector<Vec2> border;
    Vec2 center;
    float size;
};

/// Places on one border that are to lie on another. Only places where the two borders run alike vote: where hatching
/// ends in the middle of the object, because the rest is lit, its border crosses the object's and would attract it.
struct Votes {
    struct Vote {
        Vec2 place;
        float inset;  ///< how far inside of the object to expect ink, give or take as much
    };
    std::vector<Vote> cast;
    std::size_t all = 0;  ///< number of places; those without a vote count as fitting nowhere
};

/// The drawing in the view, under some placement.
struct ViewDrawing {
    Votes ends;      ///< of strokes
    Votes contacts;  ///< ink at the inked region's border: ends of strokes, and outermost strokes
    Votes hull;      ///< the border of the object
    std::vector<Vec2> ink;
    FloatImage distance;  ///< to the border of the inked region, signed
};

float total_length(const TracedDrawing& drawing) {
    float length = 0;
    for (const TracedStroke& stroke : drawing.strokes) length += length_along(stroke);
    return length;
}

/// Mean width of strokes: their ink over their length and the darkness of their center lines.
float mean_width(const FloatImage& darkness, const TracedDrawing& drawing) {
    const float length = total_length(drawing);
    double ink = 0, center = 0, count = 0;
    for (std::size_t i = 0; i < darkness.data.size(); ++i) {
        if (drawing.ink.data[i]) ink += static_cast<double>(darkness.data[i]);
        if (drawing.skeleton.data[i]) center += static_cast<double>(darkness.data[i]), ++count;
    }
    return length > 0 && center > 0 ? std::max(1.0f, static_cast<float>(ink * count / center) / length) : 1;
}

/// Returns where the center lines of strokes end: half a width before their tips. Leaves out ends at other strokes.
std::vector<Vec2> ends_of(const FloatImage& darkness, const TracedDrawing& drawing) {
    const float width = mean_width(darkness, drawing);
    std::vector<Vec2> ends;
    for (const TracedStroke& stroke : drawing.strokes)
        for (const bool back : {false, true}) {
            if (stroke.closed) continue;
            const std::optional<float> tip = distance_to_tip(darkness, stroke, back, width);
            const Vec2& end = back ? stroke.points.back().center : stroke.points.front().center;
            if (tip) ends.emplace_back(end + (*tip - 0.5f * width) * end_direction(stroke, back));
        }
    return ends;
}

/// Returns the unit direction out of a region; zero where the distance to its border does not change.
Vec2 way_out_of(const FloatImage& distance, const Vec2& place) {
    constexpr float k_step = 3;  // pixels: wider than the notches between strokes
    const Vec2 x(k_step, 0), y(0, k_step);
    const Vec2 gradient(distance_at(distance, place + x) - distance_at(distance, place - x),
                        distance_at(distance, place + y) - distance_at(distance, place - y));
    const float length = gradient.norm();
    return length > 0 ? Vec2(gradient / length) : Vec2(0, 0);
}

Votes votes_of(const std::vector<Vec2>& places, const FloatImage& drawing, const FloatImage& object) {
    constexpr float k_alike = 0.82f;  // 35 degrees
    Votes votes{{}, places.size()};
    for (const Vec2& place : places)
        if (way_out_of(drawing, place).dot(way_out_of(object, place)) > k_alike) votes.cast.push_back({place, 0});
    return votes;
}

/// Sets the insets to expect. Strokes end at the object's border; but where they run along it, the outermost one
/// lies anywhere up to a spacing inside.
void expect_insets(Votes& votes, const std::vector<Vec2>& ends, float spacing) {
    for (Votes::Vote& vote : votes.cast) {
        const auto near = [&](const Vec2& end) { return (vote.place - end).squaredNorm() < spacing * spacing; };
        if (std::ranges::none_of(ends, near)) vote.inset = 0.5f * spacing;
    }
}

/// Mean distance between strokes: the area they fill over their length.
float mean_spacing(const TracedDrawing& drawing, const PixelMask& region) {
    const float length = total_length(drawing);
    const auto area = static_cast<float>(std::ranges::count_if(region.data, [](std::uint8_t set) { return set != 0; }));
    return length > 0 ? area / length : 0;
}

std::vector<Vec2> thinned_out(const std::vector<Vec2>& points) {
    std::vector<Vec2> some;
    const std::size_t count = std::min(k_border_points, points.size());
    for (std::size_t i = 0; i < count; ++i) some.push_back(points[i * points.size() / count]);
    return some;
}

ViewDrawing drawing_in_view(const FloatImage& darkness, const Similarity& to_view, const ViewObject& object,
                            bool with_ends) {
    const FloatImage view = warp_drawing(darkness, to_view, object.distance.width, object.distance.height);
    ViewDrawing drawing;
    std::vector<Vec2> ends, contacts, inside;
    std::optional<TracedDrawing> traced;
    if (with_ends) {
        traced = trace_drawing(view, PixelMask(view.width, view.height, 1, 1), k_min_darkness);
        ends = ends_of(view, *traced);
    }
    const PixelMask all = traced ? traced->ink : ink_pixels(gaussian_blur(view, 0.5f), k_min_darkness);
    const PixelMask region = inked_region(all, object.size), ink = both(all, region);
    drawing.distance = signed_distance(region);
    for (int y = 0; y < ink.height; ++y)
        for (int x = 0; x < ink.width; ++x) {
            if (!ink.pixel(x, y)[0]) continue;
            inside.push_back(center_of({x, y}));
            if (drawing.distance.pixel(x, y)[0] > -1.5f) contacts.push_back(center_of({x, y}));
        }
    drawing.ends = votes_of(ends, drawing.distance, object.distance);
    drawing.contacts = votes_of(thinned_out(contacts), drawing.distance, object.distance);
    drawing.hull = votes_of(object.border, drawing.distance, object.distance);
    drawing.ink = thinned_out(inside);
    if (traced) {
        const float spacing = std::min(mean_spacing(*traced, region), 2 * k_closing * object.size);
        for (Votes* votes : {&drawing.contacts, &drawing.hull}) expect_insets(*votes, ends, spacing);
    }
    return drawing;
}

/// A robust loss: quadratic for small distances, constant for large ones.
float robust(float distance, float half) {
    return distance * distance / (distance * distance + half * half);
}

double mean_loss(const Votes& votes, const auto& loss) {
    if (votes.all == 0) return 1;
    auto sum = static_cast<double>(votes.all - votes.cast.size());
    for (const Votes::Vote& vote : votes.cast) sum += static_cast<double>(loss(vote));
    return sum / static_cast<double>(votes.all);
}

/// Returns the loss of a placement after a small change. Ink at the drawing's border should lie at the object's, and
/// the object's border should have ink, but neither counts where they are far apart; ink should not lie outside.
double loss_of(const ViewDrawing& drawing, const ViewObject& object, const Similarity& change, float half) {
    const Similarity back = change.inverse();
    const auto away = [&](const Vec2& p) { return distance_at(object.distance, change.apply(p)); };
    const auto at_end = [&](const Votes::Vote& end) { return robust(away(end.place), half); };
    const auto at_contact = [&](const Votes::Vote& contact) {
        return robust(away(contact.place) + 0.5f + contact.inset, std::max(half, contact.inset));
    };
    const auto at_hull = [&](const Votes::Vote& hull) {
        const float gap = distance_at(drawing.distance, back.apply(hull.place)) + 0.5f;
        return robust(gap - hull.inset, std::max(2 * half, hull.inset));
    };
    double outside = 0;
    for (const Vec2& p : drawing.ink) outside += static_cast<double>(std::clamp(away(p) / (4 * half), 0.0f, 1.0f));
    return (drawing.ends.all == 0 ? 0 : k_end_weight * mean_loss(drawing.ends, at_end)) +
           mean_loss(drawing.contacts, at_contact) + k_hull_weight * mean_loss(drawing.hull, at_hull) +
           k_fit_outside_weight * (drawing.ink.empty() ? 1 : outside / static_cast<double>(drawing.ink.size()));
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
    return {to_view, loss_of(drawing_in_view(darkness, to_view, object, false), object, {}, loss_scale(1, object)) +
                         turn_cost(to_view)};
}

Similarity refined_in_view(const FloatImage& darkness, const Similarity& to_view, const ViewObject& object, float half,
                           bool with_ends) {
    const ViewDrawing drawing = drawing_in_view(darkness, to_view, object, with_ends);
    return to_view.then(refined({}, object.center, 0.5f * object.size, half,
                                [&](const Similarity& s) { return loss_of(drawing, object, s, half); }));
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
    std::vector<Similarity> places = best_places(region_shape(region, both(ink, region)), region_shape(object, object),
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
                    "crop the scan "
                    "to the drawing, or give where it lies",
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
