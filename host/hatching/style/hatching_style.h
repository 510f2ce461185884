#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "host/hatching/measurement/drawing_properties.h"
#include "host/hatching/style/orientation_mixture.h"
#include "host/hatching/style/pixel_crf.h"
#include "host/hatching/style/property_model.h"
#include "host/learn/boosting/boosted_stumps.h"

namespace exemplar {

/// A hatching style, learned from one drawing. Features are numbered as in powers.h; from 4 k_pixel_features on they
/// are the contextual features of as many labels as there are rules.
struct HatchingStyle {
    std::string name;                        ///< of the drawing
    int width = 0, height = 0;               ///< of the drawing: lengths are in its pixels
    std::vector<OrientationRule> rules;      ///< of the segments
    std::vector<double> share;               ///< of the drawing's strokes in each segment
    std::vector<CalibratedStumps> segments;  ///< cascade: from the second on with contextual features
    CalibratedStumps boundary;               ///< two classes: on a boundary of hatching regions or not
    CalibratedStumps levels;                 ///< three classes
    PixelCrfParameters segment_crf, level_crf;
    std::array<PropertyModel, k_stroke_properties> properties;

    std::size_t feature_count() const;  ///< base features, contextual ones included
};

/// Identifies the meaning of feature numbers; changes whenever it changes.
constexpr int k_hatching_feature_version = 1;

/// Writes and reads style files (safetensors; docs/formats.md). Reading checks everything and throws ModelError, naming
/// the file, what is wrong, and the mend.
void save_hatching_style(const std::filesystem::path& path, const HatchingStyle& style);
HatchingStyle load_hatching_style(const std::filesystem::path& path);
/// Whether a safetensors file says that it is a hatching style. Throws ModelError if it is no such file.
bool is_hatching_style(const std::filesystem::path& path);

/// The style in words: which rule hatches which segment (as the legend of thesis Fig. 4.3) and which features drive
/// each property (as Figs. 4.15, 4.16).
std::string describe_hatching_style(const HatchingStyle& style);

/// The name of an expanded feature of a style, e.g. "1/image.L.N@2^2".
std::string feature_name(const HatchingStyle& style, std::uint32_t expanded);

}  // namespace exemplar
