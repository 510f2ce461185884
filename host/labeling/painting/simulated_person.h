#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "host/labeling/painting/completion.h"

namespace exemplar {

/// How a simulated person paints.
struct PersonOptions {
    float brush_radius = 0.02F;   ///< in square roots of the surface's area
    float stroke_length = 0.25F;  ///< at most, in the same unit
};

/// The faces that one stroke paints.
struct PersonStroke {
    std::int32_t label = 0;
    std::vector<std::uint32_t> faces;
};

/// A person who knows the true labels of a mesh and mends what is shown wrong, stroke by stroke.
class SimulatedPerson {
  public:
    /// `truth`: a label per face; -1 where nobody knows it.
    SimulatedPerson(const TriangleMesh& mesh, std::span<const std::int32_t> truth, const PersonOptions& options = {});
    /// Returns a stroke of the right label at the middle of the largest region that is shown wrong and has one true
    /// label; nothing if all is right.
    std::optional<PersonStroke> next_stroke(std::span<const std::int32_t> shown) const;
    /// Returns the share of the surface that is right.
    double right(std::span<const std::int32_t> shown) const;

  private:
    std::vector<std::uint32_t> largest_wrong_region(std::span<const std::int32_t> shown) const;
    std::vector<std::uint32_t> brush_path(std::span<const std::uint32_t> region) const;
    PersonOptions options_;
    std::vector<std::int32_t> truth_;
    std::vector<float> area_;
    std::vector<Vec3> center_, normal_;
    DualGraph graph_;
    float unit_ = 1;
};

}  // namespace exemplar
