#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include "host/imaging/camera.h"
#include "host/imaging/image.h"
#include "host/lines/drawing.h"
#include "host/mesh/mesh.h"

namespace exemplar {

/// Which pixels of a picture have ink: one channel, zero without.
using InkMask = BasicImage<std::uint8_t>;

/// Returns the pixels that the center lines of visible strokes pass through, of one type or of all.
InkMask ink_of(const Drawing& drawing, std::optional<LineType> only = std::nullopt);

/// How well lines show the outline of a surface, in pixels of one picture or of several together.
struct OutlineCheck {
    /// Pixels of the silhouette: those that show the surface beside one that does not.
    std::size_t silhouette = 0;
    std::size_t outlined = 0;  ///< of these: with ink within k_outline_reach
    std::size_t contours = 0;  ///< pixels with ink of contours
    std::size_t stray = 0;     ///< of these: without an edge of the surface within k_outline_reach

    void add(const OutlineCheck& other);
    double outlined_share() const;  ///< in [0, 1]; 1 if there is no silhouette
    double stray_share() const;     ///< in [0, 1]; 0 if there are no contours
};
constexpr int k_outline_reach = 5;  ///< pixels

/// Compares ink with the surface as a z-buffer shows it. Edges of the surface are where neighboring pixels show a
/// jump in depth, or faces that meet at more than 20 degrees. Throws UsageError if the masks differ in size.
OutlineCheck check_outline(const TriangleMesh& surface, const Camera& camera, const InkMask& lines,
                           const InkMask& contours);

}  // namespace exemplar
