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

/// Curves on a surface that a line drawing shows. n is the unit normal, w the unit vector to the eye, k1 and k2 are
/// the principal curvatures, and kr is the normal curvature along the projection of w into the surface.
enum class LineType {
    contours,               ///< where the surface turns away from the eye: n.w = 0, and along sharp edges
    suggestive_contours,    ///< kr = 0, increasing towards the eye (DeCarlo et al. 2003, 2004)
    suggestive_highlights,  ///< kr = 0, decreasing towards the eye (DeCarlo and Rusinkiewicz 2007)
    ridges,                 ///< convex extremum of the larger-magnitude curvature along its direction
    valleys,                ///< the concave counterpart (Ohtake et al. 2004)
    apparent_ridges,        ///< extremum of view-dependent curvature along its direction (Judd et al. 2007)
    principal_highlights,   ///< maximum of n.w along a principal direction (DeCarlo and Rusinkiewicz 2007)
    creases,                ///< edges whose faces meet at an angle; edges of more than two faces always
    boundaries              ///< edges of a single face
};
inline constexpr std::array k_line_types = {
    LineType::contours,  LineType::suggestive_contours, LineType::suggestive_highlights, LineType::ridges,
    LineType::valleys,   LineType::apparent_ridges,     LineType::principal_highlights,  LineType::creases,
    LineType::boundaries};
/// Returns "contours", "suggestive_contours" and so on.
std::string_view name_of(LineType type);
/// Returns the type with exactly that name, if there is one.
std::optional<LineType> line_type_named(std::string_view name);
/// Returns the first type whose name starts with a user's word of at least three letters, ignoring case, with - for
/// _. "suggestive" means the contours, and "highlights" suggestive_highlights.
std::optional<LineType> line_type_from_prefix(std::string_view word);
/// Returns whether the lines move over the surface with the eye: all but ridges, valleys, creases and boundaries.
bool depends_on_view(LineType type);
/// Returns whether the lines depend on curvature and its derivatives: all but contours, creases and boundaries.
bool needs_curvature(LineType type);

/// Minimum strengths of drawn lines, dimensionless: curvatures are multiplied by the feature size, derivatives of
/// curvature and products of two curvatures by its square.
struct LineThresholds {
    float suggestive_contours = 0.01f;
    float suggestive_highlights = 0.02f;
    float principal_highlights = 0.04f;
    float ridges_valleys = 0.1f;
    float apparent_ridges = 0.1f;
    float crease_angle = 0.7f;  ///< radians between the normals of the faces
    /// Excess over the threshold at which view-dependent lines have half their opacity.
    float fade = 0.03f;
};

/// The threshold of a type, and the excess over it at which a line has half its opacity.
struct LineFading {
    float threshold, half;
};
/// Returns how lines of a type fade; nothing for contours, creases and boundaries.
std::optional<LineFading> line_fading(LineType type, const LineThresholds& thresholds);

/// Returns the opacity in [0, 1] of a line, so that it begins and ends softly: x / (x + f), where x is the excess of
/// `strength` over the threshold, and f the fade or, for ridges and valleys, the threshold. 1 for contours, creases
/// and boundaries.
float line_opacity(LineType type, float strength, const LineThresholds& thresholds);

/// Returns the unit of length of the thresholds, in mesh units: min(0.01 / q, 0.05 R), where q is the 10th
/// percentile of all |k1| and |k2| and R the radius of the smallest sphere around the vertices. Zero without
/// vertices or extent. Throws UsageError if there are not as many curvatures as vertices.
float feature_size(std::span<const Vec3> vertices, const VertexCurvature& curvature);

/// Non-owning view of a surface on which lines are extracted.
struct LineSurface {
    std::span<const Face> faces;
    std::span<const Vec3> vertices;
    std::span<const Vec3> normals;     ///< unit, per vertex
    const VertexCurvature& curvature;  ///< with derivatives; may be empty if no type needs it (needs_curvature)
    /// Neighbors of the faces. Creases, boundaries, and contours along sharp edges are found by them only.
    std::span<const FaceNeighbors> neighbors{};
    /// The faces before the surface was cut open along its sharp edges (SplitSurface); empty: it is not cut.
    std::span<const Face> uncut{};

    /// Returns the faces with the vertices that they share across all edges.
    std::span<const Face> joined_faces() const { return uncut.empty() ? faces : uncut; }
};

struct LineOptions {
    Vec3 eye = Vec3::Zero();    ///< in mesh units
    bool parallel_eye = false;  ///< `eye` is the unit direction to an eye at infinity
    float feature_size = 0;     ///< see feature_size(); must be positive for types that need curvature
    LineThresholds thresholds;
    /// Whether to cut off ridges and valleys where n.w <= 0. View-dependent lines other than contours always are.
    bool front_facing_only = false;
    /// Whether contours include all edges of a single face. If boundaries are drawn as well, they need not.
    bool contours_at_boundaries = false;
    /// Whether creases on the outline are left out. If contours are drawn as well, they are among these.
    bool no_creases_on_outline = false;

    /// Returns the unit vector from a point to the eye.
    Vec3 to_eye(const Vec3& point) const { return parallel_eye ? eye : Vec3((eye - point).normalized()); }
};

/// Where in its face a segment ends: on side i from corner i to the next (i), at corner i (3 + i), or inside (6).
using SegmentEnd = std::uint8_t;
constexpr SegmentEnd k_at_corner = 3, k_inside_face = 6;

/// A straight piece of a line within one face.
struct LineSegment {
    std::uint32_t face = 0;
    /// Principal highlights: the principal direction, 0 or 1; contours: 0, or k_family_along_edges; others: 0.
    /// Different families are never joined.
    std::uint8_t family = 0;
    std::array<SegmentEnd, 2> places{k_inside_face, k_inside_face};
    /// Both ends in barycentric coordinates of the face, so that they move with its corners. For contours,
    /// suggestive contours and highlights, the side with positive n.w or kr is to the left of the direction from the
    /// first to the second end, seen from outside.
    std::array<std::array<float, 3>, 2> ends{};
    /// Strength at both ends, in the units of the threshold (dimensionless; creases: radians); 1 for contours and
    /// boundaries.
    std::array<float, 2> strength{};
};

/// LineSegment::family of contours along edges of faces.
constexpr std::uint8_t k_family_along_edges = 1;
/// Returns whether a segment runs along an edge of its face: creases, boundaries, and such contours.
bool runs_along_edge(LineType type, const LineSegment& segment);

/// Returns the segments of all lines of a type, ordered by face. A face has at most one segment, except for
/// principal highlights (two, one per direction), ridges, valleys and apparent ridges (three, which meet at its
/// center), and those along edges (one per side, in the first face of an edge). Contours run across smooth parts,
/// where n.w is zero, and along sharp edges (contour_along). Throws UsageError if sizes of
/// the surface's arrays differ, or the feature size is not positive where curvature is needed.
std::vector<LineSegment> extract_lines(const LineSurface& surface, LineType type, const LineOptions& options);

/// Returns for each face 1 if extract_lines finds a segment of that type in it, else 0. Throws the same errors.
std::vector<std::uint8_t> classify_faces(const LineSurface& surface, LineType type, const LineOptions& options);

}  // namespace exemplar
