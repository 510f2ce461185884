// exemplar label rig: a skeleton and skin weights from the labeled parts of a mesh.

#include <fmt/format.h>

#include "apps/exemplar/arguments.h"
#include "apps/exemplar/commands.h"
#include "apps/exemplar/parts/labeled_input.h"
#include "host/animation/write_animation.h"
#include "host/core/stopwatch.h"
#include "host/core/text.h"
#include "host/mesh/label_files/label_files.h"
#include "host/parts/rigging/bend_clip.h"
#include "host/parts/rigging/joint_error.h"
#include "host/parts/rigging/make_rig.h"

namespace exemplar {
namespace {

struct RigCommand {
    CommonOptions common;
    LabeledInputArguments input;
    std::filesystem::path out, pose, truth;
    RigOptions rig;
    double degrees = 30;
};

std::vector<float> numbers_of_point(const Vec3& p) {
    return {p[0], p[1], p[2]};
}

nlohmann::json describe_joints(const PartRig& rig, const std::vector<std::string>& names) {
    nlohmann::json joints = nlohmann::json::array();
    for (const Joint& joint : rig.skeleton.joints) {
        const Part& part = rig.graph.parts[joint.part];
        nlohmann::json json{
            {"joint", joint.name},
            {"label", part.label < 0 ? nlohmann::json() : nlohmann::json(names[static_cast<std::size_t>(part.label)])},
            {"parent", nullptr},
            {"head", numbers_of_point(joint.head)},
            {"tail", numbers_of_point(joint.tail)},
            {"area", part.area}};
        if (joint.parent != k_invalid_index) {
            json["parent"] = rig.skeleton.joints[joint.parent].name;
            json["boundary_length"] = rig.graph.boundaries[joint.boundary].length;
        }
        joints.push_back(std::move(json));
    }
    return joints;
}

/// The options, with what the model knows of pairs of labels.
RigOptions rig_options(const RigCommand& options, const LabeledInput& input) {
    RigOptions rig = options.rig;
    rig.costs = pair_costs(input);
    return rig;
}

/// Rigs are written near the origin: floats would not hold the detail of a mesh that is far from it.
void warn_of_origin(const LabeledInput& input, bool quiet) {
    const Vec3d& origin = input.file.mesh.origin;
    if (origin != Vec3d::Zero() && !quiet)
        fmt::print(stderr, "warning: {}: is far from the origin; the rig is near it: add ({}, {}, {}) to its places\n",
                   input.path.string(), origin[0], origin[1], origin[2]);
}

/// Compares the joints with those of the labels in `truth`, and prints the share that is near.
nlohmann::json compare_with_truth(const RigCommand& options, const LabeledInput& input, const PartRig& rig) {
    const TriangleMesh& mesh = input.file.mesh;
    const FaceLabels truth = read_face_labels(options.truth, mesh);
    std::vector<std::int32_t> label;
    label.reserve(mesh.face_count());
    for (std::uint32_t f = 0; f < mesh.face_count(); ++f) label.push_back(truth.label[mesh.source_of(f)]);
    const PartRig true_rig = make_skeleton(mesh, truth.names, label, rig_options(options, input));
    const BoundingBox box = bounding_box(mesh);
    const double height = (box.high - box.low).maxCoeff();
    nlohmann::json joints = nlohmann::json::array();
    std::size_t near = 0;
    for (const JointError& error :
         joint_errors({true_rig.skeleton, true_rig.graph, truth.names}, {rig.skeleton, rig.graph, input.names})) {
        joints.push_back({{"labels", error.labels}, {"distance", nullptr}});
        if (error.distance) joints.back()["distance"] = *error.distance / height;
        if (error.distance && *error.distance <= 0.05 * height) ++near;
    }
    fmt::print("{} of {} joints of {} found within 5 % of the height\n", near, joints.size(), options.truth.string());
    return {{"labels", options.truth.string()}, {"height", height}, {"joints", joints}, {"within_5_percent", near}};
}

void run_rig(const RigCommand& options) {
    const auto limits = apply_common_options(options.common);
    const Stopwatch watch;
    require_output_file(options.out);
    if (lower_case(options.out.extension().string()) != ".glb")
        throw UsageError(options.out.string() + ": rigs are written as binary glTF; name a .glb file");
    for (const auto& path : {options.pose, options.truth})
        if (!path.empty()) require_input(path);
    const std::vector<JointAngles> poses = options.pose.empty() ? std::vector<JointAngles>() : read_poses(options.pose);
    const LabeledInput input = read_labeled_input(options.input, options.common);
    require_not_replaced(options.out, {input.path, input.source});
    PartRig rig = of_file(
        input.path, [&] { return make_rig(input.file.mesh, input.names, input.label, rig_options(options, input)); });
    warn_of_origin(input, options.common.quiet);
    Animation& animation = rig.animation;
    animation.clips.push_back(poses.empty() ? bend_each_joint(animation.rig, options.degrees)
                                            : clip_of_poses(animation.rig, poses, options.pose.string()));
    write_gltf_animation(options.out, animation);
    fmt::print("{}: {}, {} of clip '{}': {} in {:.1f} s\n", input.path.string(),
               counted(rig.skeleton.joints.size(), "joint"), counted(animation.clips[0].size(), "frame"),
               animation.clips[0].name, options.out.string(), watch.wall());
    nlohmann::json json{{"mesh", input.path.string()},
                        {"labels", input.source},
                        {"rig", options.out.string()},
                        {"origin", {input.file.mesh.origin[0], input.file.mesh.origin[1], input.file.mesh.origin[2]}},
                        {"mirror_normal", nullptr},
                        {"joints", describe_joints(rig, input.names)},
                        {"clip", animation.clips[0].name},
                        {"frames", animation.clips[0].size()}};
    if (rig.mirror) json["mirror_normal"] = numbers_of_point(rig.mirror->normal);
    if (!options.truth.empty()) json["truth"] = compare_with_truth(options, input, rig);
    json["seconds"] = watch.wall();
    write_report(options.common, json);
}

}  // namespace

void add_rig_command(Command& label) {
    auto options = std::make_shared<RigCommand>();
    Command* command = label.add_subcommand("rig", "Makes a skeleton and skin weights from the parts of a mesh");
    command->footer(
        "Each connected piece of a label is a part with a bone; joints lie at the centers of the boundaries between\n"
        "parts. The .glb has a clip that bends each joint in turn, or the poses of --pose.\n\nExample:\n"
        "  exemplar label rig human.safetensors mesh.obj --root torso --out rigged.glb --json rigged.json\n"
        "  exemplar label rig labeled.ply --pose wave.json --out waving.glb");
    add_labeled_input(*command, options->input, options->common);
    command->add_option("--out", options->out, "rig to write, .glb")->required()->type_name("FILE");
    command->add_option("--root", options->rig.root, "label of the part that all others hang on (default: the largest)")
        ->type_name("LABEL");
    command->add_flag("--swap-sides", options->rig.swap_sides,
                      "exchange left and right in names: left is +x, if the mirror plane is across x");
    command->add_option("--falloff", options->rig.falloff, "reach of a bend over the skin, in radii of the boundary")
        ->capture_default_str()
        ->check(in_range(0.0, 10.0));
    command->add_option("--degrees", options->degrees, "how far the clip bends each joint")
        ->capture_default_str()
        ->check(in_range(0.0, 180.0));
    command
        ->add_option("--pose", options->pose,
                     "poses as JSON: {\"joint\": [x, y, z] in degrees, ...}, or a list of them")
        ->type_name("FILE");
    command->add_option("--truth", options->truth, "true labels of the mesh: report how far the joints are from theirs")
        ->type_name("FILE");
    add_common_options(*command, options->common);
    command->callback([options] { run_rig(*options); });
}

}  // namespace exemplar
