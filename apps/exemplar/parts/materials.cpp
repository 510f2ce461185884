// exemplar label materials: a glTF file with a material and texture coordinates per label.

#include <fmt/format.h>

#include <algorithm>

#include "apps/exemplar/arguments.h"
#include "apps/exemplar/commands.h"
#include "apps/exemplar/parts/labeled_input.h"
#include "host/core/stopwatch.h"
#include "host/core/text.h"
#include "host/mesh/editing/weld.h"
#include "host/parts/materials/write_materials.h"

namespace exemplar {
namespace {

struct MaterialsCommand {
    CommonOptions common;
    LabeledInputArguments input;
    std::filesystem::path materials, out;
};

/// Prints which labels have a material of their own, and returns them with their source.
nlohmann::json describe_materials(const MaterialTable& table, const std::vector<std::string>& names,
                                  const PartGraph& graph) {
    std::vector<std::size_t> parts(names.size(), 0);
    for (const Part& part : graph.parts)
        if (part.label >= 0) ++parts[static_cast<std::size_t>(part.label)];
    nlohmann::json labels = nlohmann::json::array();
    for (std::size_t i = 0; i < names.size(); ++i) {
        if (parts[i] == 0) continue;
        labels.push_back({{"label", names[i]}, {"parts", parts[i]}, {"material", nullptr}});
        if (table.contains(names[i]) || table.contains("*"))
            labels.back()["material"] = table.contains(names[i]) ? names[i] : "*";
    }
    return labels;
}

void run_materials(const MaterialsCommand& options) {
    const auto limits = apply_common_options(options.common);
    const Stopwatch watch;
    require_output_file(options.out);
    if (lower_case(options.out.extension().string()) != ".glb")
        throw UsageError(options.out.string() + ": materials are written as binary glTF; name a .glb file");
    require_input(options.materials);
    const MaterialTable table = read_materials(options.materials);
    for (const auto& [label, material] : table)
        if (!material.texture.empty()) require_input(material.texture);
    const LabeledInput input = read_labeled_input(options.input, options.common);
    require_not_replaced(options.out, {input.path, input.source});
    for (const auto& [label, material] : table)
        if (label != "*" && std::find(input.names.begin(), input.names.end(), label) == input.names.end() &&
            !options.common.quiet)
            fmt::print(stderr, "warning: {}: no label '{}'{}\n", options.materials.string(),
                       without_controls(label.substr(0, 40)), suggestion(label.substr(0, 255), input.names));
    const TriangleMesh mesh = welded(input.file.mesh);
    const PartGraph graph =
        of_file(input.path, [&] { return build_part_graph(mesh, build_topology(mesh), input.label); });
    write_materials(options.out, mesh, graph, input.names, table);
    fmt::print("{}: {} with materials: {} in {:.1f} s\n", input.path.string(), counted(graph.parts.size(), "part"),
               options.out.string(), watch.wall());
    write_report(options.common, {{"mesh", input.path.string()},
                                  {"labels", input.source},
                                  {"out", options.out.string()},
                                  {"materials", describe_materials(table, input.names, graph)},
                                  {"seconds", watch.wall()}});
}

}  // namespace

void add_materials_command(Command& label) {
    auto options = std::make_shared<MaterialsCommand>();
    Command* command = label.add_subcommand("materials", "Gives each label of a mesh a material, as glTF");
    command->footer(
        "Materials are JSON, by label; '*' is for all other labels:\n"
        "  {\"torso\": {\"texture\": \"fur.png\", \"size\": 0.1}, \"hand\": {\"color\": \"#888888\", \"metallic\": "
        "1}}\n"
        "Each part has texture coordinates around its principal axis, or across it if it is flat.\n\nExample:\n"
        "  exemplar label materials human.safetensors mesh.obj --materials skin.json --out dressed.glb");
    add_labeled_input(*command, options->input, options->common);
    command->add_option("--materials", options->materials, "materials of the labels, .json")
        ->required()
        ->type_name("FILE");
    command->add_option("--out", options->out, "file to write, .glb")->required()->type_name("FILE");
    add_common_options(*command, options->common);
    command->callback([options] { run_materials(*options); });
}

}  // namespace exemplar
