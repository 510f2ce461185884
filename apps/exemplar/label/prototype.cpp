// exemplar label prototype: parts as things to print.

#include "apps/exemplar/commands.h"

namespace exemplar {

void add_prototype_command(Command& /*label*/) {}

}  // namespace exemplar
