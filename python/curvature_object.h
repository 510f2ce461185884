#pragma once

#include <memory>

#include "host/mesh/curvature/curvature.h"

namespace exemplar::python {

/// Curvature in Python: measured or learned.
using CurvaturePointer = std::shared_ptr<VertexCurvature>;

}  // namespace exemplar::python
