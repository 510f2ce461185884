// The command line: one subcommand per file. Exit codes: 0 success, 1 error (one line on stderr), 2 wrong usage,
// 130 interrupted.

#include "apps/exemplar/commands.h"
#include "apps/help/help_pages.h"
#include "host/core/run_program.h"

namespace exemplar {
namespace {

int run(int argc, char** argv) {
    Command app("exemplar", "Learns geometry processing from examples and runs what it learned on the GPU.");
    app.footer(
        "'exemplar SUBCOMMAND --help' shows the options of each.\n"
        "Meshes are OFF, OBJ, PLY, STL and glTF files, and where exemplar-import is installed FBX, COLLADA, 3MF and "
        "3DS.\n"
        "Exit codes: 0 done, 1 error (one line says what), 2 wrong usage, 130 interrupted.\n\nExample:\n"
        "  exemplar synth human --count 8 --seed 1 --out shapes\n"
        "  exemplar label train shapes --out human.safetensors\n"
        "  exemplar label apply human.safetensors mesh.obj --out labeled");
    app.require_subcommand();
    app.version(EXEMPLAR_VERSION);
    add_label_command(app);
    add_category_command(app);
    add_curvature_command(app);
    add_lines_command(app);
    add_hatch_command(app);
    add_features_command(app);
    add_catalog_command(app);
    add_synth_command(app);
    add_devices_command(app);
    add_doctor_command(app);
    add_demo_command(app);
    add_bench_command(app);
    add_help_pages_option(app, EXEMPLAR_VERSION);
    return app.parse(argc, argv).value_or(0);
}

}  // namespace
}  // namespace exemplar

int main(int argc, char** argv) {
    return exemplar::run_program(exemplar::run, argc, argv);
}
