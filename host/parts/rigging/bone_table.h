#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace exemplar {

/// Tells which label the surface at a bone has, by the bone's name.
class BoneTable {
  public:
    /// The table for human figures, with the labels of the Princeton benchmark: head, torso, upperarm, lowerarm, hand,
    /// upperleg, lowerleg, foot. It knows the names of Mixamo (`mixamorig:LeftForeArm`), of VRM's humanoid
    /// (`leftLowerArm`) and VRoid (`J_Bip_L_LowerArm`), of Rigify (`DEF-forearm.L.001`), and of programs with like
    /// names (`thigh_l`, `Bip01 L Calf`). Shoulders and chest are torso, neck and face head, fingers hand, toes foot.
    static BoneTable of_humans();
    /// Reads a table from JSON: an object of labels by the names of bones, where `*` stands for any text. The longest
    /// name that fits counts. The label "-" gives a bone the label of its parent. Throws DataError that names the file.
    static BoneTable read(const std::filesystem::path& path);

    /// Returns the label of a bone; nothing for a bone that it does not know or that takes its parent's.
    std::optional<std::string> label_of(std::string_view bone) const;
    /// Returns whether the table has an entry for the bone, be it "-".
    bool knows(std::string_view bone) const;

  private:
    std::optional<std::string> entry_of(std::string_view bone) const;

    std::map<std::string, std::string> labels_;  ///< by pattern; empty: the table of humans
};

/// Returns the names of VRM's humanoid bones (VRM 0 and 1) by the names of the nodes of a .glb or .gltf file; nothing
/// for other files. Throws DataError if the file cannot be read.
std::map<std::string, std::string> vrm_bones(const std::filesystem::path& path);

}  // namespace exemplar
