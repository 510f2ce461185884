// exemplar label split: the parts of labeled meshes as meshes of their own.

#include <fmt/format.h>

#include "apps/exemplar/arguments.h"
#include "apps/exemplar/commands.h"
#include "apps/exemplar/parts/part_output.h"
#include "host/core/errors.h"
#include "host/core/interrupt.h"
#include "host/core/progress.h"
#include "host/data/corpus.h"
#include "host/mesh/label_files/label_files.h"

namespace exemplar {
namespace {

struct SplitCommandOptions {
    CommonOptions common;
    PartOptions parts;
    std::filesystem::path labels, out;
    std::vector<std::filesystem::path> meshes;
};

nlohmann::json split_one(const std::filesystem::path& path, const SplitCommandOptions& options) {
    const MeshFile file = read_mesh(path);
    std::vector<std::string> warnings = mesh_warnings(file, path, options.common.quiet);
    const FaceLabels labels =
        options.labels.empty() ? labels_of_mesh(path, file) : read_face_labels(options.labels, file.mesh);
    nlohmann::json json =
        of_file(path, [&] { return write_part_files(options.out / path.stem(), path, file, labels, options.parts); });
    json["mesh"] = path.string();
    for (const std::string& warning : json.value("warnings", std::vector<std::string>())) {
        warnings.push_back(warning);
        if (!options.common.quiet) fmt::print(stderr, "warning: {}: {}\n", path.string(), warning);
    }
    json["warnings"] = warnings;
    if (const auto open = json["open_cut_edges"].get<std::size_t>(); open > 0 && !options.common.quiet)
        fmt::print(stderr,
                   "warning: {}: {} cut edges stay open, since their cut ends at a hole or a non-manifold edge\n",
                   path.string(), open);
    return json;
}

void print_splits(const nlohmann::json& meshes) {
    for (const nlohmann::json& mesh : meshes) {
        fmt::print("{}:\n", mesh["mesh"].get<std::string>());
        for (const nlohmann::json& part : mesh["parts"])
            fmt::print("  {:<20} {:>8} triangles{}{}\n", part["name"].get<std::string>(),
                       part["triangles"].get<std::size_t>(), part["closed"].get<bool>() ? ", closed" : "",
                       part["manifold"].get<bool>() ? "" : ", not manifold");
    }
}

void run_split(const SplitCommandOptions& options) {
    const auto limits = apply_common_options(options.common);
    check_part_options(options.parts);
    require_output_folder(options.out);
    const std::vector<std::filesystem::path> meshes = meshes_of_arguments(options.meshes);
    if (!options.labels.empty()) {
        require_input(options.labels);
        if (meshes.size() > 1) throw UsageError("--labels names the labels of one mesh; give one mesh");
    }
    require_distinct_names(meshes);
    require_other_folder(options.out, meshes);
    Progress progress("splitting", meshes.size());
    nlohmann::json results = nlohmann::json::array();
    for (const auto& path : meshes) {
        check_interrupt();
        results.push_back(split_one(path, options));
        progress.advance(1, path.filename().string());
    }
    progress.finish();
    if (!options.common.quiet) print_splits(results);
    write_report(options.common, {{"meshes", results}});
}

}  // namespace

void add_split_command(Command& label) {
    auto options = std::make_shared<SplitCommandOptions>();
    Command* command = label.add_subcommand("split", "Writes the parts of labeled meshes as meshes of their own");
    command->footer(
        "The labels are those beside the mesh (NAME_labels.txt) or in it, unless --labels names others. Writes\n"
        "NAME_PART.obj, .ply or .stl for each part, or NAME.glb with a named node per part. A glTF mesh keeps\n"
        "its textures, skins, morph targets and animations as .glb, if neither --caps nor --explode change its "
        "shape.\n\nExample:\n"
        "  exemplar label split human.off --out parts --format stl --caps --instances");
    command->add_option("MESH", options->meshes, "labeled meshes, folders of meshes, or lists (.txt, a path a line)")
        ->required()
        ->type_name("");
    command->add_option("--labels", options->labels, "labels of the mesh, in any form that docs/formats.md lists")
        ->type_name("FILE");
    command->add_option("--out", options->out, "folder to write to")->required()->type_name("FOLDER");
    command->add_option("--format", options->parts.format, "obj, ply, stl or glb")
        ->capture_default_str()
        ->type_name("FORMAT");
    add_part_options(*command, options->parts);
    add_common_options(*command, options->common);
    command->callback([options] { run_split(*options); });
}

}  // namespace exemplar
