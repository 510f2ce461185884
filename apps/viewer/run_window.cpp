#include "apps/viewer/options.h"
namespace exemplar {
void run_window(const ViewerOptions&) {}
}  // namespace exemplar
