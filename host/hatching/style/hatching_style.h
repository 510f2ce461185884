#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "host/hatching/measurement/drawing_properties.h"
#include "host/hatching/measurement/pen.h"
#include "host/hatching/rules/direction_correction.h"
#include "host/hatching/rules/orientation_mixture.h"
#include "host/hatching/style/familiarity.h"
#include "host/hatching/style/pixel_crf.h"
#include "host/hatching/style/property_model.h"
#include "host/learn/boosting/boosted_stumps.h"

namespace exemplar {

/// A hatching style learned from one drawing. Feature numbers are those of the expanded set (powers.h); numbers from
/// 4 * scalar_count() on are contextual features of as many labels as there are rules (see contextual_features()).
struct HatchingStyle {
    std::string name;                    ///< of the drawing
    int width = 0, height = 0;           ///< of the drawing, in pixels; lengths are in these pixels
    float object_size = 0;               ///< of the object in the drawing, see size_in_view(); 0: not known
    float taper = k_usual_taper;         ///< pixels over which strokes end in a point
    std::vector<std::string> parts;      ///< whose labels are features, see PixelFeatures::use_parts(); mostly none
    float outline_width = 0;             ///< of the outlines in the drawing, pixels; 0: it has none
    std::vector<OrientationRule> rules;  ///< one per segment
    /// Corrections of the rules' directions, for hatches and for those that cross them.
    std::array<DirectionCorrection, k_hatch_layers> corrections;
    std::vector<double> share;               ///< per segment, its share of the drawing's strokes
    std::vector<CalibratedStumps> segments;  ///< cascade; all but the first also see contextual features
    CalibratedStumps boundary;               ///< class 1: on a boundary of hatching regions; class 0: not
    CalibratedStumps levels;                 ///< three classes: the hatching levels, in detail
    CalibratedStumps rough_levels;           ///< the same where little is familiar; without stumps: `levels` everywhere
    Familiarity familiarity;                 ///< of pixels: the weight of `levels`, the rest is that of `rough_levels`
    PixelCrfParameters segment_crf, level_crf;
    std::array<PropertyModel, k_stroke_properties> properties;

    std::size_t scalar_count() const;   ///< number of scalar features, those of parts included
    std::size_t feature_count() const;  ///< number of base features, including contextual ones
    /// Restates all lengths in pixels of a picture of another size: a pen is as wide as before in relation to the
    /// shorter side.
    void resize(int new_width, int new_height);
};

/// Version of the feature numbering; changes whenever a number changes its meaning.
constexpr int k_hatching_feature_version = 1;

/// Write and read style files (safetensors; docs/formats.md). Reading validates all contents and throws ModelError
/// with the file, the fault and the remedy.
void save_hatching_style(const std::filesystem::path& path, const HatchingStyle& style);
HatchingStyle load_hatching_style(const std::filesystem::path& path);
/// Returns whether a safetensors file declares itself a hatching style. Throws ModelError if it is not a safetensors
/// file.
bool is_hatching_style(const std::filesystem::path& path);

/// Describes a rule in words, e.g. "hatches along 1.00 k_max,2; crossed along 0.62 L + 0.38 perp grad a,1".
std::string describe_rule(const OrientationRule& rule);
/// Describes a style in words: the rule of each segment (like the legend of thesis Fig. 4.3) and the features that
/// determine each property (like Figs. 4.15, 4.16).
std::string describe_hatching_style(const HatchingStyle& style);

/// Returns the name of an expanded feature of a style, e.g. "1/image.L.N@2^2".
std::string feature_name(const HatchingStyle& style, std::uint32_t expanded);

}  // namespace exemplar
