#include "apps/exemplar/commands.h"
namespace exemplar {
void add_hatch_train_command(CLI::App&) {}
}  // namespace exemplar
