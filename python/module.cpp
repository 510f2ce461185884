// The compiled module exemplar._exemplar; exemplar/__init__.py shows its names as those of the package.

#include "host/core/progress.h"
#include "python/bindings.h"

PYBIND11_MODULE(_exemplar, module) {
    module.doc() = "The compiled part of the package exemplar.";
    module.attr("__module__") = "exemplar";  // where classes and functions say they are from
    module.attr("__version__") = EXEMPLAR_VERSION;
    exemplar::Progress::set_quiet(true);  // a library does not write to a terminal unasked
    // Documentation names the classes that functions take and give: those are added first.
    exemplar::python::add_errors(module);
    exemplar::python::add_settings(module);
    exemplar::python::add_devices(module);
    exemplar::python::add_meshes(module);
    exemplar::python::add_animations(module);
    exemplar::python::add_synth(module);
    exemplar::python::add_features(module);
    exemplar::python::add_labeling(module);
    exemplar::python::add_curvature(module);
    exemplar::python::add_lines(module);
    exemplar::python::add_hatching(module);
}
