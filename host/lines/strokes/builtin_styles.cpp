#include <fmt/format.h>

#include <array>
#include <utility>

#include "host/core/errors.h"
#include "host/core/text.h"
#include "host/lines/strokes/style.h"

namespace exemplar {

namespace {

constexpr std::string_view k_ink = R"({
  "about": "black ink on white, thicker where the surface is flat and near",
  "background": "#ffffff",
  "surface": {"shading": "paper", "color": "#ffffff"},
  "default": {"color": "#000000", "width": 2, "epsilon": 0.25, "least": 0.5, "most": 5, "taper": 14},
  "contours": {"width": 3.2, "least": 1, "taper": 10},
  "suggestive_contours": {"width": 2.4, "taper": 24},
  "suggestive_highlights": {"color": "#8c8c8c", "taper": 24},
  "principal_highlights": {"color": "#8c8c8c", "taper": 24},
  "ridges": {"width": 1.8},
  "valleys": {"width": 1.8},
  "creases": {"width": 1.6, "taper": 0},
  "boundaries": {"width": 2.4, "taper": 0}
}
)";

constexpr std::string_view k_pencil = R"({
  "about": "soft gray pencil on warm paper",
  "background": "#fbf9f3",
  "surface": {"shading": "paper", "color": "#fbf9f3"},
  "fade": 0.06,
  "default": {"color": "#3a3a3c", "opacity": 0.85, "width": 2.2, "epsilon": 0.3, "least": 0.8, "most": 4.5, "taper": 22,
              "texture": "pencil"},
  "contours": {"width": 3, "least": 1.4, "taper": 16},
  "suggestive_highlights": {"color": "#a8a49a"},
  "principal_highlights": {"color": "#a8a49a"},
  "creases": {"taper": 4},
  "boundaries": {"taper": 4}
}
)";

constexpr std::string_view k_charcoal = R"({
  "about": "broad strokes of charcoal on grayish paper",
  "background": "#efece6",
  "surface": {"shading": "paper", "color": "#efece6"},
  "fade": 0.08,
  "default": {"color": "#1c1a18", "opacity": 0.8, "width": 5, "epsilon": 0.3, "least": 2, "most": 12, "taper": 30,
              "texture": "charcoal"},
  "contours": {"width": 8, "least": 3, "taper": 22},
  "suggestive_highlights": {"color": "#ffffff"},
  "principal_highlights": {"color": "#ffffff"}
}
)";

constexpr std::string_view k_brush = R"({
  "about": "a brush that swells and thins out",
  "background": "#ffffff",
  "surface": {"shading": "paper", "color": "#ffffff"},
  "default": {"color": "#101018", "width": 5, "epsilon": 0.12, "least": 0.6, "most": 11, "taper": 60, "texture": "brush"},
  "contours": {"width": 8, "most": 14, "taper": 45},
  "suggestive_highlights": {"color": "#a0a0a8"},
  "principal_highlights": {"color": "#a0a0a8"},
  "creases": {"width": 4, "taper": 12},
  "boundaries": {"taper": 12}
}
)";

constexpr std::string_view k_technical = R"({
  "about": "even black lines of a manual: outlines thicker than the rest",
  "background": "#ffffff",
  "surface": {"shading": "paper", "color": "#ffffff"},
  "fade": 0,
  "default": {"color": "#000000", "width": 0.9, "least": 0.9, "most": 0.9, "taper": 0},
  "contours": {"width": 1.8, "least": 1.8, "most": 1.8},
  "boundaries": {"width": 1.4, "least": 1.4, "most": 1.4},
  "suggestive_highlights": {"color": "#909090"},
  "principal_highlights": {"color": "#909090"}
}
)";

constexpr std::string_view k_blueprint = R"({
  "about": "white lines on blue",
  "background": "#16407c",
  "surface": {"shading": "paper", "color": "#16407c"},
  "default": {"color": "#c4d8f6", "width": 1.1, "least": 1.1, "most": 1.1, "taper": 0},
  "contours": {"color": "#ffffff", "width": 1.8, "least": 1.8, "most": 1.8},
  "boundaries": {"color": "#ffffff", "width": 1.5, "least": 1.5, "most": 1.5},
  "suggestive_highlights": {"color": "#7fa2d8"},
  "principal_highlights": {"color": "#7fa2d8"}
}
)";

constexpr std::string_view k_colored = R"({
  "about": "a color for each type of line, to tell them apart",
  "background": "#ffffff",
  "surface": {"shading": "paper", "color": "#ffffff"},
  "default": {"color": "#000000", "width": 1.6, "least": 0.5, "most": 3, "taper": 6},
  "contours": {"width": 2.2},
  "suggestive_contours": {"color": "#1f6fd0"},
  "suggestive_highlights": {"color": "#37b0c8"},
  "ridges": {"color": "#d03020"},
  "valleys": {"color": "#207c34"},
  "apparent_ridges": {"color": "#8a3fc0"},
  "principal_highlights": {"color": "#e09a1c"},
  "creases": {"color": "#70481c", "taper": 0},
  "boundaries": {"color": "#c0308a", "taper": 0}
}
)";

constexpr std::array k_style_names = {std::string_view("ink"),       std::string_view("pencil"),
                                      std::string_view("charcoal"),  std::string_view("brush"),
                                      std::string_view("technical"), std::string_view("blueprint"),
                                      std::string_view("colored")};
constexpr std::array k_texts = {k_ink, k_pencil, k_charcoal, k_brush, k_technical, k_blueprint, k_colored};
static_assert(k_style_names.size() == k_texts.size());

}  // namespace

std::span<const std::string_view> builtin_style_names() {
    return k_style_names;
}

std::string_view builtin_style_text(std::string_view name) {
    for (std::size_t i = 0; i < k_style_names.size(); ++i)
        if (k_style_names[i] == name) return k_texts[i];
    const std::vector<std::string> names(k_style_names.begin(), k_style_names.end());
    throw UsageError(fmt::format("there is no style '{}'{}; the styles are {}", name, suggestion(name, names),
                                 fmt::join(k_style_names, ", ")));
}

}  // namespace exemplar
