#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "host/labeling/features/features.h"
#include "host/labeling/inference/model.h"

namespace exemplar {

/// Names of the coordinates of face centers, in column order.
std::vector<std::string> orientation_names();
/// Returns whether a model knows faces by where they are (App. A.1h): its last base features are their coordinates.
bool uses_orientation(const LabelingModel& model);

/// Makes the coordinates of the face centers, after a rotation, the columns of the faces' features from `base` on;
/// those that follow are dropped. Throws ModelError if the features have no positions.
void set_orientation(MeshFeatures& features, std::size_t base, const Eigen::Matrix3f& turn);

/// Rotations of which one turns any mesh to within 40 degrees of how it should lie. The first 24 turn axes to
/// axes; the identity comes first.
std::vector<Eigen::Matrix3f> coarse_turns();

/// Finds how a mesh must be turned to lie like those that a model with coordinates was trained on: the rotation after
/// which the first stage is surest, and most agrees with the stage without coordinates, on a few hundred faces. (A mesh
/// that lies the other way round may look as sure with both ends mistaken for each other.) It stays as it lies unless
/// another rotation is clearly better. The features have the model's columns. Runs on the host, so that it does not
/// depend on the device.
Eigen::Matrix3f likeliest_turn(const LabelingModel& model, const MeshFeatures& features);

}  // namespace exemplar
