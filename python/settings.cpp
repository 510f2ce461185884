// Settings of the whole process: threads, progress, folders of remembered results.

#include <memory>

#include "host/core/parallel.h"
#include "host/core/progress.h"
#include "host/hatching/features/surface_cache.h"
#include "host/labeling/features/feature_cache.h"
#include "python/arrays.h"
#include "python/bindings.h"

namespace exemplar::python {
namespace {

void set_threads(std::int64_t threads) {
    constexpr std::int64_t k_most = 4096;
    require_range("threads", threads, std::int64_t{0}, k_most);
    // It lives as long as the process: TBB may end before what is destroyed at the end.
    static auto* const limit = new std::unique_ptr<ThreadLimit>;
    limit->reset();
    if (threads > 0) *limit = std::make_unique<ThreadLimit>(static_cast<std::size_t>(threads));
}

}  // namespace

void add_settings(py::module_& module) {
    module.def("set_threads", &set_threads, py::arg("threads"),
               "Lets all work run on at most so many CPU threads; 0: on all cores.");
    module.def(
        "show_progress", [](bool shown) { Progress::set_quiet(!shown); }, py::arg("shown") = true,
        "Whether long work tells on standard error how far it is; at first it does not.");
    module.def(
        "feature_folder", [] { return default_feature_folder().string(); },
        "The folder in which the programs remember features of meshes: what to give as `cache` to share them.");
    module.def(
        "surface_folder", [] { return default_surface_folder().string(); },
        "The folder in which the programs remember surfaces measured for hatching: what to give as `cache` of a\n"
        "HatchingScene to share them.");
}

}  // namespace exemplar::python
