// exemplar label: the group of the labeling subcommands.

#include "apps/exemplar/commands.h"

namespace exemplar {

void add_label_command(Command& app) {
    Command* command = app.add_subcommand("label", "Labels the parts of meshes, learned from labeled meshes");
    command->footer(
        "Example:\n  exemplar label train shapes --out human.safetensors\n"
        "  exemplar label apply human.safetensors mesh.obj --out labeled\n"
        "  exemplar label batch shapes --model human.safetensors --out labeled\n"
        "  exemplar label evaluate --protocol sb6 shapes --out report\n"
        "  exemplar label study psb/labeled --out study.json\n"
        "  exemplar label stress human.safetensors mesh.obj\n"
        "  exemplar label split human.off --out parts --caps\n"
        "  exemplar label transfer low.off high.obj --out high_labels.txt\n"
        "  exemplar label rig human.safetensors mesh.obj --out rigged.glb\n"
        "  exemplar label materials labeled.ply --materials skin.json --out dressed.glb");
    command->require_subcommand();
    add_train_command(*command);
    add_apply_command(*command);
    add_batch_command(*command);
    add_evaluate_command(*command);
    add_study_command(*command);
    add_stress_command(*command);
    add_next_command(*command);
    add_simulate_command(*command);
    add_split_command(*command);
    add_transfer_command(*command);
    add_rig_command(*command);
    add_materials_command(*command);
    add_prototype_command(*command);
}

}  // namespace exemplar
