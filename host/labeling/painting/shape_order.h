#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "host/labeling/category/shape_descriptor.h"

namespace exemplar {

/// How alike the shapes of a folder are.
class ShapeLikeness {
  public:
    /// Standardizes the descriptors over the folder. The kernel's width is the median distance of a shape to its
    /// nearest neighbors, so that it does not depend on the kind of shapes. Throws UsageError for descriptors of
    /// different features.
    explicit ShapeLikeness(std::span<const ShapeDescriptor> shapes);
    std::size_t size() const { return size_; }
    /// Returns exp(-d^2 / 2 h^2) of two shapes, in (0, 1].
    float operator()(std::size_t a, std::size_t b) const { return value_[a * size_ + b]; }

  private:
    std::size_t size_;
    std::vector<float> value_;
};

/// Returns the unlabeled shapes in the order in which labeling them is expected to help most (after Yi et al. 2016):
/// the gain of a shape is the sum, over all unlabeled shapes, of their uncertainty times their likeness to it. The
/// shape with the largest gain comes first; the uncertainty of shapes like it then counts less for the next, so that
/// neighbors in the list differ. `uncertainty`: per shape, 1 minus the mean confidence of its labels, 1 for shapes
/// without suggested labels, and 0 for labeled ones, which are left out. Ties in the order of the shapes.
std::vector<std::size_t> order_by_gain(const ShapeLikeness& likeness, std::span<const float> uncertainty);

}  // namespace exemplar
