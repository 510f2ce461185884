#include "host/core/interrupt.h"

#include <unistd.h>
#include <atomic>
#include <csignal>

#include "host/core/cancel.h"
#include "host/core/errors.h"

namespace exemplar {
namespace {

// Set by a signal handler and read by all threads.
std::atomic<int> end_requested = 0;
static_assert(std::atomic<int>::is_always_lock_free);

extern "C" void request_end(int signal) {
    if (end_requested) _exit(128 + signal);
    end_requested = 1;
}

}  // namespace

void install_interrupt_handler() {
    std::signal(SIGINT, request_end);
    std::signal(SIGTERM, request_end);
}

bool interrupted() {
    return end_requested != 0;
}

void check_interrupt() {
    if (interrupted() || work_canceled()) throw Interrupted();
}

}  // namespace exemplar
