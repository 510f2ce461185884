#include "apps/exemplar/commands.h"
namespace exemplar {
void add_hatch_extract_command(CLI::App&) {}
}  // namespace exemplar
