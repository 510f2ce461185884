#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "host/parts/prototype/pin_hinge.h"
#include "host/parts/prototype/print_solid.h"

namespace exemplar {

struct GlassesOptions {
    double width = 140;            ///< of the frame, in mm
    double gap = 0.4;              ///< between solids that move or are put together, in mm
    double rim = 3;                ///< what is left of the frame around a lens, seen from the front, in mm
    double sheet = 2;              ///< thickness of the lenses, in mm
    std::size_t resolution = 280;  ///< cells of the grid across the width
    std::string lens, arm;         ///< labels; empty: those with a usual name
};

/// An arm and its hinge.
struct GlassesArm {
    std::string name;
    PinHinge hinge;
    float spread = 0;  ///< angle between the arm, as it is in the mesh, and straight back, in degrees; outward positive
    float wanted = 0;  ///< degrees that it must turn inward to lie along the frame
    float turns = 0;   ///< degrees that it turns, at most `wanted`, before it touches the frame or a lens
};

/// A lens to cut from a sheet.
struct GlassesLens {
    std::string name;
    std::vector<std::vector<Vec2>> outline;  ///< closed polygons in mm, seen from the front; holes turn the other way
};

/// Glasses to print and to cut. The solids are the frame, the arms and the lenses; pairs are left, then right.
struct Glasses {
    std::vector<PrintSolid> solids;
    std::array<GlassesArm, 2> arms;
    std::array<GlassesLens, 2> lenses;
    float cell = 0;  ///< of the grid, in mm
};

/// Makes glasses of a closed mesh with a label per triangle (thesis Sec. 3.5, Fig. 3.9a-d). The silhouettes of the
/// lenses, seen from the front and moved inward by the rim, are cut out of the frame; the lenses are plates with the
/// same outlines, less the gap, in the plane that fits each best. Arms are cut off by the frontal plane through the
/// centroid of both boundaries between arm and frame; an arm that spreads by more than 30 degrees is cut across itself
/// at its own boundary. Each gets a hinge at the inner face of the cut. Solids are in the frame of GlassesParts. Throws
/// MeshError if the mesh is open, has no two arms, or a solid vanishes; UsageError for labels that are not there.
Glasses make_glasses(const TriangleMesh& mesh, const std::vector<std::string>& names,
                     std::span<const std::int32_t> label, const GlassesOptions& options = {});

}  // namespace exemplar
