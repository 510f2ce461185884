#include "host/parts/rigging/rig_labels.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <set>

#include "host/core/errors.h"
#include "host/core/interrupt.h"
#include "host/core/text.h"

namespace exemplar {
namespace {

/// The labels of the nodes themselves; nothing where the table has none.
std::vector<std::optional<std::string>> labels_of_nodes(const Rig& rig, const BoneTable& table,
                                                        const std::map<std::string, std::string>& renamed) {
    std::vector<std::optional<std::string>> labels;
    labels.reserve(rig.nodes.size());
    for (const RigNode& node : rig.nodes) {
        const auto other = renamed.find(node.name);
        labels.push_back(table.label_of(other == renamed.end() ? node.name : other->second));
    }
    return labels;
}

/// The names of bones that move a vertex and that the table has no entry for.
std::vector<std::string> unknown_bones(const Rig& rig, const BoneTable& table,
                                       const std::map<std::string, std::string>& renamed) {
    std::vector<bool> moves(rig.bones.size(), false);
    for (const Influence& influence : rig.influences) moves[influence.bone] = true;
    std::set<std::string> unknown;
    for (std::size_t b = 0; b < rig.bones.size(); ++b) {
        const std::string& name = rig.nodes[rig.bones[b].node].name;
        const auto other = renamed.find(name);
        if (moves[b] && !table.knows(other == renamed.end() ? name : other->second)) unknown.insert(name);
    }
    return {unknown.begin(), unknown.end()};
}

[[noreturn]] void refuse_bones(const Animation& animation, const std::vector<std::string>& unknown) {
    std::string list;
    for (std::size_t i = 0; i < unknown.size() && i < 6; ++i)
        list += (i ? ", '" : "'") + without_controls(unknown[i].substr(0, 40)) + "'";
    if (unknown.size() > 6) list += fmt::format(" and {} more", unknown.size() - 6);
    throw DataError(fmt::format(
        "{}: its bones are not those of a known human rig{}{}; name their labels with --map FILE, as {{\"{}\": "
        "\"head\", \"*\": \"-\"}}",
        animation.name, list.empty() ? "" : ": ", list,
        unknown.empty() ? "b_Head*" : without_controls(unknown[0].substr(0, 40))));
}

/// Lets nodes without a label take that above them, else the first label of all.
std::vector<std::string> inherited_labels(const Rig& rig, const std::vector<std::optional<std::string>>& own) {
    const auto first = std::find_if(own.begin(), own.end(), [](const auto& label) { return label.has_value(); });
    std::vector<std::string> labels;
    labels.reserve(own.size());
    for (std::size_t n = 0; n < own.size(); ++n) {
        const std::uint32_t parent = rig.nodes[n].parent;
        labels.push_back(own[n] ? *own[n] : parent == k_invalid_index ? **first : labels[parent]);
    }
    return labels;
}

/// The label with the largest sum of weights over the corners of a face.
std::int32_t label_of_corners(const Rig& rig, const Face& face, const std::vector<std::int32_t>& label_of_bone,
                              std::vector<float>& sum) {
    std::fill(sum.begin(), sum.end(), 0.0F);
    for (const std::uint32_t v : face)
        for (const Influence& influence : rig.influences_of(v))
            sum[static_cast<std::size_t>(label_of_bone[influence.bone])] += influence.weight;
    return static_cast<std::int32_t>(std::max_element(sum.begin(), sum.end()) - sum.begin());
}

}  // namespace

RigLabels labels_of_rig(const Animation& animation, const BoneTable& table,
                        const std::map<std::string, std::string>& renamed) {
    const Rig& rig = animation.rig;
    if (animation.kind != AnimationKind::skeleton)
        throw DataError(animation.name + ": has no skeleton; labels are taken from the bones of a skinned character");
    RigLabels result;
    result.unknown_bones = unknown_bones(rig, table, renamed);
    const auto own = labels_of_nodes(rig, table, renamed);
    std::set<std::string> names;
    for (const Bone& bone : rig.bones)
        if (own[bone.node]) names.insert(*own[bone.node]);
    if (names.size() < 2) refuse_bones(animation, result.unknown_bones);
    const std::vector<std::string> of_node = inherited_labels(rig, own);
    for (const Bone& bone : rig.bones) names.insert(of_node[bone.node]);
    result.names.assign(names.begin(), names.end());
    std::vector<std::int32_t> label_of_bone;
    label_of_bone.reserve(rig.bones.size());
    for (const Bone& bone : rig.bones)
        label_of_bone.push_back(static_cast<std::int32_t>(
            std::lower_bound(result.names.begin(), result.names.end(), of_node[bone.node]) - result.names.begin()));
    std::vector<float> sum(result.names.size());
    result.label.reserve(animation.rest.face_count());
    for (const Face& face : animation.rest.faces)
        result.label.push_back(label_of_corners(rig, face, label_of_bone, sum));
    return result;
}

LabeledCorpus corpus_of_rig(const Animation& animation, const std::filesystem::path& path, const RigLabels& labels,
                            std::size_t poses) {
    LabeledCorpus corpus;
    corpus.names = labels.names;
    const std::size_t frames = animation.frame_count(), count = frames == 0 ? 1 : std::min(poses, frames);
    corpus.meshes.reserve(count);
    for (std::size_t i = 0; i < count; ++i) {
        check_interrupt();
        std::size_t clip = 0, frame = count == 1 ? 0 : i * (std::max<std::size_t>(frames, 1) - 1) / (count - 1);
        while (clip < animation.clips.size() && frame >= animation.clips[clip].size())
            frame -= animation.clips[clip++].size();
        LabeledMesh mesh;
        mesh.name = fmt::format("{}_{}", path.stem().string(), i + 1);
        mesh.path = path;
        mesh.mesh = animation.rest;
        mesh.mesh.vertices = vertices_of(animation, shape_at(animation, clip, frame));
        mesh.label = labels.label;
        corpus.meshes.push_back(std::move(mesh));
    }
    return corpus;
}

}  // namespace exemplar
