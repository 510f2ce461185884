#include "apps/exemplar/ink_arguments.h"

#include <fmt/format.h>

#include "apps/exemplar/arguments.h"
#include "host/core/errors.h"
#include "host/data/corpus.h"
#include "host/mesh/label_files/label_files.h"

namespace exemplar {

void add_materials_option(Command& command, std::filesystem::path& materials) {
    command
        .add_option(
            "--materials", materials,
            "how the parts of a labeled mesh are drawn: JSON with a color and a factor of the width by label, as "
            "{\"torso\": {\"line\": {\"width\": 2}, \"hatching\": {\"color\": \"#663300\"}}}")
        ->type_name("FILE");
}

void require_inks(const InkArguments& arguments) {
    if (arguments.materials.empty()) return;
    require_input(arguments.materials);
    read_materials(arguments.materials);
    if (!arguments.labels.empty()) require_input(arguments.labels);
}

PartInks read_inks(const InkArguments& arguments, const std::filesystem::path& path, const MeshFile& file,
                   PartInk PartMaterial::*ink) {
    if (arguments.materials.empty()) return {};
    const FaceLabels labels =
        arguments.labels.empty() ? labels_of_mesh(path, file) : read_face_labels(arguments.labels, file.mesh);
    std::map<std::string, PartInk> inks;
    for (const auto& [label, material] : read_materials(arguments.materials)) inks[label] = material.*ink;
    try {
        return inks_of_parts(file.mesh, labels, inks);
    } catch (const UsageError& error) {
        throw UsageError(fmt::format("{}: {}", arguments.materials.string(), error.what()));
    }
}

}  // namespace exemplar
