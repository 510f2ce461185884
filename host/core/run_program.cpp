#include "host/core/run_program.h"

#include <cstdio>
#include <exception>
#include <new>

#include "host/core/errors.h"
#include "host/core/interrupt.h"

namespace exemplar {

int run_program(int (*run)(int argc, char** argv), int argc, char** argv) noexcept {
    install_interrupt_handler();
    try {
        return run(argc, argv);
    } catch (const Interrupted&) {
        std::fputs("interrupted\n", stderr);
        return 130;
    } catch (const UsageError& error) {
        std::fprintf(stderr, "error: %s\n", error.what());
        return 2;
    } catch (const std::bad_alloc&) {
        std::fputs("error: out of memory; use fewer or smaller meshes\n", stderr);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "error: %s\n", error.what());
    }
    return 1;
}

}  // namespace exemplar
