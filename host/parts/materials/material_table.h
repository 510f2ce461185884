#pragma once

#include <array>
#include <filesystem>
#include <map>
#include <optional>
#include <string>

#include "host/lines/part_inks.h"
#include "host/mesh/labels.h"

namespace exemplar {

/// A material of physically based rendering, as in glTF 2.0 (section 3.9).
struct PartMaterial {
    std::optional<Color> color;     ///< sRGB; if it is missing, white with a texture, else the color of the label
    float metallic = 0;             ///< 0 to 1
    float roughness = 0.9F;         ///< 0 to 1
    std::filesystem::path texture;  ///< PNG or JPEG; empty: none
    float size = 0.1F;              ///< of one repeat of the texture, in diagonals of the shape's bounding box
    PartInk line;                   ///< of its lines in line drawings
    PartInk hatching;               ///< of its strokes in hatched drawings
};

/// Materials by label. "*" is that of all other labels.
using MaterialTable = std::map<std::string, PartMaterial>;

/// Reads materials from JSON: {"torso": {"color": "#aa7744", "metallic": 0, "roughness": 0.8, "texture": "fur.png",
/// "size": 0.1, "line": {"color": "#550000", "width": 1.5}, "hatching": {"width": 0.8}}, "*": {...}}. Every entry may
/// be missing; textures are relative to the file. Throws DataError that names the file, the label and what is expected.
MaterialTable read_materials(const std::filesystem::path& path);

}  // namespace exemplar
