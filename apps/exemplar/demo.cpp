// exemplar demo: the main job on built-in data, from generated shapes to a page that shows how unseen ones are labeled.

#include <fmt/format.h>

#include "apps/exemplar/backend.h"
#include "apps/exemplar/commands.h"
#include "apps/exemplar/evaluation_run.h"
#include "host/core/interrupt.h"
#include "host/core/stopwatch.h"
#include "host/mesh/io.h"
#include "host/synth/shapes.h"

namespace exemplar {
namespace {

namespace fs = std::filesystem;

struct DemoOptions {
    CommonOptions common;
    fs::path out = "out/demo";
    std::vector<std::string> kinds;
    std::size_t train_count = 6, test_count = 4, faces = 5000;
    std::uint64_t seed = 1;
};

/// Generates the shapes of one kind as labeled files, unless they are there from an earlier run.
EvaluationTask generate(const DemoOptions& options, const std::string& kind, Progress& progress) {
    EvaluationTask task{kind, "demo", {}, {}, {}};
    for (std::size_t i = 0; i < options.train_count + options.test_count; ++i) {
        check_interrupt();
        const fs::path stem =
            options.out / "shapes" / kind / fmt::format("{}_{}_{}", kind, options.faces, options.seed + i);
        const fs::path mesh = stem.string() + ".off";
        if (!fs::exists(mesh)) {
            const SynthShape shape = make_shape(kind, options.seed + i, options.faces);
            write_labels_txt(stem.string() + "_labels.txt", shape.labels);
            write_off(mesh, shape.mesh);
        }
        (i < options.train_count ? task.train : task.test).push_back(mesh);
        progress.advance(1, kind);
    }
    return task;
}

void run_demo(const DemoOptions& options) {
    const auto limits = apply_common_options(options.common);
    const Stopwatch watch;
    std::vector<std::string> kinds = options.kinds;
    if (kinds.empty())
        for (const std::string_view kind : synth_kinds()) kinds.emplace_back(kind);
    DeviceBackend backend(options.common.device);
    std::vector<EvaluationTask> tasks;
    {
        Progress progress("generating shapes", kinds.size() * (options.train_count + options.test_count));
        for (const std::string& kind : kinds) tasks.push_back(generate(options, kind, progress));
    }
    TrainOptions train;
    train.seed = options.seed;
    train.rounds = 120, train.patience = 20, train.rows_per_mesh = 1500;  // a demonstration, in minutes
    EvaluationRun run(backend, train, options.out / "features", options.out, true);
    const nlohmann::json report =
        run.evaluate(tasks, "demo", "Exemplar: parts of unseen shapes, learned from examples");
    for (const auto& category : report["categories"])
        fmt::print("{:>12}: {:.1f} % of the surface of {} unseen shapes labeled right\n",
                   category["category"].get<std::string>(), 100 * rate_of(category, "recognition_rate"),
                   category["meshes"].get<std::size_t>());
    fmt::print("{} in {:.0f} s on {}\nopen {}\n", "done", watch.wall(), backend.device_name(),
               fs::absolute(options.out / "index.html").string());
    write_report(options.common, report);
}

}  // namespace

void add_demo_command(CLI::App& app) {
    auto options = std::make_shared<DemoOptions>();
    CLI::App* command =
        app.add_subcommand("demo", "Generates shapes, trains, labels unseen ones, and shows it all in a page");
    command->footer("Example:\n  exemplar demo --out out/demo");
    command->add_option("--out", options->out, "folder to write to")->capture_default_str();
    command->add_option("--kinds", options->kinds, "kinds of shapes (see 'exemplar synth --help'); all by default");
    command->add_option("--train", options->train_count, "training shapes per kind")
        ->capture_default_str()
        ->check(CLI::Range(1, 1000));
    command->add_option("--test", options->test_count, "unseen shapes per kind")
        ->capture_default_str()
        ->check(CLI::Range(1, 1000));
    command->add_option("--faces", options->faces, "faces per shape, about")
        ->capture_default_str()
        ->check(CLI::Range(500, 200000));
    command->add_option("--seed", options->seed, "seed of the shapes and the training")->capture_default_str();
    add_common_options(*command, options->common);
    command->callback([options] { run_demo(*options); });
}

}  // namespace exemplar
