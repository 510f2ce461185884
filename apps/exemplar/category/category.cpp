// exemplar category: the group of the subcommands that recognize what kind of shape a mesh is.

#include "apps/exemplar/commands.h"

namespace exemplar {

void add_category_command(Command& app) {
    Command* command =
        app.add_subcommand("category", "Recognizes the category of a shape (cup, human, ...), or that it is unknown");
    command->footer(
        "Example:\n  exemplar category train shapes/cup shapes/human shapes/table --out categories.safetensors\n"
        "  exemplar category apply categories.safetensors mesh.obj\n"
        "  exemplar category evaluate shapes --train-count 6 --splits 3");
    command->require_subcommand();
    add_category_train_command(*command);
    add_category_apply_command(*command);
    add_category_evaluate_command(*command);
}

}  // namespace exemplar
