#include "host/hatching/drawing/placement_loss.h"

#include <algorithm>
#include <optional>

#include "host/core/statistics.h"
#include "host/hatching/tracing/drawing_filters.h"
#include "host/hatching/tracing/region_outline.h"
#include "host/hatching/tracing/traced_drawing.h"

namespace exemplar {
namespace {

constexpr float k_closing = 0.04f;    ///< of the size: radius that closes gaps between strokes
constexpr float k_min_piece = 0.05f;  ///< of the largest: smaller pieces of ink are dust, or a signature
constexpr double k_end_weight = 3;
constexpr float k_hull_weight = 0.25f, k_fit_outside_weight = 2;

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
    const Vec2 gradient = distance_change(distance, place, k_step);
    const float length = gradient.norm();
    return length > 0 ? Vec2(gradient / length) : Vec2(0, 0);
}

BorderVotes votes_of(const std::vector<Vec2>& places, const FloatImage& drawing, const FloatImage& object) {
    constexpr float k_alike = 0.82f;  // 35 degrees
    BorderVotes votes{{}, places.size()};
    for (const Vec2& place : places)
        if (way_out_of(drawing, place).dot(way_out_of(object, place)) > k_alike) votes.cast.push_back({place, 0});
    return votes;
}

/// Sets the insets to expect. Strokes end at the object's border; but where they run along it, the outermost one
/// lies anywhere up to a spacing inside.
void expect_insets(BorderVotes& votes, const std::vector<Vec2>& ends, float spacing) {
    for (BorderVotes::Vote& vote : votes.cast) {
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

/// A robust loss: quadratic for small distances, constant for large ones.
float robust(float distance, float half) {
    return distance * distance / (distance * distance + half * half);
}

double mean_loss(const BorderVotes& votes, const auto& loss) {
    if (votes.all == 0) return 1;
    auto sum = static_cast<double>(votes.all - votes.cast.size());
    for (const BorderVotes::Vote& vote : votes.cast) sum += static_cast<double>(loss(vote));
    return sum / static_cast<double>(votes.all);
}

}  // namespace

PixelMask inked_region(const PixelMask& ink, float size) {
    return without_holes(without_small_pieces(closed_region(ink, k_closing * size), k_min_piece));
}

PixelMask intersection(PixelMask first, const PixelMask& second) {
    for (std::size_t i = 0; i < first.data.size(); ++i) first.data[i] = first.data[i] && second.data[i];
    return first;
}

ViewDrawing drawing_in_view(const FloatImage& darkness, const Similarity& to_view, const ViewObject& object,
                            bool with_ends) {
    const FloatImage view = warp_drawing(darkness, to_view, object.distance.width, object.distance.height);
    ViewDrawing drawing;
    std::vector<Vec2> ends, contacts, inside;
    std::optional<TracedDrawing> traced;
    if (with_ends) {
        traced = trace_drawing(view, PixelMask(view.width, view.height, 1, 1), k_smoothed_ink_darkness);
        ends = ends_of(view, *traced);
    }
    const PixelMask all = traced ? traced->ink : ink_pixels(gaussian_blur(view, 0.5f), k_smoothed_ink_darkness);
    const PixelMask region = inked_region(all, object.size), ink = intersection(all, region);
    drawing.distance = signed_distance(region);
    for (int y = 0; y < ink.height; ++y)
        for (int x = 0; x < ink.width; ++x) {
            if (!ink.pixel(x, y)[0]) continue;
            inside.push_back(center_of({x, y}));
            if (drawing.distance.pixel(x, y)[0] > -1.5f) contacts.push_back(center_of({x, y}));
        }
    drawing.ends = votes_of(ends, drawing.distance, object.distance);
    drawing.contacts = votes_of(evenly_spaced(contacts, k_border_points), drawing.distance, object.distance);
    drawing.hull = votes_of(object.border, drawing.distance, object.distance);
    drawing.ink = evenly_spaced(inside, k_border_points);
    if (traced) {
        const float spacing = std::min(mean_spacing(*traced, region), 2 * k_closing * object.size);
        for (BorderVotes* votes : {&drawing.contacts, &drawing.hull}) expect_insets(*votes, ends, spacing);
    }
    return drawing;
}

double placement_loss(const ViewDrawing& drawing, const ViewObject& object, const Similarity& change, float half) {
    const Similarity back = change.inverse();
    const auto away = [&](const Vec2& p) { return distance_at(object.distance, change.apply(p)); };
    const auto at_end = [&](const BorderVotes::Vote& end) { return robust(away(end.place), half); };
    const auto at_contact = [&](const BorderVotes::Vote& contact) {
        return robust(away(contact.place) + 0.5f + contact.inset, std::max(half, contact.inset));
    };
    const auto at_hull = [&](const BorderVotes::Vote& hull) {
        const float gap = distance_at(drawing.distance, back.apply(hull.place)) + 0.5f;
        return robust(gap - hull.inset, std::max(2 * half, hull.inset));
    };
    double outside = 0;
    for (const Vec2& p : drawing.ink) outside += static_cast<double>(std::clamp(away(p) / (4 * half), 0.0f, 1.0f));
    return (drawing.ends.all == 0 ? 0 : k_end_weight * mean_loss(drawing.ends, at_end)) +
           mean_loss(drawing.contacts, at_contact) + k_hull_weight * mean_loss(drawing.hull, at_hull) +
           k_fit_outside_weight * (drawing.ink.empty() ? 1 : outside / static_cast<double>(drawing.ink.size()));
}

}  // namespace exemplar
