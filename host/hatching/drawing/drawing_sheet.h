#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "host/imaging/image.h"

namespace exemplar {

/// A sheet of paper that a view is printed on, to be drawn on, with marks in its corners by which a scan or a
/// photograph of it is read. Places are pixels of the sheet: x right, y down, the upper left corner is (0, 0).
struct DrawingSheet {
    int width = 0, height = 0;  ///< pixels
    double pixels_per_mm = 0;
    Eigen::Vector2d view_corner = Eigen::Vector2d::Zero();  ///< upper left corner of the view
    double view_scale = 1;                                  ///< pixels of the sheet per pixel of the view
    int view_width = 0, view_height = 0;
    /// Centers of the marks: upper left (a ring), upper right, lower right, lower left (rings with a dot).
    std::array<Eigen::Vector2d, 4> marks;
};

/// Returns the names of the sizes of paper: "a3", "a4", "a5", "letter", "legal", "tabloid".
const std::vector<std::string>& paper_names();
/// Lays a view out on paper, as large as it fits, upright or across; 300 pixels an inch. Throws UsageError for an
/// unknown paper or a view without pixels.
DrawingSheet drawing_sheet(const std::string& paper, int view_width, int view_height);

/// Returns the sheet to print, RGB: the view (gray, one channel, of the sheet's view size) in a light blue that
/// read_sheet does not see, black marks, and a scale of 100 mm.
Image printed_sheet(const DrawingSheet& sheet, const Image& view);

/// Finds the marks in a picture of the sheet, turned and in perspective, in the order of DrawingSheet::marks, in pixels
/// of the picture. Returns nothing unless all four are seen.
std::optional<std::array<Eigen::Vector2d, 4>> find_marks(const Image& picture);

/// Cuts the view out of a picture of the sheet, straightened: an image of the view's aspect ratio, at about the
/// picture's resolution but at most four times the view's. Throws DataError if the marks are not seen.
Image read_sheet(const Image& picture, const DrawingSheet& sheet);

}  // namespace exemplar
