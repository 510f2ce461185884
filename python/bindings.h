#pragma once

#include <pybind11/pybind11.h>

namespace exemplar::python {

// One function per subject; each adds its classes and functions to the module.

void add_errors(pybind11::module_& module);
void add_settings(pybind11::module_& module);
void add_devices(pybind11::module_& module);
void add_meshes(pybind11::module_& module);
void add_synth(pybind11::module_& module);
void add_features(pybind11::module_& module);
void add_labeling(pybind11::module_& module);
void add_animations(pybind11::module_& module);
void add_curvature(pybind11::module_& module);
void add_lines(pybind11::module_& module);
void add_hatching(pybind11::module_& module);

}  // namespace exemplar::python
