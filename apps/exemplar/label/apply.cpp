// exemplar label apply: labels unseen meshes with a trained model.

#include <fmt/format.h>

#include <algorithm>

#include "apps/exemplar/arguments.h"
#include "apps/exemplar/backend.h"
#include "apps/exemplar/commands.h"
#include "apps/exemplar/label/labeled_output.h"
#include "apps/exemplar/parts/part_output.h"
#include "host/core/errors.h"
#include "host/core/interrupt.h"
#include "host/core/progress.h"
#include "host/core/stopwatch.h"
#include "host/data/corpus.h"
#include "host/labeling/features/feature_cache.h"
#include "host/labeling/inference/mesh_labeling.h"
#include "host/mesh/label_files/label_files.h"

namespace exemplar {
namespace {

struct ApplyOptions {
    CommonOptions common;
    PartOptions parts;
    std::filesystem::path model, out, split;
    std::filesystem::path cache = default_feature_folder();
    std::vector<std::filesystem::path> meshes;
    std::vector<std::string> label_forms;
    bool gltf = false, png = false, keep_small = false;
};

/// Labels one mesh and writes all of its files; returns its part of the report.
nlohmann::json apply_to(const std::filesystem::path& path, const LabelingModel& model, DeviceBackend& backend,
                        const std::filesystem::path& cache, const ApplyOptions& options) {
    const Stopwatch watch;
    const MeshFile file = read_mesh(path);
    const std::vector<std::string> warnings = mesh_warnings(file, path, options.common.quiet);
    const double read_seconds = watch.wall();
    const FaceLabeling labeling =
        of_file(path, [&] { return label_mesh(model, file.mesh, cache, backend.labeling()); });
    if (labeling.turned != 0 && !options.common.quiet)
        fmt::print(stderr, "remark: {}: labeled as if turned by {:.0f} degrees, to lie like the training meshes\n",
                   path.string(), labeling.turned);
    const LabeledOutput output = make_labeled_output(file.mesh, model, labeling);
    const std::filesystem::path stem = options.out / path.stem();
    write_labeled_files(stem, file, output, options.gltf);
    if (options.png) backend.render_png(stem.string() + ".png", file.mesh, triangle_colors(model, labeling));

    nlohmann::json json = describe_output(file.mesh, model, labeling);
    for (const std::string& form : options.label_forms) write_label_file(stem, form, file, output.labels);
    if (!options.split.empty())
        json["split"] = write_part_files(options.split / path.stem(), path, file, output.labels, options.parts);
    json["mesh"] = path.string();
    json["warnings"] = warnings;
    json["seconds"] = {{"read", read_seconds}, {"all", watch.wall()}};
    for (const auto& [stage, seconds] : labeling.seconds) json["seconds"][stage] = seconds;
    return json;
}

void run_apply(const ApplyOptions& options) {
    const auto limits = apply_common_options(options.common);
    require_output_folder(options.out);
    for (const std::string& form : options.label_forms)
        if (std::ranges::find(label_forms(), form) == label_forms().end())
            throw UsageError(fmt::format("--labels takes {}, not '{}'", fmt::join(label_forms(), ", "), form));
    if (!options.split.empty()) {
        check_part_options(options.parts);
        require_output_folder(options.split);
        if (options.gltf &&
            std::filesystem::weakly_canonical(options.split) == std::filesystem::weakly_canonical(options.out))
            throw UsageError("--split and --gltf would both write NAME.glb; give --split another folder than --out");
    }
    LabelingModel model = model_of_argument(options.model);
    if (options.keep_small) model.crf.merge_fraction = 0;
    std::vector<std::filesystem::path> meshes;
    for (const auto& source : options.meshes)
        for (const auto& path : meshes_of_argument(source)) meshes.push_back(path);
    require_distinct_names(meshes);
    require_other_folder(options.out, meshes);
    if (!options.split.empty()) require_other_folder(options.split, meshes);
    const std::filesystem::path cache = usable_cache(options.cache, options.common.quiet);
    DeviceBackend backend(options.common.device);

    Progress progress("labeling", meshes.size());
    nlohmann::json results = nlohmann::json::array();
    std::vector<std::string> failures;
    for (const auto& path : meshes) {
        check_interrupt();
        try {
            results.push_back(apply_to(path, model, backend, cache, options));
        } catch (const MeshError& error) {  // one bad mesh is no reason to leave the others unlabeled
            failures.emplace_back(error.what());
            results.push_back({{"mesh", path.string()}, {"error", error.what()}});
        }
        progress.advance(1, path.filename().string());
    }
    progress.finish();
    if (meshes.size() > 1)
        for (const std::string& failure : failures) fmt::print(stderr, "error: {}\n", failure);
    fmt::print("{} of {} meshes labeled into {}\n", meshes.size() - failures.size(), meshes.size(),
               options.out.string());
    write_report(options.common,
                 {{"model", options.model.string()}, {"device", backend.device_name()}, {"meshes", results}});
    if (meshes.size() == 1 && !failures.empty()) throw MeshError(failures.front());
    if (!failures.empty())
        throw MeshError(fmt::format("{} of {} meshes could not be labeled", failures.size(), meshes.size()));
}

}  // namespace

void add_apply_command(Command& label) {
    auto options = std::make_shared<ApplyOptions>();
    Command* command = label.add_subcommand("apply", "Labels unseen meshes with a trained model");
    command->footer(
        "Writes for each mesh NAME_labels.txt, NAME.ply (label and color per face) and NAME.seg.\n\nExample:\n"
        "  exemplar label apply human.safetensors a.off b.obj --out labeled --gltf --png --json labeled/report.json");
    command->add_option("MODEL", options->model, "model file of 'exemplar label train'")->required()->type_name("");
    command->add_option("MESH", options->meshes, "meshes, folders of meshes, or lists (.txt, a path a line)")
        ->required()
        ->type_name("");
    command->add_option("--out", options->out, "folder to write to")->required()->type_name("FOLDER");
    command->add_flag("--gltf", options->gltf, "also write NAME.glb with a material per part");
    command->add_flag("--png", options->png, "also write NAME.png, an image rendered through Vulkan");
    command
        ->add_option("--labels", options->label_forms,
                     "also write labels as json, npy, vtp (VTK), vertices, vertices-json (several may be named)")
        ->type_name("FORM");
    command->add_option("--split", options->split, "also write the parts as meshes of their own, to this folder")
        ->type_name("FOLDER");
    command
        ->add_option("--split-format", options->parts.format,
                     "format of --split: obj, ply, stl (a file per part) or glb")
        ->capture_default_str()
        ->type_name("FORMAT");
    add_part_options(*command, options->parts);
    command->add_flag("--keep-small", options->keep_small,
                      "leave pieces that are much smaller than any in training as they are, instead of merging them");
    command->add_option("--cache", options->cache, "folder that remembers features; '' remembers none")
        ->capture_default_str()
        ->type_name("FOLDER");
    add_device_option(*command, options->common);
    add_common_options(*command, options->common);
    command->callback([options] { run_apply(*options); });
}

}  // namespace exemplar
