#include "apps/exemplar/label/rig_examples.h"

#include <fmt/format.h>

#include <algorithm>

#include "apps/exemplar/arguments.h"
#include "host/animation/read_animation.h"
#include "host/core/errors.h"
#include "host/core/text.h"
#include "host/parts/rigging/rig_labels.h"

namespace exemplar {
namespace {

/// Appends meshes, whose labels get the numbers of equal names; new names are put in their place in the order.
void append_corpus(const LabeledCorpus& more, LabeledCorpus& corpus) {
    std::vector<std::string> names = corpus.names;
    names.insert(names.end(), more.names.begin(), more.names.end());
    std::sort(names.begin(), names.end());
    names.erase(std::unique(names.begin(), names.end()), names.end());
    const auto renumber = [&](LabeledMesh& mesh, const std::vector<std::string>& old) {
        for (std::int32_t& label : mesh.label)
            if (label >= 0)
                label = static_cast<std::int32_t>(
                    std::lower_bound(names.begin(), names.end(), old[static_cast<std::size_t>(label)]) - names.begin());
    };
    for (LabeledMesh& mesh : corpus.meshes) renumber(mesh, corpus.names);
    corpus.meshes.reserve(corpus.meshes.size() + more.meshes.size());
    for (const LabeledMesh& mesh : more.meshes) {
        corpus.meshes.push_back(mesh);
        renumber(corpus.meshes.back(), more.names);
    }
    corpus.names = std::move(names);
}

void export_corpus(const LabeledCorpus& corpus, const std::filesystem::path& folder) {
    for (const LabeledMesh& mesh : corpus.meshes) {
        TriangleMesh triangles = mesh.mesh;
        triangles.source_face.clear();
        triangles.source_face_count = static_cast<std::uint32_t>(triangles.faces.size());
        write_off(folder / (mesh.name + ".off"), triangles);
        write_labels_txt(folder / (mesh.name + "_labels.txt"), {corpus.names, mesh.label});
    }
}

}  // namespace

void add_rig_example_options(Command& command, RigExamples& examples) {
    command
        .add_option("--from-rig", examples.characters,
                    "skinned characters whose bones give the labels; bones of Mixamo, VRM and Rigify are known")
        ->type_name("FILE");
    command
        .add_option(
            "--map", examples.map,
            "labels by the names of bones as JSON: {\"b_Head*\": \"head\", ...}; \"-\" is the label of the parent")
        ->type_name("FILE");
    command.add_option("--poses", examples.poses, "frames of each character, spread over its clips, to learn from")
        ->capture_default_str()
        ->check(whole_number(1, 1000));
    command.add_option("--export", examples.folder, "folder for the labeled meshes of the characters")
        ->type_name("FOLDER");
}

void add_rig_examples(const RigExamples& examples, bool quiet, LabeledCorpus& corpus) {
    if (!examples.folder.empty()) require_output_folder(examples.folder);
    for (const auto& path : examples.characters) require_input(path);
    if (!examples.map.empty()) require_input(examples.map);
    const BoneTable table = examples.map.empty() ? BoneTable::of_humans() : BoneTable::read(examples.map);
    for (const auto& path : examples.characters) {
        const Animation animation = read_animation(path);
        const auto renamed = examples.map.empty() ? vrm_bones(path) : std::map<std::string, std::string>();
        const RigLabels labels = labels_of_rig(animation, table, renamed);
        if (!quiet && !labels.unknown_bones.empty())
            fmt::print(stderr, "warning: {}: {} without an entry take the label of their parent: '{}'{}\n",
                       path.string(), counted(labels.unknown_bones.size(), "bone"),
                       without_controls(labels.unknown_bones[0].substr(0, 40)),
                       labels.unknown_bones.size() > 1 ? " and so on" : "");
        const LabeledCorpus meshes = corpus_of_rig(animation, path, labels, examples.poses);
        if (!examples.folder.empty()) export_corpus(meshes, examples.folder);
        append_corpus(meshes, corpus);
    }
}

}  // namespace exemplar
