// exemplar curvature study: errors on unseen frames against what training is given and keeps.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <functional>
#include <utility>

#include "apps/exemplar/animation_arguments.h"
#include "apps/exemplar/arguments.h"
#include "apps/exemplar/common_options.h"
#include "apps/exemplar/curvature/curvature_options.h"
#include "host/core/errors.h"
#include "host/core/statistics.h"
#include "host/core/stopwatch.h"

namespace exemplar {
namespace {

struct StudyOptions {
    CommonOptions common;
    std::filesystem::path animation, test;
    FrameArguments frames, test_frames;
    CurvatureArguments curvature;
};

/// One training that differs from the one asked for in a single thing.
struct Variation {
    std::string what, value;
    CurvatureTraining training;
    std::size_t poses;
};

bool same_file(const std::filesystem::path& a, const std::filesystem::path& b) {
    std::error_code error;
    return std::filesystem::equivalent(a, b, error);
}

/// Returns the frames to test on without those that are learned from.
std::vector<FrameRef> unseen_frames(std::vector<FrameRef> test, const std::vector<FrameRef>& seen) {
    std::erase_if(test, [&](const FrameRef& frame) {
        return std::ranges::any_of(
            seen, [&](const FrameRef& other) { return other.clip == frame.clip && other.frame == frame.frame; });
    });
    if (test.empty())
        throw UsageError(
            "all frames are learned from, none is left to test on; leave some out by --frames or --clips, or name "
            "another motion by --test");
    return test;
}

/// The variations of Figs. 5.6, 5.8, 5.10, 5.12 and 5.14, and of sparsity.
std::vector<Variation> variations(const CurvatureTraining& given, std::size_t poses) {
    std::vector<Variation> result{{"as given", "", given, poses}};
    for (std::size_t few = k_min_poses; few < poses; few *= 2)
        result.push_back({"poses", std::to_string(few), given, few});
    // `what` is an option that sets this member of the training.
    const auto vary = [&](const char* what, auto member, const auto& values) {
        for (const auto& value : values) {
            Variation variation{what, "", given, poses};
            std::invoke(member, variation.training) = value;
            variation.value = training_words(variation.training).at(what);
            if (variation.value != training_words(given).at(what)) result.push_back(std::move(variation));
        }
    };
    if (given.learner == Learner::local) {
        const auto patch_inputs = [](CurvatureTraining& training) -> std::size_t& {
            return training.sequence.max_inputs;
        };
        vary("patch-inputs", patch_inputs, std::to_array<std::size_t>({2, 4, 8, 12, 24}));
    } else {
        vary("variance", &CurvatureTraining::variance, std::array{0.8, 0.9, 0.95, 0.99, 0.999});
        vary("bases", &CurvatureTraining::independent, std::array{true, false});
    }
    vary("sparsity", &CurvatureTraining::dropped_variance, std::array{0.0, 0.002, 0.01, 0.05});
    vary("attributes", &CurvatureTraining::attributes, std::array{AttributeSet::tensor, AttributeSet::principal});
    return result;
}

/// The line types of the thesis' figures.
constexpr std::array<LineType, 4> k_study_faces{LineType::suggestive_contours, LineType::ridges, LineType::valleys,
                                                LineType::apparent_ridges};

const LineError& error_of(const CurvatureEvaluation& evaluation, LineType type) {
    return *std::ranges::find(evaluation.lines, type, &LineError::type);
}

void print_head() {
    fmt::print("{:<24}{:>9}{:>9}", "faces wrong, %", "MB", "train s");
    for (const LineType type : k_study_faces) fmt::print("{:>22}", name_of(type));
    fmt::print("\n");
}

void print_study_row(const std::string& name, double bytes, double seconds, const CurvatureEvaluation& evaluation,
                     double LineError::*share) {
    fmt::print("{:<24}{:>9.2f}{:>9.1f}", name, 1e-6 * bytes, seconds);
    for (const LineType type : k_study_faces) fmt::print("{:>22.2f}", 100 * error_of(evaluation, type).*share);
    fmt::print("\n");
    std::fflush(stdout);
}

nlohmann::json run_variation(const Variation& variation, const Animation& animation,
                             const std::vector<FrameRef>& frames, const Animation& test,
                             const std::vector<FrameRef>& test_frames) {
    const Stopwatch watch;
    CurvatureTrainingReport report;
    const CurvatureModel model =
        train_curvature(animation, evenly_spaced(frames, variation.poses), variation.training, report);
    const double seconds = watch.wall();
    require_compatible(model, test);
    const CurvatureEvaluation evaluation = evaluate_curvature(model, test, test_frames);
    const auto bytes = static_cast<double>(report.model_bytes);
    if (variation.what == "as given") {
        print_head();
        print_study_row("zero order", 0, 0, evaluation, &LineError::zero_order);
    }
    print_study_row(fmt::format("{} {}", variation.what, variation.value), bytes, seconds, evaluation,
                    &LineError::misclassified);
    return {{"what", variation.what},
            {"value", variation.value},
            {"training", describe_training(report)},
            {"seconds", seconds},
            {"evaluation", describe_evaluation(evaluation)}};
}

void run_study(const StudyOptions& options) {
    const auto limits = apply_common_options(options.common);
    const auto read = [&](const std::filesystem::path& path, std::uint64_t seed) {
        return animation_of_argument(path, options.curvature.frames_per_second, seed, options.common.quiet);
    };
    const Animation animation = read(options.animation, options.curvature.training.seed);
    const std::vector<FrameRef> frames = select_frames(animation, selection_of(options.frames));
    const bool same = options.test.empty() || same_file(options.test, options.animation);
    const Animation other = same ? Animation{} : read(options.test, options.curvature.training.seed + 1);
    const Animation& test = same ? animation : other;
    std::vector<FrameRef> test_frames = select_frames(test, selection_of(options.test_frames));
    if (same) test_frames = unseen_frames(std::move(test_frames), frames);

    nlohmann::json rows = nlohmann::json::array();
    const CurvatureTraining training = training_of(options.curvature, animation.kind);
    for (const Variation& variation : variations(training, frames.size()))
        rows.push_back(run_variation(variation, animation, frames, test, test_frames));
    write_report(options.common, {{"animation", options.animation.string()},
                                  {"test", same ? options.animation.string() : options.test.string()},
                                  {"poses", frames.size()},
                                  {"test_frames", test_frames.size()},
                                  {"rows", rows}});
}

}  // namespace

void add_curvature_study_command(Command& curvature) {
    auto options = std::make_shared<StudyOptions>();
    Command* command = curvature.add_subcommand(
        "study", "Trains again and again: errors on unseen frames against poses, variance, bases and size");
    command->footer(
        "Each row differs from the training asked for in one thing. Frames that are learned from are never tested on.\n"
        "MB are those of means and bases, which a frame reads.\n\nExample:\n"
        "  exemplar curvature study figure.glb --frames :100 --json study.json");
    command->add_option("ANIM", options->animation, k_animation_argument)->required()->type_name("");
    add_frame_options(*command, options->frames, "", "learn from");
    command->add_option("--test", options->test, "another motion of the same surface to test on; default: ANIM")
        ->type_name("ANIM");
    add_frame_options(*command, options->test_frames, "test-", "test on");
    add_curvature_options(*command, options->curvature);
    add_common_options(*command, options->common);
    command->callback([options] { run_study(*options); });
}

}  // namespace exemplar
