#pragma once

#include <map>
#include <string>
#include <vector>

#include "host/animation/animation.h"
#include "host/data/corpus.h"
#include "host/parts/rigging/bone_table.h"

namespace exemplar {

/// Labels that follow from the bones of a character.
struct RigLabels {
    std::vector<std::string> names;          ///< sorted
    std::vector<std::int32_t> label;         ///< per face
    std::vector<std::string> unknown_bones;  ///< bones with weight that the table has no entry for
};

/// Labels each face of a character with the label whose bones have the largest weight, summed over the face's corners.
/// A bone without an entry takes the label of the nearest node above it that has one, else of the first bone that has
/// one. `renamed` has other names for nodes, as VRM's humanoid gives them (see vrm_bones). Throws DataError that begins
/// with the name of the animation, with unknown bones and what a map looks like, if the table gives fewer than two
/// labels.
RigLabels labels_of_rig(const Animation& animation, const BoneTable& table,
                        const std::map<std::string, std::string>& renamed = {});

/// Returns labeled meshes of a character in `poses` frames, spread evenly over all of its clips; at rest if it has
/// none. They are named after its file: NAME_1, NAME_2, ... Throws what labels_of_rig throws.
LabeledCorpus corpus_of_rig(const Animation& animation, const std::filesystem::path& path, const RigLabels& labels,
                            std::size_t poses);

}  // namespace exemplar
