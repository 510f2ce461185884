#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "host/mesh/curvature.h"
#include "host/mesh/mesh.h"

namespace exemplar {

/// Curves on a surface that a line drawing of it shows. With n the unit normal, w the unit vector to the eye, k1 and k2
/// the principal curvatures and kr the curvature of the surface along w's projection into it:
enum class LineType {
    contours,               ///< n.w = 0
    suggestive_contours,    ///< kr = 0, growing towards the eye (DeCarlo et al. 2003, 2004)
    suggestive_highlights,  ///< kr = 0, falling towards the eye (DeCarlo and Rusinkiewicz 2007)
    ridges,                 ///< convex extremum of the curvature of largest magnitude along its direction
    valleys,                ///< the same where it is hollow (Ohtake et al. 2004)
    apparent_ridges,        ///< extremum of view-dependent curvature along its direction (Judd et al. 2007)
    principal_highlights    ///< maximum of n.w along a principal direction (DeCarlo and Rusinkiewicz 2007)
};
inline constexpr std::array k_line_types = {
    LineType::contours, LineType::suggestive_contours, LineType::suggestive_highlights, LineType::ridges,
    LineType::valleys,  LineType::apparent_ridges,     LineType::principal_highlights};
/// "contours", "suggestive_contours" and so on.
std::string_view name_of(LineType type);
/// The type of that name; nothing for another word.
std::optional<LineType> line_type_named(std::string_view name);
/// Whether the lines move over the surface with the eye: all but ridges and valleys.
bool depends_on_view(LineType type);

/// How strong a line must be to be drawn. Dimensionless: what bounds a curvature is divided by the feature size, what
/// bounds a derivative of curvature or a product of two curvatures, by its square.
struct LineThresholds {
    float suggestive_contours = 0.01f;
    float suggestive_highlights = 0.02f;
    float principal_highlights = 0.04f;
    float ridges_valleys = 0.1f;
    float apparent_ridges = 0.1f;
};

/// The unit of length of the thresholds: min(0.01 / q, 0.05 R), with q the 10th percentile of all |k1| and |k2| and R
/// the radius of the smallest sphere around the vertices; in mesh units. Zero without vertices or extent. Throws
/// UsageError if there are not as many curvatures as vertices.
float feature_size(std::span<const Vec3> vertices, const VertexCurvature& curvature);

/// A surface as lines are found on it; refers to data of others. Curvature needs derivatives but for contours.
struct LineSurface {
    std::span<const Face> faces;
    std::span<const Vec3> vertices;
    std::span<const Vec3> normals;  ///< unit, per vertex
    const VertexCurvature& curvature;
};

struct LineOptions {
    Vec3 eye = Vec3::Zero();  ///< in mesh units; not used by ridges and valleys but for front_facing_only
    float feature_size = 0;   ///< see feature_size(); positive
    LineThresholds thresholds;
    /// Cuts ridges and valleys off where n.w <= 0. The lines that depend on the view always are, but for contours.
    bool front_facing_only = false;
};

/// A straight piece of a line within one face.
struct LineSegment {
    std::uint32_t face = 0;
    /// Both ends in barycentric coordinates of the face, so that they move with its corners.
    std::array<std::array<float, 3>, 2> ends{};
    /// What the threshold bounds, at both ends, in its units (dimensionless); 1 for contours.
    std::array<float, 2> strength{};
};

/// All lines of a type, by face. A face has at most one segment; of principal highlights two, one per principal
/// direction, and of ridges and the like three, which meet at its center. Throws UsageError if the parts of the surface
/// or the feature size do not fit.
std::vector<LineSegment> extract_lines(const LineSurface& surface, LineType type, const LineOptions& options);

/// For each face 1 if it carries a line of that type, that is, a segment of extract_lines; else 0. Throws as that does.
std::vector<std::uint8_t> classify_faces(const LineSurface& surface, LineType type, const LineOptions& options);

}  // namespace exemplar
