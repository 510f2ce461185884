#pragma once

#include <Eigen/Core>
#include <array>

#include "host/imaging/image.h"

namespace exemplar {

/// A projective map of a plane, as a camera sees it.
class PlaneMap {
  public:
    /// Maps each of four places, no three of them on a line, to the other.
    PlaneMap(const std::array<Eigen::Vector2d, 4>& from, const std::array<Eigen::Vector2d, 4>& to);
    Eigen::Vector2d apply(const Eigen::Vector2d& place) const;

  private:
    Eigen::Matrix3d matrix_;
};

/// Returns the mean of an image over a square of `side` pixels around a place, per channel; beyond the border the image
/// continues with its outermost pixels. Images of up to four channels.
std::array<double, 4> mean_at(const Image& image, const Eigen::Vector2d& place, double side);

}  // namespace exemplar
