#pragma once

namespace exemplar {

/// Makes glibc keep freed blocks of up to 32 MiB for reuse; does nothing with other C libraries. Otherwise each such
/// block goes back to the system, which maps and clears it again page by page. For programs that draw many frames
/// (CPU drivers allocate all vertices of a draw, megabytes per frame) or label many meshes (tens of megabytes of
/// features each).
void keep_freed_memory();

/// Gives freed memory back to the system, for programs that promised how much they use; does nothing with other C
/// libraries than glibc. Taking it again costs about a quarter of a second per GB.
void give_back_freed_memory();

}  // namespace exemplar
