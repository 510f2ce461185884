// exemplar hatch: learns to hatch from one drawing, and draws in its style.

#include "apps/exemplar/commands.h"

namespace exemplar {

void add_hatch_command(Command& app) {
    Command* hatch = app.add_subcommand("hatch", "Learns hatching from one drawing, and draws in its style");
    hatch->require_subcommand();
    hatch->footer(
        "From a view to trace to drawings of other meshes:\n"
        "  exemplar hatch template bunny.off --out bunny.png          # draw on it\n"
        "  exemplar hatch train bunny.off traced.png --template bunny.png --out mine.safetensors\n"
        "  exemplar hatch draw mine.safetensors cow.obj --out cow.svg\n\n"
        "Without a drawing of your own, begin with one that is built in:\n"
        "  exemplar hatch example contour bunny.off --out traced.png");
    add_hatch_template_command(*hatch);
    add_hatch_example_command(*hatch);
    add_hatch_register_command(*hatch);
    add_hatch_extract_command(*hatch);
    add_hatch_train_command(*hatch);
    add_hatch_draw_command(*hatch);
    add_hatch_compare_command(*hatch);
    add_hatch_figures_command(*hatch);
    add_hatch_features_command(*hatch);
    add_hatch_evaluate_command(*hatch);
}

}  // namespace exemplar
