#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "host/lines/drawing.h"
#include "host/mesh/labels.h"
#include "host/mesh/mesh.h"

namespace exemplar {

/// How strokes on a part of a surface differ from the style of the drawing.
struct PartInk {
    std::optional<Color> color{};  ///< none: that of the style
    float width = 1;               ///< factor of the width; 0: the part has no strokes
    bool operator==(const PartInk&) const = default;
};

/// The inks of a labeled surface. Empty: all faces are drawn as the style says.
struct PartInks {
    std::vector<PartInk> inks;               ///< the first is that of the style
    std::vector<std::string> names;          ///< of the inks' labels; the first is empty
    std::vector<std::uint32_t> ink_of_face;  ///< per triangle, index into `inks`

    bool empty() const { return ink_of_face.empty(); }
};

/// Gives the faces of a mesh the inks of their labels; that of "*" is for all labels without their own. `labels` are
/// those of the mesh's source faces, or of its triangles. Throws UsageError if there are as many of neither, or if no
/// label of the mesh has an ink.
PartInks inks_of_parts(const TriangleMesh& mesh, const FaceLabels& labels,
                       const std::map<std::string, PartInk>& ink_of_label);

/// Returns the name of a layer of one ink: "contours" or "contours: torso".
std::string name_of_layer(std::string_view layer, const PartInks& inks, std::uint32_t ink);

/// Strokes of one ink.
struct InkedStrokes {
    std::uint32_t ink = 0;  ///< index into PartInks::inks
    std::vector<Stroke> strokes;
};

/// Divides the visible parts of strokes by the inks of the faces that they lie on (StrokePoint::face), and scales
/// their widths. Sorted by ink; those of width 0 are left out.
std::vector<InkedStrokes> strokes_by_ink(std::span<const Stroke> strokes, const PartInks& inks);

}  // namespace exemplar
