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

/// Seconds that each action of a person takes.
struct PersonCosts {
    double open = 5;      ///< opens a shape and finds out what is wrong
    double stroke = 3;    ///< one stroke
    double verify = 1.5;  ///< looks at a shape, in the grid or after painting, and accepts or rejects it
    double face = 1;      ///< labels one face by hand: a click on each triangle
};

/// Returns the seconds that a person is expected to spend on a shape: it is opened, painted and verified. Where nothing
/// is known about it (`uncertainty` 1), it takes two strokes a label, else fewer in proportion.
double expected_seconds(float uncertainty, std::size_t labels, const PersonCosts& costs = {});

/// Returns the unlabeled shapes in the order in which a person's second is expected to help most (after Yi et al.
/// 2016). The gain of a shape is the sum, over all unlabeled shapes, of their uncertainty times their likeness to it.
/// The shape with the largest gain a second comes first; the uncertainty of shapes like it then counts less for the
/// next, so that neighbors in the list differ. `uncertainty`: per shape, 1 minus the mean confidence of its labels, 1
/// for shapes without suggested labels, and 0 for labeled ones, which are left out. `labels`: the number of labels.
/// Ties in the order of the shapes. Throws UsageError if uncertainties and shapes differ in number.
std::vector<std::size_t> order_by_gain(const ShapeLikeness& likeness, std::span<const float> uncertainty,
                                       std::size_t labels, const PersonCosts& costs = {});

}  // namespace exemplar
