#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "host/hatching/features/pixel_features.h"
#include "host/hatching/measurement/drawing_properties.h"

namespace exemplar {

/// A drawing, and the view that it was made of.
struct HatchingExample {
    PixelFeatures& pixels;
    const DrawingProperties& drawing;
};

/// The covered pixels of several drawn views as the rows of one table: those of the first view, then those of the next.
class HatchingExamples {
  public:
    /// Keeps references, sets the scale of all views in relation to the first, and their parts to parts(). Throws
    /// UsageError if there is no view, if a drawing differs in size from its view, or if the views side by side are
    /// wider than 65,535 pixels.
    explicit HatchingExamples(std::span<const HatchingExample> views);

    std::span<const HatchingExample> views() const { return views_; }
    /// Returns the names of the parts that the views' labels tell apart, in the order in which they are met; none
    /// unless all views have labels.
    const std::vector<std::string>& parts() const { return parts_; }
    /// Returns the number of scalar features, those of parts included.
    std::size_t scalar_count() const { return views_.front().pixels.scalar_count(); }
    std::size_t size() const { return first_row_.back(); }
    std::uint32_t first_row(std::size_t view) const { return first_row_[view]; }
    std::size_t view_of(std::uint32_t row) const;
    /// Returns the pixel of a row in its view.
    std::uint32_t pixel_of(std::uint32_t row) const;
    const DrawingProperties& drawing_of(std::uint32_t row) const { return views_[view_of(row)].drawing; }
    /// Returns the x and y of a row, as if all views were side by side in one picture, far enough from each other that
    /// no pixel is near one of another view.
    std::array<std::uint16_t, 2> place_of(std::uint32_t row) const;

    /// Returns the scalar features `which` of rows, with memory for `spare` more columns; see PixelFeatures.
    FeatureMatrix scalars(std::span<const std::uint32_t> which, std::span<const std::uint32_t> rows,
                          std::size_t spare = 0) const;
    /// Returns the orientation features of rows.
    OrientationFields orientations(std::span<const std::uint32_t> rows) const;

    /// Some of the rows: those of a view, by their numbers in that view, and their positions among all.
    struct RowsOfView {
        std::vector<std::uint32_t> row, position;
    };
    RowsOfView rows_of_view(std::span<const std::uint32_t> rows, std::size_t view) const;

  private:
    std::vector<HatchingExample> views_;
    std::vector<std::string> parts_;
    std::vector<std::uint32_t> first_row_;  // of each view, and the number of all rows
    std::vector<std::uint32_t> first_x_;    // of each view in the picture of all
};

}  // namespace exemplar
