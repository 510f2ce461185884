#include "host/parts/rigging/rig_labels.h"

#include <gtest/gtest.h>

#include <fstream>

#include "host/core/errors.h"
#include "tests/support/bending_tube.h"
#include "tests/support/temporary_folder.h"

namespace exemplar {
namespace {

TEST(BoneTable, KnowsTheNamesOfManyPrograms) {
    const BoneTable table = BoneTable::of_humans();
    const std::map<std::string, std::string> expected{{"mixamorig:Hips", "torso"},
                                                      {"mixamorig:Spine2", "torso"},
                                                      {"mixamorig:LeftShoulder", "torso"},
                                                      {"mixamorig:LeftArm", "upperarm"},
                                                      {"mixamorig:RightForeArm", "lowerarm"},
                                                      {"mixamorig:LeftHandThumb3", "hand"},
                                                      {"mixamorig:LeftUpLeg", "upperleg"},
                                                      {"mixamorig:LeftLeg", "lowerleg"},
                                                      {"mixamorig:LeftToeBase", "foot"},
                                                      {"mixamorig:Neck", "head"},
                                                      {"J_Bip_C_UpperChest", "torso"},
                                                      {"J_Bip_L_LowerArm", "lowerarm"},
                                                      {"J_Bip_R_UpperLeg", "upperleg"},
                                                      {"J_Bip_L_LowerLeg", "lowerleg"},
                                                      {"J_Bip_L_Little2", "hand"},
                                                      {"leftUpperArm", "upperarm"},
                                                      {"rightIndexProximal", "hand"},
                                                      {"DEF-upper_arm.L", "upperarm"},
                                                      {"DEF-forearm.R.001", "lowerarm"},
                                                      {"DEF-thigh.L", "upperleg"},
                                                      {"DEF-shin.L.001", "lowerleg"},
                                                      {"DEF-toe.L", "foot"},
                                                      {"DEF-f_index.01.L", "hand"},
                                                      {"thigh_l", "upperleg"},
                                                      {"calf_r", "lowerleg"},
                                                      {"Bip01 L Calf", "lowerleg"},
                                                      {"Bip01 R Clavicle", "torso"},
                                                      {"upperarm_twist_01_l", "upperarm"},
                                                      {"ball_l", "foot"}};
    for (const auto& [bone, label] : expected) EXPECT_EQ(table.label_of(bone).value_or("none"), label) << bone;
    for (const char* bone : {"", "Armature", "b_Tail01_012", "\xff\xfe"}) EXPECT_FALSE(table.knows(bone)) << bone;
}

TEST(BoneTable, TheLongestPatternCounts) {
    const TemporaryFolder folder;
    std::ofstream(folder / "map.json") << R"({"b_*": "torso", "b_Head*": "head", "b_*_end": "-"})";
    const BoneTable table = BoneTable::read(folder / "map.json");
    EXPECT_EQ(table.label_of("b_Spine"), "torso");
    EXPECT_EQ(table.label_of("b_Head_05"), "head");
    EXPECT_FALSE(table.label_of("b_Tail_end"));
    EXPECT_TRUE(table.knows("b_Tail_end"));
    EXPECT_FALSE(table.knows("Root"));
    for (const char* text : {"", "[]", "{}", R"({"a": 3})", R"({"a": ""})", R"({"a": "x\ny"})"}) {
        std::ofstream(folder / "wrong.json") << text;
        EXPECT_THROW(BoneTable::read(folder / "wrong.json"), DataError) << text;
    }
}

TEST(BoneTable, ReadsTheHumanoidOfVrm) {
    const TemporaryFolder folder;
    const std::string nodes = R"("nodes": [{"name": "a"}, {"name": "b"}])";
    std::ofstream(folder / "one.gltf")
        << "{" << nodes
        << R"(, "extensions": {"VRMC_vrm": {"humanoid": {"humanBones": {"hips": {"node": 1}, "head": {"node": 7}}}}}})";
    std::ofstream(folder / "zero.gltf")
        << "{" << nodes
        << R"(, "extensions": {"VRM": {"humanoid": {"humanBones": [{"bone": "hips", "node": 0}, 3]}}}})";
    std::ofstream(folder / "none.gltf") << "{" << nodes << "}";
    EXPECT_EQ(vrm_bones(folder / "one.gltf"), (std::map<std::string, std::string>{{"b", "hips"}}));
    EXPECT_EQ(vrm_bones(folder / "zero.gltf"), (std::map<std::string, std::string>{{"a", "hips"}}));
    EXPECT_TRUE(vrm_bones(folder / "none.gltf").empty());
}

TEST(RigLabels, FacesFollowTheHeavierBone) {
    Animation tube = shapes::bending_tube();
    tube.rig.nodes[1].name = "LeftArm";
    tube.rig.nodes[2].name = "LeftForeArm";
    const RigLabels labels = labels_of_rig(tube, BoneTable::of_humans());
    EXPECT_EQ(labels.names, (std::vector<std::string>{"lowerarm", "upperarm"}));
    const std::vector<Vec3> center = face_centers(tube.rest);
    for (std::size_t f = 0; f < center.size(); ++f) {
        if (std::abs(center[f].x()) < 0.01F) continue;
        EXPECT_EQ(labels.label[f], center[f].x() > 0 ? 0 : 1);
    }
    const LabeledCorpus corpus = corpus_of_rig(tube, "arm.glb", labels, 5);
    ASSERT_EQ(corpus.meshes.size(), 5U);
    EXPECT_EQ(corpus.meshes[4].name, "arm_5");
    EXPECT_NE(corpus.meshes[0].mesh.vertices, corpus.meshes[4].mesh.vertices);
}

TEST(RigLabels, BonesWithoutAnEntryTakeTheirParentsLabelAndUnknownRigsAreRefused) {
    Animation tube = shapes::tube_rig();
    tube.rig.nodes[1].name = tube.rig.nodes[2].name = "bone";
    EXPECT_THROW(labels_of_rig(tube, BoneTable::of_humans()), DataError);
    tube.rig.nodes[1].name = "thigh_l";
    tube.rig.nodes[2].name = "thing";
    EXPECT_THROW(labels_of_rig(tube, BoneTable::of_humans()), DataError) << "one label teaches nothing";
    tube.rig.nodes.push_back({"shin_l", 2, {}});
    tube.rig.bones.push_back({3, Affine::Identity()});
    const RigLabels labels = labels_of_rig(tube, BoneTable::of_humans());
    EXPECT_EQ(labels.unknown_bones, std::vector<std::string>{"thing"});
    const auto thigh = std::find(labels.names.begin(), labels.names.end(), "upperleg") - labels.names.begin();
    for (const std::int32_t label : labels.label) EXPECT_EQ(label, thigh);
}

}  // namespace
}  // namespace exemplar
