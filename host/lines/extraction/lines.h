#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "host/lines/extraction/face_neighbors.h"
#include "host/mesh/curvature/curvature.h"
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
    principal_highlights,   ///< maximum of n.w along a principal direction (DeCarlo and Rusinkiewicz 2007)
    creases,                ///< edges whose faces meet at an angle; edges of more than two faces always
    boundaries              ///< edges of a single face
};
inline constexpr std::array k_line_types = {
    LineType::contours,  LineType::suggestive_contours, LineType::suggestive_highlights, LineType::ridges,
    LineType::valleys,   LineType::apparent_ridges,     LineType::principal_highlights,  LineType::creases,
    LineType::boundaries};
/// "contours", "suggestive_contours" and so on.
std::string_view name_of(LineType type);
/// The type of that name; nothing for another word.
std::optional<LineType> line_type_named(std::string_view name);
/// The type that a user's word means: its name or at least three letters that begin it ("suggestive" is the contours of
/// that kind), in any case, with - for _; nothing for another word.
std::optional<LineType> line_type_meant(std::string_view word);
/// Whether the lines move over the surface with the eye: all but ridges, valleys, creases and boundaries.
bool depends_on_view(LineType type);
/// Whether finding the lines takes curvature with derivatives: all but contours, creases and boundaries.
bool needs_curvature(LineType type);

/// How strong a line must be to be drawn. Dimensionless: what bounds a curvature is divided by the feature size, what
/// bounds a derivative of curvature or a product of two curvatures, by its square.
struct LineThresholds {
    float suggestive_contours = 0.01f;
    float suggestive_highlights = 0.02f;
    float principal_highlights = 0.04f;
    float ridges_valleys = 0.1f;
    float apparent_ridges = 0.1f;
    float crease_angle = 0.7f;  ///< radians between the normals of the faces
    /// By how much the strength of lines that depend on the view is above the threshold where they are half opaque.
    float fade = 0.03f;
};

/// The threshold of a type, and by how much a line of half its opacity is above it.
struct LineFading {
    float threshold, half;
};
/// Nothing for contours, creases and boundaries.
std::optional<LineFading> line_fading(LineType type, const LineThresholds& thresholds);

/// How opaque a line is at a strength x above its threshold: x / (x + f) with f the fade, or of ridges and valleys the
/// threshold itself, so that lines begin and end softly. In [0, 1]; 1 for contours, creases and boundaries.
float line_opacity(LineType type, float strength, const LineThresholds& thresholds);

/// The unit of length of the thresholds: min(0.01 / q, 0.05 R), with q the 10th percentile of all |k1| and |k2| and R
/// the radius of the smallest sphere around the vertices; in mesh units. Zero without vertices or extent. Throws
/// UsageError if there are not as many curvatures as vertices.
float feature_size(std::span<const Vec3> vertices, const VertexCurvature& curvature);

/// A surface as lines are found on it; refers to data of others.
struct LineSurface {
    std::span<const Face> faces;
    std::span<const Vec3> vertices;
    std::span<const Vec3> normals;     ///< unit, per vertex
    const VertexCurvature& curvature;  ///< with derivatives; may be empty for types that do without (needs_curvature)
    /// Of the same faces; may be empty but for creases and boundaries.
    std::span<const FaceNeighbors> neighbors{};
};

struct LineOptions {
    Vec3 eye = Vec3::Zero();    ///< in mesh units
    bool parallel_eye = false;  ///< `eye` is the unit direction to an eye at infinity
    float feature_size = 0;     ///< see feature_size(); positive but for types that do without curvature
    LineThresholds thresholds;
    /// Cuts ridges and valleys off where n.w <= 0. The lines that depend on the view always are, but for contours.
    bool front_facing_only = false;

    /// The unit vector from a point to the eye.
    Vec3 to_eye(const Vec3& point) const { return parallel_eye ? eye : Vec3((eye - point).normalized()); }
};

/// Where in its face a segment ends: on a side (0 to 2: from corner i to the next), at a corner (3 + i), or inside.
using SegmentEnd = std::uint8_t;
constexpr SegmentEnd k_at_corner = 3, k_inside_face = 6;

/// A straight piece of a line within one face.
struct LineSegment {
    std::uint32_t face = 0;
    /// Of principal highlights the principal direction, 0 or 1; else 0. Lines of two families do not continue each
    /// other.
    std::uint8_t family = 0;
    std::array<SegmentEnd, 2> places{k_inside_face, k_inside_face};
    /// Both ends in barycentric coordinates of the face, so that they move with its corners. Of contours and of
    /// suggestive contours and highlights, what has n.w or kr positive is to the left on the way from the first to the
    /// second, seen from outside.
    std::array<std::array<float, 3>, 2> ends{};
    /// What the threshold bounds, at both ends, in its units (dimensionless; creases: radians); 1 for contours and
    /// boundaries.
    std::array<float, 2> strength{};
};

/// All lines of a type, by face. A face has at most one segment; of principal highlights two, one per principal
/// direction, of ridges and the like three, which meet at its center, and of creases and boundaries one a side, in
/// the first of the faces at an edge. Throws UsageError if the parts of the surface or the feature size do not fit.
std::vector<LineSegment> extract_lines(const LineSurface& surface, LineType type, const LineOptions& options);

/// For each face 1 if it carries a line of that type, that is, a segment of extract_lines; else 0. Throws as that does.
std::vector<std::uint8_t> classify_faces(const LineSurface& surface, LineType type, const LineOptions& options);

}  // namespace exemplar
