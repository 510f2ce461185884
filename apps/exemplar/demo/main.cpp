// 'exemplar demo' without the other commands: apps/demo.sh builds it in two thirds of the time, to show its page first.

#include "apps/exemplar/commands.h"
#include "host/core/run_program.h"

namespace exemplar {
namespace {

int run(int argc, char** argv) {
    Command app("exemplar-demo", "The demo of exemplar.");
    app.require_subcommand();
    add_demo_command(app);
    return app.parse(argc, argv).value_or(0);
}

}  // namespace
}  // namespace exemplar

int main(int argc, char** argv) {
    return exemplar::run_program(exemplar::run, argc, argv);
}
