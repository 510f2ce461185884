#pragma once

namespace exemplar {

/// Makes Ctrl-C (SIGINT) and SIGTERM request a clean end; a second signal ends the process at once.
void install_interrupt_handler();
/// Returns whether a signal requested the end.
bool interrupted();
/// Throws Interrupted if a signal requested the end or this thread's work was canceled (see cancel.h). Long loops
/// call it between items.
void check_interrupt();

}  // namespace exemplar
