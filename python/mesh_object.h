#pragma once

#include <pybind11/pybind11.h>

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "host/core/errors.h"
#include "host/mesh/io/io.h"
#include "host/mesh/labels.h"
#include "host/mesh/mesh.h"

namespace exemplar::python {

/// A mesh in Python. It never changes, so any number of threads may use it, and arrays may be views of it.
struct MeshObject {
    std::shared_ptr<const TriangleMesh> mesh;
    std::string name = "mesh";                             ///< in messages: the file's, if it is from one
    std::shared_ptr<const FaceLabels> labels;              ///< a label per TRIANGLE; null: there are none
    std::shared_ptr<const std::vector<float>> confidence;  ///< per triangle; null: there are none
    std::vector<std::string> warnings;
    Polygons polygons;  ///< of the file; empty if it has only triangles
};
using MeshPointer = std::shared_ptr<MeshObject>;

/// A mesh without labels.
MeshPointer make_mesh(TriangleMesh mesh, std::string name, std::vector<std::string> warnings = {});

/// Returns the result of `work` on a mesh. Puts the mesh's name in front of the message of a MeshError.
template <typename Work>
auto named(const MeshObject& mesh, Work&& work) {
    try {
        return work();
    } catch (const MeshError& error) {
        const std::string what = error.what();
        throw MeshError(what.starts_with(mesh.name + ":") ? what : mesh.name + ": " + what);
    }
}

}  // namespace exemplar::python
