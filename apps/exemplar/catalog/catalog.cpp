// exemplar catalog: the group of the subcommands that keep a catalog of shapes.

#include "apps/exemplar/commands.h"

namespace exemplar {

void add_catalog_command(Command& app) {
    Command* command = app.add_subcommand("catalog", "Keeps a catalog of many shapes, to be labeled in batch");
    command->footer(
        "A catalog is one SQLite file: what is known of each shape, and how it was labeled by which "
        "model.\n\nExample:\n"
        "  exemplar catalog add shapes.db downloads/ scans/\n"
        "  exemplar catalog list shapes.db --problems\n"
        "  exemplar label batch shapes.db --models models --out labeled\n"
        "  exemplar catalog status shapes.db\n"
        "  exemplar catalog export shapes.db --out shapes.csv");
    command->require_subcommand();
    add_catalog_add_command(*command);
    add_catalog_list_command(*command);
    add_catalog_status_command(*command);
    add_catalog_export_command(*command);
    add_catalog_merge_command(*command);
}

}  // namespace exemplar
