#include "apps/exemplar/commands.h"
namespace exemplar {
void add_hatch_evaluate_command(CLI::App&) {}
}  // namespace exemplar
