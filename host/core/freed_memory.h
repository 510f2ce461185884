#pragma once

namespace exemplar {

/// Has the process keep blocks of up to 32 MiB when they are freed, for the next ones (with glibc; else nothing). For
/// programs that draw many frames, as CPU drivers take memory for all vertices of a draw and give it back, megabytes a
/// frame; or that label many meshes, each with features of tens of megabytes. Where the system gets it back, it maps
/// and clears it anew for the next, a page at a time.
void keep_freed_memory();

}  // namespace exemplar
