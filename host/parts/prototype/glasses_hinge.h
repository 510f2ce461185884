#pragma once

#include <utility>
#include <vector>

#include "host/parts/prototype/glasses.h"
#include "host/parts/prototype/glasses_parts.h"
#include "host/parts/prototype/level_surface.h"

namespace exemplar {

/// Arms that spread by more than this many degrees are cut across themselves, not by the frontal plane.
constexpr float k_frontal_spread = 30;

/// The cut that separates an arm from the frame, and the hinge of the arm.
struct ArmCut {
    PinHinge hinge;
    float spread = 0, turn_to_frame = 0;  ///< in degrees, as in GlassesArm
    std::vector<float> side;  ///< per node of the body's grid, positive where the arm is; its zero is the cut

    /// Returns the corners of the rectangle, seen from the front, that the brackets of the hinge take up.
    std::pair<Vec2, Vec2> footprint() const;
};

/// Places the cut and the hinge of one arm (0: left). `body` holds the distances to the surface of `parts`. A point is
/// the arm's if it is behind the plane of the cut and the nearest face is one of the arm. Throws MeshError if there is
/// nothing to hang a hinge on.
ArmCut cut_arm(const GlassesParts& parts, const ValueGrid& body, std::size_t side, float gap);

/// A solid and the values that it is the surface of.
struct MovingSolid {
    const TriangleMesh* mesh;
    const ValueGrid* values;
};
/// Returns how many degrees the arm turns inward, in steps of 3 and at most `arm.wanted`, before a vertex of it is
/// within one of the solids that stand still, or the other way around. `meshes` and `values` are those of these solids.
float free_turn(const GlassesArm& arm, const MovingSolid& moving, const std::vector<const TriangleMesh*>& meshes,
                const std::vector<ValueGrid>& values);

}  // namespace exemplar
