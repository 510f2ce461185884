#include "host/parts/rigging/bone_table.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstring>
#include <nlohmann/json.hpp>
#include <utility>

#include "host/core/errors.h"
#include "host/core/files.h"
#include "host/core/json_text.h"
#include "host/core/text.h"

namespace exemplar {
namespace {

/// The words of a name in lower case: at other characters than letters, and where a capital follows a small letter.
std::vector<std::string> words_of_bone(std::string_view bone) {
    std::vector<std::string> words;
    bool fresh = true, was_small = false;
    for (const char c : bone) {
        const auto byte = static_cast<unsigned char>(c);
        const bool is_letter = std::isalpha(byte) != 0, is_capital = std::isupper(byte) != 0;
        if (is_letter && (fresh || (is_capital && was_small))) words.emplace_back();
        if (is_letter) words.back() += static_cast<char>(std::tolower(byte));
        fresh = !is_letter;
        was_small = is_letter && !is_capital;
    }
    return words;
}

/// The name without side, prefix and numbers, as one word: "mixamorig:LeftForeArm" gives "forearm".
std::string plain_bone(std::string_view bone) {
    static constexpr std::array<std::string_view, 14> k_ignored{
        "left", "right", "l", "r", "c", "j", "bip", "def", "org", "mch", "mixamorig", "bone", "joint", "jnt"};
    std::string plain;
    for (const std::string& word : words_of_bone(bone))
        if (std::find(k_ignored.begin(), k_ignored.end(), word) == k_ignored.end()) plain += word;
    return plain;
}

/// Labels by what a plain name begins with. Longer names come before those they begin with.
constexpr std::array<std::pair<std::string_view, std::string_view>, 50> k_human_bones{{
    {"hips", "torso"},        {"hip", "torso"},         {"pelvis", "torso"},      {"spine", "torso"},
    {"upperchest", "torso"},  {"chest", "torso"},       {"torso", "torso"},       {"abdomen", "torso"},
    {"waist", "torso"},       {"breast", "torso"},      {"secbust", "torso"},     {"shoulder", "torso"},
    {"clavicle", "torso"},    {"collar", "torso"},      {"neck", "head"},         {"head", "head"},
    {"jaw", "head"},          {"eye", "head"},          {"adjfaceeye", "head"},   {"adjlfaceeye", "head"},
    {"hair", "head"},         {"sechair", "head"},      {"face", "head"},         {"nose", "head"},
    {"tongue", "head"},       {"teeth", "head"},        {"upperarm", "upperarm"}, {"armtwist", "upperarm"},
    {"lowerarm", "lowerarm"}, {"forearm", "lowerarm"},  {"elbow", "lowerarm"},    {"hand", "hand"},
    {"wrist", "hand"},        {"palm", "hand"},         {"thumb", "hand"},        {"index", "hand"},
    {"middle", "hand"},       {"ring", "hand"},         {"pinky", "hand"},        {"little", "hand"},
    {"finger", "hand"},       {"findex", "hand"},       {"upperleg", "upperleg"}, {"upleg", "upperleg"},
    {"thigh", "upperleg"},    {"lowerleg", "lowerleg"}, {"calf", "lowerleg"},     {"shin", "lowerleg"},
    {"foot", "foot"},         {"toe", "foot"},
}};

std::optional<std::string> human_label(std::string_view bone) {
    const std::string plain = plain_bone(bone);
    if (plain == "arm") return "upperarm";
    if (plain == "leg" || plain == "knee") return "lowerleg";
    if (plain == "ankle" || plain == "heel" || plain == "ball") return "foot";
    for (const auto& [name, label] : k_human_bones)
        if (plain.starts_with(name)) return std::string(label);
    return {};
}

/// Whether `text` fits a pattern in which * stands for any text.
bool fits(std::string_view pattern, std::string_view text) {
    std::size_t p = 0, t = 0, star = std::string_view::npos, resume = 0;
    while (t < text.size()) {
        if (p < pattern.size() && pattern[p] == '*') {
            star = p++;
            resume = t;
        } else if (p < pattern.size() && pattern[p] == text[t]) {
            ++p;
            ++t;
        } else if (star != std::string_view::npos) {
            p = star + 1;
            t = ++resume;
        } else {
            return false;
        }
    }
    return pattern.find_first_not_of('*', p) == std::string_view::npos;
}

/// The JSON chunk of a .glb file, else the text itself.
std::string_view json_of_gltf(std::string_view content) {
    std::uint32_t length = 0;
    if (!content.starts_with("glTF") || content.size() < 20) return content;
    std::memcpy(&length, content.data() + 12, sizeof length);
    return content.substr(20, length);
}

/// Node numbers by the names of humanoid bones, of either version of the extension.
std::map<std::string, std::size_t> humanoid_nodes(const nlohmann::json& extensions) {
    std::map<std::string, std::size_t> nodes;
    const auto add = [&](const std::string& bone, const nlohmann::json& entry) {
        if (entry.is_object() && entry.contains("node") && entry["node"].is_number_unsigned())
            nodes[bone] = entry["node"].get<std::size_t>();
    };
    for (const char* name : {"VRMC_vrm", "VRM"}) {
        const auto bones = extensions.value(
            nlohmann::json::json_pointer(std::string("/") + name + "/humanoid/humanBones"), nlohmann::json());
        if (bones.is_object())
            for (const auto& [bone, entry] : bones.items()) add(bone, entry);
        if (bones.is_array())
            for (const auto& entry : bones)
                if (entry.is_object() && entry.contains("bone") && entry["bone"].is_string())
                    add(entry["bone"].get<std::string>(), entry);
    }
    return nodes;
}

}  // namespace

BoneTable BoneTable::of_humans() {
    return {};
}

BoneTable BoneTable::read(const std::filesystem::path& path) {
    const std::string expected = "expected labels by the names of bones, as {\"b_Head*\": \"head\", \"b_Ear*\": \"-\"}";
    const nlohmann::json json = parse_json(read_file(path), nullptr, false);
    if (!json.is_object() || json.empty()) throw DataError(path.string() + ": " + expected);
    BoneTable table;
    for (const auto& [bone, label] : json.items()) {
        if (!label.is_string() || label.get_ref<const std::string&>().empty())
            throw DataError(path.string() + ": '" + without_controls(bone.substr(0, 40)) + "': " + expected);
        const auto text = label.get<std::string>();
        if (text.find_first_of("\r\n") != std::string::npos)
            throw DataError(path.string() + ": '" + without_controls(bone.substr(0, 40)) + "': labels are one line");
        table.labels_[bone] = text;
    }
    return table;
}

std::optional<std::string> BoneTable::entry_of(std::string_view bone) const {
    if (labels_.empty()) return human_label(bone);
    const std::pair<const std::string, std::string>* best = nullptr;
    for (const auto& entry : labels_)
        if (fits(entry.first, bone) && (!best || entry.first.size() > best->first.size())) best = &entry;
    return best ? std::optional(best->second) : std::nullopt;
}

std::optional<std::string> BoneTable::label_of(std::string_view bone) const {
    const std::optional<std::string> entry = entry_of(bone);
    return entry == "-" ? std::nullopt : entry;
}

bool BoneTable::knows(std::string_view bone) const {
    return entry_of(bone).has_value();
}

std::map<std::string, std::string> vrm_bones(const std::filesystem::path& path) {
    const std::string extension = lower_case(path.extension().string());
    if (extension != ".glb" && extension != ".gltf") return {};
    const FileView file = hold_file(path);
    const nlohmann::json json = parse_json(json_of_gltf(file.content), nullptr, false);
    std::map<std::string, std::string> bones;
    if (!json.is_object() || !json.contains("extensions") || !json["extensions"].is_object()) return bones;
    const nlohmann::json nodes = json.value("nodes", nlohmann::json::array());
    for (const auto& [bone, node] : humanoid_nodes(json["extensions"]))
        if (nodes.is_array() && node < nodes.size() && nodes[node].is_object() && nodes[node].contains("name") &&
            nodes[node]["name"].is_string())
            bones[nodes[node]["name"].get<std::string>()] = bone;
    return bones;
}

}  // namespace exemplar
