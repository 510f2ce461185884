#include "host/hatching/rules/hatching_examples.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "host/core/errors.h"

namespace exemplar {
namespace {

constexpr std::uint32_t k_gap = 256;  // pixels between views that are side by side

std::vector<std::string> common_parts(std::span<const HatchingExample> views) {
    std::vector<std::string> parts;
    for (const HatchingExample& view : views) {
        if (view.pixels.label_names().empty()) return {};
        for (const std::string& name : view.pixels.label_names())
            if (std::ranges::find(parts, name) == parts.end()) parts.push_back(name);
    }
    return parts;
}

}  // namespace

HatchingExamples::HatchingExamples(std::span<const HatchingExample> views)
    : views_(views.begin(), views.end()), first_row_{0} {
    if (views_.empty()) throw UsageError("there is no drawing to learn from");
    const float size = size_in_view(views_.front().pixels.surface(), views_.front().pixels.view());
    std::uint32_t x = 0;
    for (const auto& [pixels, drawing] : views_) {
        const HatchingView& view = pixels.view();
        if (drawing.width != view.width || drawing.height != view.height)
            throw UsageError(fmt::format("the drawing has {} x {} pixels, the view {} x {}", drawing.width,
                                         drawing.height, view.width, view.height));
        pixels.set_scale(size_in_view(pixels.surface(), view) / size);
        first_x_.push_back(x);
        first_row_.push_back(first_row_.back() + static_cast<std::uint32_t>(pixels.size()));
        x += static_cast<std::uint32_t>(drawing.width);
        if (x > std::numeric_limits<std::uint16_t>::max())
            throw UsageError(fmt::format("the drawings are {} pixels wide together; 65,535 are possible", x));
        x += k_gap;
    }
    parts_ = common_parts(views_);
    for (const HatchingExample& view : views_) view.pixels.use_parts(parts_);
}

std::size_t HatchingExamples::view_of(std::uint32_t row) const {
    return static_cast<std::size_t>(std::ranges::upper_bound(first_row_, row) - first_row_.begin()) - 1;
}

std::uint32_t HatchingExamples::pixel_of(std::uint32_t row) const {
    const std::size_t view = view_of(row);
    return views_[view].pixels.pixels().pixel[row - first_row_[view]];
}

std::array<std::uint16_t, 2> HatchingExamples::place_of(std::uint32_t row) const {
    const std::size_t view = view_of(row);
    const std::uint32_t pixel = pixel_of(row), width = static_cast<std::uint32_t>(views_[view].drawing.width);
    return {static_cast<std::uint16_t>(first_x_[view] + pixel % width), static_cast<std::uint16_t>(pixel / width)};
}

HatchingExamples::RowsOfView HatchingExamples::rows_of_view(std::span<const std::uint32_t> rows,
                                                            std::size_t view) const {
    RowsOfView out;
    for (std::uint32_t i = 0; i < rows.size(); ++i) {
        if (view_of(rows[i]) != view) continue;
        out.row.push_back(rows[i] - first_row_[view]);
        out.position.push_back(i);
    }
    return out;
}

FeatureMatrix HatchingExamples::scalars(std::span<const std::uint32_t> which, std::span<const std::uint32_t> rows,
                                        std::size_t spare) const {
    if (views_.size() == 1) return views_.front().pixels.scalars(which, rows, spare);
    FeatureMatrix out;
    out.rows = rows.size();
    out.values.reserve(out.rows * (which.size() + spare));
    out.values.resize(out.rows * which.size());
    for (const std::uint32_t k : which)
        out.names.push_back(k < k_pixel_features ? pixel_feature_names()[k]
                                                 : part_feature_name(parts_.at(k - k_pixel_features)));
    for (std::size_t view = 0; view < views_.size(); ++view) {
        const RowsOfView some = rows_of_view(rows, view);
        if (some.row.empty()) continue;
        const FeatureMatrix of_view = views_[view].pixels.scalars(which, some.row);
        for (std::size_t k = 0; k < which.size(); ++k) {
            for (std::size_t i = 0; i < some.position.size(); ++i)
                out.column(k)[some.position[i]] = of_view.column(k)[i];
        }
    }
    return out;
}

OrientationFields HatchingExamples::orientations(std::span<const std::uint32_t> rows) const {
    if (views_.size() == 1) return views_.front().pixels.orientations(rows);
    OrientationFields out(rows.size());
    for (std::size_t view = 0; view < views_.size(); ++view) {
        const RowsOfView some = rows_of_view(rows, view);
        if (some.row.empty()) continue;
        const OrientationFields of_view = views_[view].pixels.orientations(some.row);
        for (std::size_t k = 0; k < k_orientation_fields; ++k) {
            for (std::size_t i = 0; i < some.position.size(); ++i) out.field(k)[some.position[i]] = of_view.field(k)[i];
        }
    }
    return out;
}

}  // namespace exemplar
