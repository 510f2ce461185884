#pragma once

namespace exemplar {

/// All of a program's main(): `run` with an interrupt handler installed, and what it throws as one line on stderr and
/// an exit code: 1 for errors, 2 for wrong usage, 130 if it was interrupted; else what `run` returns.
int run_program(int (*run)(int argc, char** argv), int argc, char** argv) noexcept;

}  // namespace exemplar
