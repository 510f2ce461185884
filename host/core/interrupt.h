#pragma once

namespace exemplar {

/// Makes Ctrl-C (SIGINT) and SIGTERM ask for a clean end; a second one ends the process at once.
void install_interrupt_handler();
/// Whether an end was asked for.
bool interrupted();
/// Throws Interrupted if an end was asked for. Long loops call it between items.
void check_interrupt();

}  // namespace exemplar
