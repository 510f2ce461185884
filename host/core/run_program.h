#pragma once

namespace exemplar {

/// Implements a program's main(): installs the interrupt handler, calls `run`, and prints what it throws as one line
/// on stderr. Returns 1 after an error, 2 after wrong usage, 130 after an interrupt, else the result of `run`.
int run_program(int (*run)(int argc, char** argv), int argc, char** argv) noexcept;

}  // namespace exemplar
