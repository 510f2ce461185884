// exemplar synth: generated labeled shapes, animations, and shapes that cost much.

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "apps/exemplar/arguments.h"
#include "apps/exemplar/commands.h"
#include "apps/help/command.h"
#include "host/animation/write_animation.h"
#include "host/core/errors.h"
#include "host/core/interrupt.h"
#include "host/core/progress.h"
#include "host/core/text.h"
#include "host/mesh/io/io.h"
#include "host/synth/animations/animations.h"
#include "host/synth/arrangements/arrangements.h"
#include "host/synth/shapes/shapes.h"

namespace exemplar {
namespace {

struct SynthOptions {
    CommonOptions common;
    std::string kind;
    std::size_t count = 1, faces = 10000;
    AnimationOptions animation;
    std::uint64_t seed = 1;
    std::filesystem::path out;
};

bool is_one_of(std::span<const std::string_view> names, std::string_view name) {
    return std::find(names.begin(), names.end(), name) != names.end();
}

std::vector<std::string_view> arrangement_names() {
    std::vector<std::string_view> names;
    for (const Arrangement& arrangement : arrangements()) names.push_back(arrangement.name);
    return names;
}

std::vector<std::string> all_kinds() {
    std::vector<std::string> names;
    const auto add = [&](const auto& kinds) { names.insert(names.end(), kinds.begin(), kinds.end()); };
    add(synth_kinds());
    add(synth_animation_kinds());
    add(arrangement_names());
    return names;
}

/// Throws UsageError for an unknown kind.
void require_kind(const std::string& kind) {
    const std::vector<std::string> names = all_kinds();
    if (std::ranges::find(names, kind) != names.end()) return;
    throw UsageError(
        fmt::format("unknown kind '{}'{}; the kinds are {}", kind, suggestion(kind, names), fmt::join(names, ", ")));
}

/// Throws UsageError for an option that says nothing about this kind.
void require_fitting_options(const Command& command, const std::string& kind) {
    const auto refuse = [&](std::span<const char* const> given, std::string_view kinds, std::string_view what) {
        for (const char* option : given)
            if (command.count(option) > 0)
                throw UsageError(fmt::format("{} is not for {}: '{}' is {}", option, kinds, kind, what));
    };
    constexpr std::array k_of_shapes{"--faces"};
    constexpr std::array k_of_animations{"--vertices", "--frames", "--shape-seed"};
    constexpr std::array k_of_random_shapes{"--count", "--seed"};
    if (is_one_of(synth_animation_kinds(), kind)) return refuse(k_of_shapes, "animations", "an animation");
    refuse(k_of_animations, "shapes", "a shape");
    if (is_one_of(arrangement_names(), kind)) refuse(k_of_random_shapes, "shapes that are always the same", "one");
}

nlohmann::json write_shape(const SynthOptions& options, std::uint64_t seed) {
    const SynthShape shape = make_shape(options.kind, seed, options.faces);
    const std::string name = fmt::format("{}_{:03}", options.kind, seed);
    write_labels_txt(options.out / (name + "_labels.txt"), shape.labels);
    write_off(options.out / (name + ".off"), shape.mesh);
    return {{"name", name}, {"faces", shape.mesh.face_count()}, {"vertices", shape.mesh.vertex_count()}};
}

/// Writes a shape that costs much; the seed plays no part.
nlohmann::json write_arrangement(const SynthOptions& options, std::uint64_t /*seed*/) {
    const TriangleMesh mesh = arrangement_named(options.kind).make(options.faces);
    const std::string name = fmt::format("{}_{}", options.kind, options.faces);
    write_off(options.out / (name + ".off"), mesh);
    return {{"name", name}, {"faces", mesh.face_count()}, {"vertices", mesh.vertex_count()}};
}

nlohmann::json write_animation(const SynthOptions& options, std::uint64_t seed) {
    AnimationOptions wanted = options.animation;
    wanted.motion_seed = seed;
    const Animation animation = make_animation(options.kind, wanted);
    const std::string name = fmt::format("{}_{:03}", options.kind, seed);
    if (animation.kind == AnimationKind::sequence)
        write_sequence(options.out / name, animation);
    else
        write_gltf_animation(options.out / (name + ".glb"), animation);
    return {{"name", name},
            {"faces", animation.rest.face_count()},
            {"vertices", animation.rest.vertex_count()},
            {"frames", animation.frame_count()}};
}

void run_synth(const SynthOptions& options) {
    const auto limits = apply_common_options(options.common);
    require_output_folder(options.out);
    const bool is_animation = is_one_of(synth_animation_kinds(), options.kind);
    const auto write = is_animation                                   ? write_animation
                       : is_one_of(arrangement_names(), options.kind) ? write_arrangement
                                                                      : write_shape;
    Progress progress("generating " + options.kind, options.count);
    nlohmann::json made = nlohmann::json::array();
    for (std::size_t i = 0; i < options.count; ++i) {
        check_interrupt();
        made.push_back(write(options, options.seed + i));
        progress.advance();
    }
    progress.finish();
    fmt::print("{} in {}\n", counted(options.count, is_animation ? "animation" : "shape"), options.out.string());
    write_report(
        options.common,
        {{"kind", options.kind}, {"seed", options.seed}, {is_animation ? "animations" : "shapes", std::move(made)}});
}

void add_animation_options(Command& command, AnimationOptions& options) {
    command.add_option("--vertices", options.vertices, "vertices of an animation, about")
        ->capture_default_str()
        ->check(whole_number(500, 100'000));
    command.add_option("--frames", options.frames, "frames of an animation, 30 per second")
        ->capture_default_str()
        ->check(whole_number(1, 100'000));
    command
        .add_option("--shape-seed", options.shape_seed,
                    "seed of an animation's surface; equal ones give the same surface in other motions")
        ->capture_default_str()
        ->check(whole_number(0));
}

}  // namespace

void add_synth_command(Command& app) {
    auto options = std::make_shared<SynthOptions>();
    Command* command = app.add_subcommand("synth",
                                          "Generates labeled shapes (NAME.off and NAME_labels.txt), animations "
                                          "(NAME.glb, or a folder of PLY), and shapes "
                                          "whose features cost much (NAME.off)");
    command->footer(fmt::format(
        "Kinds of shapes: {}\nKinds of animations: {}\nKinds of shapes that cost much, without labels: {}\n\n"
        "Examples:\n"
        "  exemplar synth human --count 8 --seed 1 --out shapes\n"
        "  exemplar synth figure --vertices 20000 --seed 1 --out animations",
        fmt::join(synth_kinds(), " "), fmt::join(synth_animation_kinds(), " "), fmt::join(arrangement_names(), " ")));
    command->add_option("KIND", options->kind, "what to generate")
        ->required()
        ->check(completion_words(all_kinds()))
        ->type_name("");
    command->add_option("--count", options->count, "how many")->capture_default_str()->check(whole_number(1));
    command->add_option("--seed", options->seed, "seed of the first shape or motion; the next ones count up")
        ->capture_default_str()
        ->check(whole_number(0));
    command->add_option("--faces", options->faces, "faces per shape, about")
        ->capture_default_str()
        ->check(whole_number(500, 200000));
    add_animation_options(*command, options->animation);
    command->add_option("--out", options->out, "folder to write to")->required()->type_name("FOLDER");
    add_common_options(*command, options->common);
    command->callback([options, command] {
        require_kind(options->kind);
        require_fitting_options(*command, options->kind);
        run_synth(*options);
    });
}

}  // namespace exemplar
