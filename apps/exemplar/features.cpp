// exemplar features: the feature vectors of one mesh as a NumPy array.

#include <fmt/format.h>

#include "apps/exemplar/arguments.h"
#include "apps/exemplar/commands.h"
#include "apps/exemplar/common_options.h"
#include "host/core/errors.h"
#include "host/core/stopwatch.h"
#include "host/data/npy.h"
#include "host/labeling/features/features.h"
#include "host/labeling/inference/mesh_labeling.h"
#include "host/mesh/io/io.h"

namespace exemplar {
namespace {

struct FeaturesOptions {
    CommonOptions common;
    std::filesystem::path mesh, out, names;
    bool pairwise = false;
    FeatureOptions features;
};

/// Large meshes are simplified. A face has the features of its simplified face; edges have no such counterpart.
void announce_simplification(const FeaturesOptions& options, std::size_t faces) {
    if (options.pairwise)
        throw UsageError(fmt::format("{}: has {} faces; features of edges take {} at most: simplify it first",
                                     options.mesh.string(), faces, k_max_working_faces));
    if (!options.common.quiet)
        fmt::print(stderr, "note: {}: {} faces are simplified to about {}; each gets the features of the nearest\n",
                   options.mesh.string(), faces, k_max_working_faces);
}

void run_features(const FeaturesOptions& options) {
    const auto limits = apply_common_options(options.common);
    require_output_file(options.out);
    require_output_file(options.names);
    require_input(options.mesh);
    const MeshFile file = read_mesh(options.mesh);
    const std::vector<std::string> warnings = mesh_warnings(file, options.mesh, options.common.quiet);
    const Stopwatch watch;
    const bool large = file.mesh.face_count() > k_max_working_faces;
    if (large) announce_simplification(options, file.mesh.face_count());
    const SimplifiedMesh working = of_file(options.mesh, [&] { return working_mesh(file.mesh); });
    const MeshFeatures features = compute_features(working.mesh, options.features);
    const FeatureMatrix& matrix = options.pairwise ? features.pairwise : features.unary;
    const std::size_t rows = options.pairwise ? matrix.rows : working.face_of.size();
    write_npy(options.out, matrix, options.pairwise ? std::span<const std::uint32_t>() : working.face_of);
    if (!options.names.empty()) write_json(options.names, matrix.names);

    nlohmann::json seconds;
    for (const auto& [family, time] : features.seconds) {
        fmt::print("{:>16} {:8.3f} s\n", family, time);
        seconds[family] = time;
    }
    fmt::print("{} x {} features of {} in {:.2f} s\n", rows, matrix.cols(), options.mesh.string(), watch.wall());
    write_report(options.common, {{"mesh", options.mesh.string()},
                                  {"rows", rows},
                                  {"features", matrix.cols()},
                                  {"names", matrix.names},
                                  {"warnings", warnings},
                                  {"seconds", watch.wall()},
                                  {"cpu_seconds", watch.cpu()},
                                  {"seconds_per_family", seconds}});
}

}  // namespace

void add_features_command(Command& app) {
    auto options = std::make_shared<FeaturesOptions>();
    Command* command =
        app.add_subcommand("features", "Computes the features of a mesh (faces x features, float32 .npy)");
    command->footer("Example:\n  exemplar features horse.off --out horse.npy --names horse.json");
    command->add_option("MESH", options->mesh, k_mesh_argument)->required()->type_name("");
    command->add_option("--out", options->out, "array to write, NumPy format")->required()->type_name("FILE");
    command->add_option("--names", options->names, "also write the feature names, a JSON list")->type_name("FILE");
    command->add_flag("--pairwise", options->pairwise, "features of the interior edges instead of the faces");
    command
        ->add_option("--samples", options->features.samples, "faces that stand for the surface in distance statistics")
        ->capture_default_str()
        ->check(whole_number(1, k_max_samples));
    command->add_flag("--orientation", options->features.orientation,
                      "add coordinates, for shapes that share an orientation");
    add_common_options(*command, options->common);
    command->callback([options] { run_features(*options); });
}

}  // namespace exemplar
