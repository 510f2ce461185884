#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "host/core/random.h"
#include "host/synth/animations/animations.h"
#include "host/synth/modeling/field.h"
#include "host/synth/modeling/sculptor.h"

namespace exemplar {

/// A head of height 1 about the origin, eyes closed, with the proportions that its blend shapes refer to.
struct FaceModel {
    ShapeModel shape;
    float eye_x, eye_y, brow_y, nose_y, mouth_x, mouth_y, chin_y;
};
FaceModel sculpt_face(Random& random);

/// One smooth deformation of the skin, with compact support.
struct SkinPush {
    Vec3 center, radius;             ///< axis-parallel ellipsoid outside of which nothing moves
    Vec3 shift = Vec3::Zero();       ///< displacement of the center
    float swell = 0;                 ///< displacement of the center along the normal
    float fold = 0, fold_width = 1;  ///< height and length of waves along the normal
    Vec3 across = Vec3::UnitY();     ///< unit; the direction from wave to wave
};

/// A blend shape with its name in common rigs; "Left" is the person's left, +x.
struct FaceShape {
    std::string_view name;
    std::vector<SkinPush> pushes;
};
std::vector<FaceShape> face_shapes(const FaceModel& model, const ImplicitField& field);

/// Makes random expressions: weights within [0, 1] that rise and fall smoothly, a few at a time.
Clip move_face(const Rig& rig, std::size_t frames, const Random& random);

Animation make_face(const AnimationOptions& options);

}  // namespace exemplar
