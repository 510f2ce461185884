#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "host/mesh/labels.h"
#include "host/mesh/mesh.h"

namespace exemplar {

/// A generated shape with its true part labels.
struct SynthShape {
    TriangleMesh mesh;  ///< closed, manifold, one component, oriented outward
    FaceLabels labels;  ///< every face is labeled; names are those of the kind, including parts that this shape lacks
};

/// Returns the kinds of shapes that make_shape knows, e.g. "human", "chair".
std::span<const std::string_view> synth_kinds();
/// Returns the part names of a kind, in label order. Throws UsageError for an unknown kind.
std::span<const std::string_view> synth_labels(std::string_view kind);

/// Generates a shape. The same kind, seed and face count give the same bytes on one build of the program; another
/// seed gives another pose, other proportions and details. The shape stands upright (y up, facing +z) at any size
/// near 1, or is rotated at random about its center. `faces` is met within 10% from 2,000 to 40,000; fewer are too
/// few for thin parts. Throws UsageError for an unknown kind and for less than 100 or more than 200,000 faces.
SynthShape make_shape(std::string_view kind, std::uint64_t seed, std::size_t faces = 10000,
                      bool random_orientation = false);

}  // namespace exemplar
