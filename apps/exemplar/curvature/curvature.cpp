// exemplar curvature: learned curvature of animated surfaces.

#include "apps/exemplar/commands.h"

namespace exemplar {

void add_curvature_command(Command& app) {
    Command* command = app.add_subcommand("curvature", "Learns and evaluates the curvature of animated surfaces");
    command->require_subcommand();
    command->footer(
        "Animations: glTF 2.0 (.glb, .gltf) with a skin or morph targets; FBX and COLLADA (.dae) where "
        "exemplar-import\n"
        "is installed; folders of OBJ or PLY, a mesh a frame; folders with a neutral mesh and its blend shapes.\n\n"
        "Example:\n"
        "  exemplar curvature train figure.glb --frames :100 --out figure.safetensors\n"
        "  exemplar curvature evaluate figure.safetensors figure.glb --frames 100: --json errors.json");
    add_curvature_train_command(*command);
    add_curvature_evaluate_command(*command);
    add_curvature_study_command(*command);
}

}  // namespace exemplar
