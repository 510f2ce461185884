#include "host/core/run_program.h"

#include <cstdio>
#include <exception>
#include <new>

#include "host/core/errors.h"
#include "host/core/interrupt.h"
#include "host/core/text.h"

namespace exemplar {
namespace {

void print_error(const std::exception& error) {
    std::fprintf(stderr, "error: %s\n", without_controls(error.what()).c_str());
}

}  // namespace

int run_program(int (*run)(int argc, char** argv), int argc, char** argv) noexcept {
    install_interrupt_handler();
    try {
        return run(argc, argv);
    } catch (const Interrupted&) {
        std::fputs("interrupted\n", stderr);
        return 130;
    } catch (const UsageError& error) {
        print_error(error);
        return 2;
    } catch (const std::bad_alloc&) {
        std::fputs("error: out of memory; use fewer or smaller meshes\n", stderr);
    } catch (const std::exception& error) {
        print_error(error);
    }
    return 1;
}

}  // namespace exemplar
