// exemplar label train: learns a labeling model from labeled meshes.

#include <fmt/format.h>

#include "apps/exemplar/arguments.h"
#include "apps/exemplar/backend.h"
#include "apps/exemplar/commands.h"
#include "apps/exemplar/label/rig_examples.h"
#include "apps/exemplar/label/training_run.h"
#include "host/core/stopwatch.h"
#include "host/labeling/inference/mesh_labeling.h"

namespace exemplar {
namespace {

struct TrainCommand {
    CommonOptions common;
    std::vector<std::filesystem::path> sources;
    std::filesystem::path out, labels;
    std::filesystem::path cache = default_feature_folder();
    double memory = k_feature_gigabytes;
    RigExamples rigs;
    TrainOptions train;
};

/// The labeled meshes of SOURCE, and those of characters.
LabeledCorpus training_corpus(const TrainCommand& options) {
    if (options.sources.empty() && options.rigs.characters.empty())
        throw UsageError("give labeled meshes (SOURCE), or characters with --from-rig");
    LabeledCorpus corpus;
    if (!options.sources.empty()) corpus = load_corpus(meshes_of_arguments(options.sources), {}, options.labels);
    add_rig_examples(options.rigs, options.common.quiet, corpus);
    return corpus;
}

void run_label_train(const TrainCommand& options) {
    const auto limits = apply_common_options(options.common);
    const Stopwatch watch;
    require_output_file(options.out);
    const std::filesystem::path cache = usable_cache(options.cache, options.common.quiet);
    if (!options.labels.empty()) require_input(options.labels);
    const LabeledCorpus corpus = working_corpus(training_corpus(options));
    if (!options.common.quiet)
        for (const std::string& warning : corpus.warnings) fmt::print(stderr, "warning: {}\n", warning);
    DeviceBackend backend(options.common.device);
    TrainingFeatures features = training_features(corpus, options.train.features, cache, options.memory);
    const double feature_seconds = watch.wall();
    TrainReport report;
    const LabelingModel model = train_labeling(corpus, features, options.train, backend.labeling(), report);
    save_model(options.out, model);

    print_training(model, report);
    fmt::print("{} {}, {} labels: {} in {:.1f} s (features {:.1f} s)\n", corpus.meshes.size(),
               corpus.meshes.size() == 1 ? "mesh" : "meshes", corpus.names.size(), options.out.string(), watch.wall(),
               feature_seconds);
    nlohmann::json json = describe_training(model, report);
    json["model"] = options.out.string();
    json["device"] = backend.device_name();
    json["seconds"] = {{"features", feature_seconds}, {"all", watch.wall()}, {"cpu", watch.cpu()}};
    write_report(options.common, json);
}

}  // namespace

void add_training_options(Command& command, TrainOptions& options, std::filesystem::path& cache) {
    command.add_option("--seed", options.seed, "seed of all random choices; equal seeds give equal model files")
        ->capture_default_str()
        ->check(whole_number(0));
    command.add_option("--rounds", options.rounds, "boosting rounds per classifier (for boundaries at most)")
        ->capture_default_str()
        ->check(whole_number(1, 100000));
    command
        .add_option("--patience", options.patience,
                    "the boundary classifiers end so many rounds after they are best on held-out meshes")
        ->capture_default_str()
        ->check(whole_number(1));
    command.add_option("--stages", options.max_stages, "most classifiers of the cascade")
        ->capture_default_str()
        ->check(whole_number(1, 64));
    command.add_option("--bins", options.bins, "histogram bins per feature")
        ->capture_default_str()
        ->check(whole_number(2, 256));
    command.add_option("--rows", options.rows_per_mesh, "faces of each mesh to boost on, drawn at random; 0 takes all")
        ->capture_default_str()
        ->check(whole_number(0));
    command
        .add_option("--feature-fraction", options.feature_fraction,
                    "share of the features that each boosting round looks at, drawn at random")
        ->capture_default_str()
        ->check(in_range(0.001, 1.0));
    command.add_option("--shrinkage", options.shrinkage, "what each stump's response is multiplied with")
        ->capture_default_str()
        ->check(in_range(0.01, 1.0));
    command.add_flag_callback(
        "--no-linear", [&options] { options.linear = false; },
        "boosted stumps alone, not pooled with linear classifiers where that is better on held-out meshes");
    command.add_flag_callback(
        "--no-boundary", [&options] { options.boundary = false; },
        "no classifier of where parts end: borders cost by length and angle alone");
    command
        .add_option("--samples", options.features.samples, "faces that stand for the surface in distance statistics")
        ->capture_default_str()
        ->check(whole_number(1, k_max_samples));
    command
        .add_word_option(
            "--orientation", [&options](const std::string& use) { options.orientation = orientation_use(use); },
            "know faces also by where they are: yes, no, or auto, where held-out meshes tell that all lie alike")
        ->default_str("auto")
        ->check(one_of(orientation_uses()))
        ->type_name("");
    command.add_option("--cache", cache, "folder that remembers features; '' remembers none")
        ->capture_default_str()
        ->type_name("FOLDER");
}

void add_train_command(Command& label) {
    auto options = std::make_shared<TrainCommand>();
    Command* command = label.add_subcommand("train", "Learns a model from labeled meshes");
    command->footer(
        "Labels: NAME_labels.txt beside NAME.off (a label name, then a line of 1-based face numbers, and so on),\n"
        "or a PLY with a per-face 'label' property.\n\nExample:\n"
        "  exemplar label train shapes --out human.safetensors --seed 1\n"
        "  exemplar label train --from-rig character.glb --poses 8 --out human.safetensors");
    command
        ->add_option(
            "SOURCE", options->sources,
            "labeled meshes: folders, lists (.txt, a path a line) or mesh files; equal label names are one label")
        ->type_name("");
    command->add_option("--labels", options->labels, "folder of the NAME_labels.txt, if they are not beside the meshes")
        ->type_name("FOLDER");
    command->add_option("--out", options->out, "model file to write, .safetensors")->required()->type_name("FILE");
    add_rig_example_options(*command, options->rigs);
    add_training_options(*command, options->train, options->cache);
    add_feature_memory_option(*command, options->memory);
    add_device_option(*command, options->common);
    add_common_options(*command, options->common);
    command->callback([options] { run_label_train(*options); });
}

}  // namespace exemplar
