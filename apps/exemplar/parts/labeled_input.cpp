#include "apps/exemplar/parts/labeled_input.h"

#include <fmt/format.h>

#include "apps/exemplar/arguments.h"
#include "apps/exemplar/backend.h"
#include "host/core/errors.h"
#include "host/data/corpus.h"
#include "host/labeling/features/feature_cache.h"
#include "host/labeling/inference/mesh_labeling.h"
#include "host/mesh/label_files/label_files.h"

namespace exemplar {
namespace {

void label_by_model(const std::filesystem::path& model_path, const LabeledInputArguments& arguments,
                    const CommonOptions& common, LabeledInput& input) {
    const LabelingModel model = model_of_argument(model_path);
    mesh_warnings(input.file, input.path, common.quiet);
    const std::filesystem::path cache = usable_cache(arguments.cache, common.quiet);
    DeviceBackend backend(common.device);
    input.names = model.label_names;
    input.compatibility = model.crf.compatibility;
    input.label =
        of_file(input.path, [&] { return label_mesh(model, input.file.mesh, cache, backend.labeling()); }).label;
    input.source = model_path.string();
}

FaceLabels labels_of_input(const LabeledInputArguments& arguments, LabeledInput& input) {
    if (!arguments.labels.empty()) {
        input.source = arguments.labels.string();
        require_input(arguments.labels);
        return read_face_labels(arguments.labels, input.file.mesh);
    }
    input.source = input.path.string();
    try {
        return labels_of_mesh(input.path, input.file);
    } catch (const DataError& error) {
        throw DataError(fmt::format("{}; or give a MODEL before the mesh, or --labels FILE", error.what()));
    }
}

}  // namespace

LabelPairCosts pair_costs(const LabeledInput& input) {
    LabelPairCosts costs;
    const std::size_t count = input.names.size();
    if (input.compatibility.size() != count * count) return costs;
    for (std::size_t a = 0; a < count; ++a)
        for (std::size_t b = 0; b < count; ++b)
            if (input.names[a] < input.names[b])
                costs[{input.names[a], input.names[b]}] = input.compatibility[a * count + b];
    return costs;
}

void add_labeled_input(Command& command, LabeledInputArguments& arguments, CommonOptions& common) {
    arguments.cache = default_feature_folder();
    command
        .add_option("INPUT", arguments.paths,
                    "a model of 'exemplar label train' and a mesh that it labels, or a mesh that has labels")
        ->required()
        ->type_name("");
    command
        .add_option("--labels", arguments.labels,
                    "labels of the mesh: a NAME_labels.txt, a .seg, or a labeled mesh with the same faces")
        ->type_name("FILE");
    command.add_option("--cache", arguments.cache, "folder that remembers features; '' remembers none")
        ->capture_default_str()
        ->type_name("FOLDER");
    add_device_option(command, common);
}

LabeledInput read_labeled_input(const LabeledInputArguments& arguments, const CommonOptions& common) {
    if (arguments.paths.size() > 2) throw UsageError("one model and one mesh, or one mesh, at a time");
    const bool has_model = arguments.paths.size() == 2;
    if (has_model && !arguments.labels.empty())
        throw UsageError("--labels takes the place of a model; give one of them");
    LabeledInput input;
    input.path = arguments.paths.back();
    require_input(input.path);
    input.file = read_mesh(input.path);
    if (has_model) {
        label_by_model(arguments.paths.front(), arguments, common, input);
        return input;
    }
    mesh_warnings(input.file, input.path, common.quiet);
    const FaceLabels labels = labels_of_input(arguments, input);
    input.names = labels.names;
    input.label.reserve(input.file.mesh.face_count());
    for (std::uint32_t f = 0; f < input.file.mesh.face_count(); ++f)
        input.label.push_back(labels.label[input.file.mesh.source_of(f)]);
    return input;
}

}  // namespace exemplar
