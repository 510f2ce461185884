// exemplar label simulate: plays a person who labels the shapes of a folder, to measure how long that takes.

#include <fmt/format.h>

#include <cstdio>
#include <map>

#include "apps/exemplar/arguments.h"
#include "apps/exemplar/backend.h"
#include "apps/exemplar/commands.h"
#include "apps/exemplar/label/training_run.h"
#include "host/core/errors.h"
#include "host/core/progress.h"
#include "host/core/stopwatch.h"
#include "host/core/text.h"
#include "host/labeling/features/feature_cache.h"
#include "host/labeling/inference/crf.h"
#include "host/labeling/inference/mesh_labeling.h"
#include "host/labeling/painting/folder_simulation.h"

namespace exemplar {
namespace {

struct SimulateOptions {
    CommonOptions common;
    std::vector<std::filesystem::path> sources;
    std::filesystem::path cache = default_feature_folder();
    double percent = 95;
    std::vector<std::string> ways;
    SimulationOptions simulation;
};

const std::map<std::string, LabelingWay> k_labeling_ways{
    {"alone", LabelingWay::each_alone}, {"gain", LabelingWay::order_by_gain}, {"random", LabelingWay::random_order}};

std::vector<std::string> checked_ways(const std::vector<std::string>& words) {
    for (const std::string& word : words)
        if (!k_labeling_ways.contains(word))
            throw UsageError(
                fmt::format("--order: there is no '{}'; choose among alone, random, gain", word.substr(0, 40)));
    return words;
}

/// Returns the seconds to label all faces one by one, until `share` of the surface is labeled.
double seconds_by_hand(const LabeledCorpus& corpus, double share, const PersonCosts& costs) {
    double seconds = 0;
    for (const LabeledMesh& mesh : corpus.meshes)
        seconds += costs.open + costs.face * share * static_cast<double>(mesh.mesh.face_count());
    return seconds;
}

/// Returns the number of connected pieces of one label, without slivers.
std::size_t count_parts(const LabeledCorpus& corpus, const std::vector<MeshFeatures>& features) {
    constexpr float k_sliver = 0.002F;  ///< share of the surface
    std::size_t parts = 0;
    for (std::size_t m = 0; m < features.size(); ++m) {
        const LabelComponents pieces =
            label_components(features[m].edges, features[m].face_area, corpus.meshes[m].label);
        for (std::size_t p = 0; p < pieces.label.size(); ++p)
            parts += pieces.label[p] >= 0 && pieces.area_share[p] >= k_sliver ? 1 : 0;
    }
    return parts;
}

nlohmann::json simulate_way(const LabeledCorpus& corpus, std::vector<MeshFeatures>& features,
                            const LabelingBackend& backend, const SimulationOptions& options, const std::string& way) {
    const Stopwatch watch;
    Progress progress("labeling (shapes)", corpus.meshes.size());
    std::size_t verified = 0;
    FolderSimulation folder(corpus, features, backend, options, [&](const SimulationState& now) {
        progress.advance(now.verified - verified);
        verified = now.verified;
    });
    const SimulationResult result = folder.run(k_labeling_ways.at(way));
    progress.finish();
    nlohmann::json states = nlohmann::json::array();
    for (const SimulationState& state : result.states)
        states.push_back({state.seconds, state.right, state.verified, state.strokes});
    return {{"order", way},
            {"seconds", result.seconds_until(options.quality)},
            {"strokes", result.states.back().strokes},
            {"verified", result.states.back().verified},
            {"states", states},
            {"wall_seconds", watch.wall()}};
}

void run_simulate(const SimulateOptions& options) {
    const auto limits = apply_common_options(options.common);
    const std::filesystem::path cache = usable_cache(options.cache, options.common.quiet);
    const LabeledCorpus corpus = working_corpus(load_corpus(meshes_of_arguments(options.sources)));
    DeviceBackend backend(options.common.device);
    std::vector<MeshFeatures> features = features_of(corpus, suggestion_training().features, cache);
    nlohmann::json runs = nlohmann::json::array();
    const std::size_t parts = count_parts(corpus, features);
    fmt::print("seconds until {} % of the surface of {} with {} are right:\n", options.percent,
               counted(corpus.meshes.size(), "shape"), counted(parts, "part"));
    fmt::print("{:>8} {:>9} {:>8} {:>9}\n", "order", "seconds", "strokes", "verified");
    SimulationOptions simulation = options.simulation;
    simulation.quality = options.percent / 100;
    for (const std::string& way : options.ways) {
        runs.push_back(simulate_way(corpus, features, backend.labeling(), simulation, way));
        fmt::print("{:>8} {:>9.1f} {:>8} {:>9}\n", way, runs.back()["seconds"].get<double>(),
                   runs.back()["strokes"].get<std::size_t>(), runs.back()["verified"].get<std::size_t>());
        std::fflush(stdout);  // a way takes minutes
    }
    const double by_hand = seconds_by_hand(corpus, simulation.quality, simulation.costs);
    fmt::print("{:>8} {:>9.0f}\n", "by hand", by_hand);
    write_report(options.common, {{"meshes", corpus.meshes.size()},
                                  {"parts", parts},
                                  {"quality", simulation.quality},
                                  {"seconds_by_hand", by_hand},
                                  {"runs", runs}});
}

}  // namespace

void add_simulate_command(Command& label) {
    auto options = std::make_shared<SimulateOptions>();
    options->ways = {"alone", "random", "gain"};
    Command* command =
        label.add_subcommand("simulate", "Measures how long a person takes to label a folder, by playing one");
    command->footer(
        "The labels of all meshes must be known. The person opens shapes, paints strokes at the middle of the largest\n"
        "wrong region, and accepts suggested shapes.\n\nExample:\n"
        "  exemplar label simulate psb/labeled/Cup --quality 95 --json cup.json");
    command->add_option("MESH", options->sources, "labeled meshes, folders of meshes, or lists (.txt, a path a line)")
        ->required()
        ->type_name("");
    command->add_option("--quality", options->percent, "percent of the surface that must be right")
        ->capture_default_str()
        ->check(in_range(1, 100))
        ->type_name("PERCENT");
    command
        ->add_list_option(
            "--order", [options](const std::vector<std::string>& words) { options->ways = checked_ways(words); },
            "alone: each shape is painted, nothing is learned; random, gain: a model suggests labels")
        ->delimiter(',')
        ->allow_extra_args(false)
        ->check(completion_words({"alone", "random", "gain"}));
    PersonCosts& costs = options->simulation.costs;
    command->add_option("--open", costs.open, "seconds to open a shape")->capture_default_str();
    command->add_option("--stroke", costs.stroke, "seconds of a stroke")->capture_default_str();
    command->add_option("--verify", costs.verify, "seconds to accept or reject a shape")->capture_default_str();
    command->add_option("--face", costs.face, "seconds to label a face by hand")->capture_default_str();
    command->add_option("--seed", options->simulation.seed, "seed of training and of the random order")
        ->capture_default_str()
        ->check(whole_number(0));
    command->add_option("--cache", options->cache, "folder that remembers features; '' remembers none")
        ->capture_default_str()
        ->type_name("FOLDER");
    add_device_option(*command, options->common);
    add_common_options(*command, options->common);
    command->callback([options] { run_simulate(*options); });
}

}  // namespace exemplar
