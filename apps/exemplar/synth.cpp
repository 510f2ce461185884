// exemplar synth: generated labeled shapes.

#include <fmt/format.h>

#include "apps/exemplar/arguments.h"
#include "apps/exemplar/commands.h"
#include "host/core/interrupt.h"
#include "host/core/progress.h"
#include "host/mesh/io.h"
#include "host/synth/shapes.h"

namespace exemplar {
namespace {

struct SynthOptions {
    CommonOptions common;
    std::string kind;
    std::size_t count = 1, faces = 10000;
    std::uint64_t seed = 1;
    std::filesystem::path out;
};

void run_synth(const SynthOptions& options) {
    const auto limits = apply_common_options(options.common);
    require_output_folder(options.out);
    synth_labels(options.kind);  // an unknown kind is an error before anything is counted
    Progress progress("generating " + options.kind, options.count);
    nlohmann::json shapes = nlohmann::json::array();
    for (std::size_t i = 0; i < options.count; ++i) {
        check_interrupt();
        const SynthShape shape = make_shape(options.kind, options.seed + i, options.faces);
        const std::string name = fmt::format("{}_{:03}", options.kind, options.seed + i);
        write_labels_txt(options.out / (name + "_labels.txt"), shape.labels);
        write_off(options.out / (name + ".off"), shape.mesh);
        shapes.push_back({{"name", name}, {"faces", shape.mesh.face_count()}, {"vertices", shape.mesh.vertex_count()}});
        progress.advance();
    }
    progress.finish();
    fmt::print("{} {} in {}\n", options.count, options.count == 1 ? "shape" : "shapes", options.out.string());
    write_report(options.common, {{"kind", options.kind}, {"seed", options.seed}, {"shapes", shapes}});
}

}  // namespace

void add_synth_command(CLI::App& app) {
    auto options = std::make_shared<SynthOptions>();
    CLI::App* command = app.add_subcommand("synth", "Generates labeled shapes (NAME.off and NAME_labels.txt)");
    command->footer(fmt::format("Kinds: {}\n\nExample:\n  exemplar synth human --count 8 --seed 1 --out shapes",
                                fmt::join(synth_kinds(), " ")));
    command->add_option("KIND", options->kind, "what to generate")->required()->type_name("");
    command->add_option("--count", options->count, "number of shapes")->capture_default_str()->check(whole_number(1));
    command->add_option("--seed", options->seed, "seed of the first shape; the next ones count up")
        ->capture_default_str()
        ->check(whole_number(0));
    command->add_option("--faces", options->faces, "faces per shape, about")
        ->capture_default_str()
        ->check(whole_number(500, 200000));
    command->add_option("--out", options->out, "folder to write to")->required()->type_name("FOLDER");
    add_common_options(*command, options->common);
    command->callback([options] { run_synth(*options); });
}

}  // namespace exemplar
