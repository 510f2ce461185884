// exemplar label transfer: labels from one mesh to another of about the same shape.

#include <fmt/format.h>

#include "apps/exemplar/arguments.h"
#include "apps/exemplar/commands.h"
#include "host/core/errors.h"
#include "host/core/stopwatch.h"
#include "host/core/text.h"
#include "host/data/corpus.h"
#include "host/mesh/label_files/label_files.h"
#include "host/parts/transfer/transfer_labels.h"

namespace exemplar {
namespace {

struct TransferCommandOptions {
    CommonOptions common;
    TransferOptions transfer;
    std::filesystem::path from, to, labels, out;
};

/// A mesh file that can be used, with remarks about it.
MeshFile read_usable(const std::filesystem::path& path, bool quiet) {
    MeshFile file = read_mesh(path);
    mesh_warnings(file, path, quiet);
    return file;
}

std::vector<std::int32_t> labels_of_triangles(const TriangleMesh& mesh, const FaceLabels& labels) {
    std::vector<std::int32_t> label(mesh.face_count());
    for (std::uint32_t f = 0; f < label.size(); ++f) label[f] = labels.label[mesh.source_of(f)];
    return label;
}

void write_transferred(const std::filesystem::path& path, const MeshFile& to, const FaceLabels& labels) {
    if (lower_case(path.extension().string()) == ".ply")
        write_ply(path, to.mesh, &labels, {}, &to.polygons);
    else
        write_labels_txt(path, labels);
}

void run_transfer(const TransferCommandOptions& options) {
    const auto limits = apply_common_options(options.common);
    if (!(options.transfer.smoothness >= 0 && options.transfer.smoothness <= 1000))
        throw UsageError(fmt::format("--smooth takes a weight from 0 to 1000, not {}", options.transfer.smoothness));
    for (const auto& path : {options.from, options.to}) require_input(path);
    require_output_file(options.out);
    require_not_replaced(options.out, {options.from, options.to, options.labels, labels_path(options.from)});
    const Stopwatch watch;
    const MeshFile from = read_usable(options.from, options.common.quiet),
                   to = read_usable(options.to, options.common.quiet);
    FaceLabels labels =
        options.labels.empty() ? labels_of_mesh(options.from, from) : read_face_labels(options.labels, from.mesh);
    const TransferredLabels found =
        transfer_labels(from.mesh, labels_of_triangles(from.mesh, labels), to.mesh, options.transfer);
    labels.label = to_source_faces(to.mesh, found.label);
    write_transferred(options.out, to, labels);
    fmt::print("{}: sure of {:.1f} % of the surface\n", options.out.string(), 100 * found.sure_share);
    if (found.sure_share < 0.5 && !options.common.quiet)
        fmt::print(stderr,
                   "warning: most of {} has no labeled surface near it; both meshes must lie in the same place\n",
                   options.to.string());
    write_report(options.common, {{"from", options.from.string()},
                                  {"to", options.to.string()},
                                  {"out", options.out.string()},
                                  {"labels", labels.names},
                                  {"triangles", to.mesh.face_count()},
                                  {"sure_share", found.sure_share},
                                  {"median_distance", found.median_distance},
                                  {"seconds", watch.wall()}});
}

}  // namespace

void add_transfer_command(Command& label) {
    auto options = std::make_shared<TransferCommandOptions>();
    Command* command = label.add_subcommand("transfer", "Transfers labels to another resolution or version of a mesh");
    command->footer(
        "Both meshes must lie in the same place. A face is sure where labeled surface is near, faces the same way,\n"
        "and agrees on the label.\n\nExample:\n"
        "  exemplar label transfer low.off high.obj --out high_labels.txt");
    command->add_option("FROM", options->from, "labeled mesh")->required()->type_name("");
    command->add_option("TO", options->to, "mesh to label")->required()->type_name("");
    command->add_option("--labels", options->labels, "labels of FROM, if they are neither beside nor in it")
        ->type_name("FILE");
    command->add_option("--out", options->out, "label file (_labels.txt), or .ply for the mesh with its labels")
        ->required()
        ->type_name("FILE");
    command->add_option("--smooth", options->transfer.smoothness, "weight of the length of borders between labels")
        ->capture_default_str()
        ->type_name("WEIGHT");
    add_common_options(*command, options->common);
    command->callback([options] { run_transfer(*options); });
}

}  // namespace exemplar
