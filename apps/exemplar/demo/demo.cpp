// exemplar demo: the main job on built-in data, from generated shapes to a page that shows how unseen ones are labeled,
// and a figure in lines.

#include <fmt/format.h>

#include "apps/exemplar/arguments.h"
#include "apps/exemplar/backend.h"
#include "apps/exemplar/commands.h"
#include "apps/exemplar/demo/demo_lines.h"
#include "apps/exemplar/label/evaluation_run.h"
#include "apps/help/command.h"
#include "host/core/interrupt.h"
#include "host/core/stopwatch.h"
#include "host/core/text.h"
#include "host/mesh/io/io.h"
#include "host/synth/shapes/shapes.h"

namespace exemplar {
namespace {

namespace fs = std::filesystem;

struct DemoOptions {
    CommonOptions common;
    fs::path out = "out/demo";
    std::vector<std::string> kinds;
    std::size_t train_count = 0, test_count = 4, faces = 5000;
    std::uint64_t seed = 1;
};

/// Number of training shapes of a kind: the user's, else six, or more for quadrupeds, whose nine species six cannot
/// show.
std::size_t train_count(const DemoOptions& options, const std::string& kind) {
    if (options.train_count > 0) return options.train_count;
    return kind == "fourleg" ? 12 : 6;
}

/// Generates the shapes of one kind as labeled files, unless they are there from an earlier run.
EvaluationTask generate(const DemoOptions& options, const std::string& kind, Progress& progress) {
    EvaluationTask task{kind, "demo", {}, {}, {}};
    const std::size_t examples = train_count(options, kind);
    for (std::size_t i = 0; i < examples + options.test_count; ++i) {
        check_interrupt();
        const fs::path stem =
            options.out / "shapes" / kind / fmt::format("{}_{}_{}", kind, options.faces, options.seed + i);
        const fs::path mesh = stem.string() + ".off";
        if (!fs::exists(mesh)) {
            const SynthShape shape = make_shape(kind, options.seed + i, options.faces);
            write_labels_txt(stem.string() + "_labels.txt", shape.labels);
            write_off(mesh, shape.mesh);
        }
        (i < examples ? task.train : task.test).push_back(mesh);
        progress.advance(1, kind);
    }
    return task;
}

void run_demo(const DemoOptions& options) {
    const auto limits = apply_common_options(options.common);
    require_output_folder(options.out);
    const Stopwatch watch;
    std::vector<std::string> kinds = options.kinds;
    if (kinds.empty())
        for (const std::string_view kind : synth_kinds()) kinds.emplace_back(kind);
    DeviceBackend backend(options.common.device);
    std::vector<EvaluationTask> tasks;
    {
        std::size_t shapes = 0;
        for (const std::string& kind : kinds) shapes += train_count(options, kind) + options.test_count;
        Progress progress("generating shapes", shapes);
        for (const std::string& kind : kinds) tasks.push_back(generate(options, kind, progress));
    }
    TrainOptions train;
    train.seed = options.seed;
    train.rounds = 120, train.patience = 20, train.rows_per_mesh = 1500;  // a demonstration, in minutes
    train.orientation = OrientationUse::never;                            // judging it takes one more stage
    DemoLines lines = make_demo_lines(options.out / "lines", options.seed);
    EvaluationRun run(backend, train, options.out / "features", options.out,
                      {.quiet = true, .drawings = {std::move(lines.drawing)}});
    nlohmann::json report = run.evaluate(tasks, "demo", "Exemplar: parts of unseen shapes, learned from examples");
    for (const auto& category : report["categories"])
        fmt::print("{:>12}: {:.1f} % of the surface of {} unseen shapes labeled right\n",
                   category["category"].get<std::string>(), 100 * rate_of(category, "recognition_rate"),
                   category["meshes"].get<std::size_t>());
    fmt::print("{:>12}: {:.2f} % of the faces of an unseen motion have lines that differ from measured ones\n", "lines",
               100 * lines.report["misclassified"].get<double>());
    report["lines"] = std::move(lines.report);
    fmt::print("done in {} on {}\nopen {}\n", format_seconds(watch.wall()), backend.device_name(),
               fs::absolute(options.out / "index.html").string());
    write_report(options.common, report);
}

}  // namespace

void add_demo_command(Command& app) {
    auto options = std::make_shared<DemoOptions>();
    Command* command = app.add_subcommand(
        "demo", "Generates shapes, trains, labels unseen ones, draws a figure in lines, and shows it all in a page");
    command->footer("Example:\n  exemplar demo --out out/demo");
    command->add_option("--out", options->out, "folder to write to")->capture_default_str()->type_name("FOLDER");
    command->add_option("--kinds", options->kinds, "kinds of shapes (see 'exemplar synth --help'); all by default")
        ->check(completion_words(synth_kinds()))
        ->type_name("KIND");
    command
        ->add_option("--train", options->train_count,
                     "training shapes per kind; 0 takes 6, and 12 of fourleg, which is nine species")
        ->capture_default_str()
        ->check(whole_number(0, 1000));
    command->add_option("--test", options->test_count, "unseen shapes per kind")
        ->capture_default_str()
        ->check(whole_number(1, 1000));
    command->add_option("--faces", options->faces, "faces per shape, about")
        ->capture_default_str()
        ->check(whole_number(500, 200000));
    command->add_option("--seed", options->seed, "seed of the shapes and the training")
        ->capture_default_str()
        ->check(whole_number(0));
    add_device_option(*command, options->common);
    add_common_options(*command, options->common);
    command->callback([options] { run_demo(*options); });
}

}  // namespace exemplar
