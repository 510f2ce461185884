// exemplar hatch figures: how a style is learned, as pictures (thesis Figs. 4.1, 4.2, 4.3).

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <optional>
#include <utility>

#include "apps/exemplar/arguments.h"
#include "apps/exemplar/hatch/figure_page.h"
#include "apps/exemplar/hatch/hatch_reading.h"
#include "apps/exemplar/hatch/hatch_scene.h"
#include "host/core/progress.h"
#include "host/hatching/fields/ink.h"
#include "host/hatching/fields/occlusion_barriers.h"
#include "host/hatching/refinement/stroke_relaxation.h"
#include "host/hatching/refinement/tone_matching.h"
#include "host/hatching/style/style_learning.h"
#include "host/lines/strokes/view_point.h"
#include "host/synth/hatching/hand_picked_rules.h"

namespace exemplar {
namespace {

namespace fs = std::filesystem;

struct FiguresArguments {
    HatchSceneArguments scene;
    fs::path drawing, mask, out;
    std::size_t page = 0;
    std::vector<fs::path> others;
    std::uint64_t seed = 1;
    CommonOptions common;
};

/// A view that the style is used on, and what it predicts there.
struct ShownView {
    std::string name;     ///< "same_view" and so on, for files
    std::string caption;  ///< "the same view" and so on
    std::unique_ptr<HatchScene> scene;
    HatchingPrediction prediction;
};

/// Labels hatched pixels like the nearest known one, along paths through the hatching. `labels`: k_no_segment where
/// they are not known.
std::vector<std::uint8_t> spread_labels(std::vector<std::uint8_t> labels, std::span<const std::uint8_t> hatched,
                                        int width) {
    std::vector<std::size_t> front;
    for (std::size_t p = 0; p < labels.size(); ++p)
        if (labels[p] != k_no_segment) front.push_back(p);
    const auto step = static_cast<std::size_t>(width);
    const std::array<std::size_t, 4> steps{1, step, std::size_t{0} - 1, std::size_t{0} - step};
    for (std::size_t next = 0; next < front.size(); ++next) {
        const std::size_t at = front[next];
        for (const std::size_t by : steps) {
            const std::size_t near = at + by;  // Beyond the first and last pixel, and so out of range, it wraps.
            if (near >= labels.size() || !hatched[near] || labels[near] != k_no_segment) continue;
            labels[near] = labels[at];
            front.push_back(near);
        }
    }
    return labels;
}

/// Returns the named view that is nearest to 60 degrees away from a view of a mesh: it shows much that is new.
std::string new_view_of(const HatchSceneArguments& arguments, const HatchScene& scene, const HatchingView& view) {
    constexpr float k_cosine = 0.5f;
    const BoundingBox box = bounding_box(scene.surface().mesh);
    const Vec3 middle = (0.5 * (box.low + box.high)).cast<float>();
    HatchSceneArguments other = arguments;
    other.camera.eye.clear();
    other.camera.target.clear();
    const auto unlikeness = [&](const std::string& name) {
        other.camera.view = name;
        const HatchingView named = hatching_view(other, scene.surface().mesh);
        return std::abs(named.camera.to_eye(middle).dot(view.camera.to_eye(middle)) - k_cosine);
    };
    return std::ranges::min(view_names(), {}, unlikeness);
}

/// Makes all figures of a drawing.
class StyleFigures {
  public:
    explicit StyleFigures(const FiguresArguments& arguments)
        : arguments_(arguments), progress_("figures", 6 + arguments.others.size()) {}

    void make() {
        read();
        learn();
        show_views();
        const std::array<Figure, 3> figures{drawings(), properties(), segments()};
        write_figures(arguments_.out, figures);
        save_hatching_style(arguments_.out / "style.safetensors", style_);
        progress_.advance(1, "pictures");
        progress_.finish();
    }
    const HatchingStyle& style() const { return style_; }

  private:
    void read() {
        add_view("same_view", "the same view", arguments_.scene);
        HatchScene& scene = *views_.front().scene;
        drawing_ = read_drawing({arguments_.drawing, arguments_.page}, arguments_.scene, scene.pixels(),
                                arguments_.common.quiet);
        measured_ = drawing_properties(drawing_.strokes);
        if (!arguments_.mask.empty()) restrict_to(read_mask(arguments_.mask, scene.pixels()), measured_);
        progress_.advance(1, "the drawing");
    }

    void learn() {
        HatchScene& scene = *views_.front().scene;
        StyleReport report;
        style_ =
            learn_hatching_style(scene.pixels(), measured_, scene.tools().scorer, {.seed = arguments_.seed}, report);
        style_.name = arguments_.drawing.filename().string();
        strokes_segment_ = std::move(report.segments.front());
        progress_.advance(1, "style");
        StyleReport unused;
        StyleLearningOptions one_rule;
        one_rule.seed = arguments_.seed;
        one_rule.one_rule = true;
        unsegmented_ = learn_hatching_style(scene.pixels(), measured_, scene.tools().scorer, one_rule, unused);
        progress_.advance(1, "style without segments");
    }

    /// Adds a new view, and the other meshes in the usual view, all under the drawing's light.
    void show_views() {
        HatchSceneArguments other = arguments_.scene;
        other.drawn.reset();
        other.camera.eye = other.camera.target = "";
        other.camera.shift = "0,0";
        other.camera.view = new_view_of(arguments_.scene, *views_.front().scene, views_.front().scene->pixels().view());
        add_view("new_view", "a new view", other);
        other.camera.up = CameraArguments().up;
        other.camera.view = CameraArguments().view;
        for (const fs::path& mesh : arguments_.others) {
            other.mesh = mesh;
            add_view("on_" + mesh.stem().string(), mesh.stem().string(), other);
        }
        for (ShownView& view : views_) view.prediction = predicted(style_, *view.scene);
    }

    void add_view(std::string name, std::string caption, const HatchSceneArguments& scene) {
        views_.push_back({std::move(name),
                          std::move(caption),
                          std::make_unique<HatchScene>(scene, arguments_.common.device, arguments_.common.quiet),
                          {}});
        progress_.advance(1, views_.back().caption);
    }

    static HatchingPrediction predicted(const HatchingStyle& style, HatchScene& scene) {
        HatchingStyle sized = style;
        sized.resize(scene.pixels().view().width, scene.pixels().view().height);
        return predict_hatching(sized, scene.pixels(), scene.tools().scorer, scene.tools().evaluator);
    }

    /// Draws targets like 'exemplar hatch draw', with contours.
    Image drawn(const HatchingFields& fields, HatchScene& scene) const {
        const auto barriers = occlusion_barriers(scene.pixels().gbuffer().depth, fields.width, fields.height);
        HatchedDrawing out{fields.width, fields.height, place_evenly(scene.tools().placer, fields, barriers, {}), {}};
        match_tone(out.strokes, fields);
        taper_strokes(out.strokes, style_.taper);
        const DrawingStyle look = curve_look(style_);
        constexpr std::array k_types{LineType::contours};
        out.curves = feature_curves(scene.surface(), scene.pixels().view(), k_types, look);
        return hatching_picture(out, look);
    }

    /// Thesis Fig. 4.1.
    Figure drawings() {
        HatchScene& own = *views_.front().scene;
        Figure figure{"Drawings", {}, {}};
        std::vector<FigurePanel> panels;
        panels.push_back({"drawing", "the drawing",
                          ink_picture(drawing_.darkness.data, drawing_.darkness.width, drawing_.darkness.height)});
        for (const HandPickedRule& rule : hand_picked_rules()) {
            const std::string name(rule.name);
            panels.push_back({"picked_" + file_name(name), "hand-picked: " + name + ", tone by N.V",
                              drawn(hatching_by_hand_picked_rule(rule, own.pixels(), measured_), own)});
        }
        panels.push_back({"one_rule", "learned without segments: one rule, no context",
                          drawn(predicted(unsegmented_, own).fields, own)});
        for (const ShownView& view : views_)
            panels.push_back({"learned_" + view.name, "learned in full: " + view.caption,
                              drawn(view.prediction.fields, *view.scene)});
        constexpr std::size_t k_columns = 4;
        for (std::size_t k = 0; k < panels.size(); ++k) {
            if (k % k_columns == 0) figure.rows.emplace_back();
            figure.rows.back().push_back(std::move(panels[k]));
        }
        return figure;
    }

    static std::string file_name(std::string words) {
        std::ranges::replace(words, ' ', '_');
        return words;
    }

    /// Thesis Fig. 4.2: all rows in the colors of the first.
    Figure properties() {
        Figure figure{
            "Properties, in the same colors everywhere (orientations: red along x, then green, then blue)",
            {},
            {{label_color(k_single_hatching), "single hatching"}, {label_color(k_cross_hatching), "cross-hatching"}}};
        figure.rows.push_back(properties_of_drawing());
        for (const ShownView& view : views_) figure.rows.push_back(properties_of(view));
        return figure;
    }

    std::vector<FigurePanel> properties_of_drawing() {
        const StrokeMeasurements& m = drawing_.strokes;
        std::vector<FigurePanel> row{
            {"drawing_levels", "the drawing: levels", label_picture(m.level, k_no_hatching, m.width, m.height)}};
        for (std::size_t p = 0; p < k_stroke_properties; ++p) {
            const char* name = name_of(static_cast<StrokeProperty>(p));
            const std::vector<float>& values = measured_.property[p];
            std::vector<std::uint8_t> known = m.stroke;
            for (std::size_t i = 0; i < known.size(); ++i) known[i] = known[i] && values[i] > 0 ? 1 : 0;
            ranges_[p] = property_range(values, known);
            row.push_back({fmt::format("drawing_{}", name),
                           fmt::format("{}, {:.3g} (light) to {:.3g}", name, ranges_[p][0], ranges_[p][1]),
                           property_picture(values, known, m.width, m.height, ranges_[p])});
        }
        for (std::size_t layer = 0; layer < k_hatch_layers; ++layer)
            row.push_back({fmt::format("drawing_orientation_{}", layer + 1), fmt::format("orientation {}", layer + 1),
                           orientation_picture(m.orientation, strokes_of_layer(layer), m.width, m.height)});
        return row;
    }

    /// Returns 1 at the drawing's stroke pixels that follow this layer's predicted direction more nearly.
    std::vector<std::uint8_t> strokes_of_layer(std::size_t layer) const {
        const StrokeMeasurements& m = drawing_.strokes;
        const HatchingFields& fields = views_.front().prediction.fields;
        std::vector<std::uint8_t> strokes(m.size());
        for (std::size_t p = 0; p < strokes.size(); ++p) {
            if (!m.stroke[p] || m.intersection[p]) continue;
            const auto apart = [&](std::size_t of) {
                return orientation_difference(m.orientation[p], fields.orientation[of][p]);
            };
            const std::size_t nearer = m.level[p] == k_cross_hatching && apart(1) < apart(0) ? 1 : 0;
            strokes[p] = nearer == layer ? 1 : 0;
        }
        return strokes;
    }

    std::vector<FigurePanel> properties_of(const ShownView& view) const {
        const HatchingFields& fields = view.prediction.fields;
        const int width = fields.width, height = fields.height;
        std::vector<FigurePanel> row{{view.name + "_levels", view.caption + ": levels",
                                      label_picture(fields.level, k_no_hatching, width, height)}};
        for (std::size_t p = 0; p < k_stroke_properties; ++p) {
            const auto property = static_cast<StrokeProperty>(p);
            row.push_back({fmt::format("{}_{}", view.name, name_of(property)), name_of(property),
                           property_picture(property_of(fields, property), fields.level, width, height, ranges_[p])});
        }
        std::vector<std::uint8_t> crossed(fields.size());
        for (std::size_t i = 0; i < crossed.size(); ++i) crossed[i] = fields.level[i] == k_cross_hatching ? 1 : 0;
        row.push_back({view.name + "_orientation_1", "orientation 1",
                       orientation_picture(fields.orientation[0], fields.level, width, height)});
        row.push_back({view.name + "_orientation_2", "orientation 2",
                       orientation_picture(fields.orientation[1], crossed, width, height)});
        return row;
    }

    /// Thesis Fig. 4.3.
    Figure segments() {
        const auto picture = [](std::span<const std::uint8_t> labels, const HatchingFields& fields) {
            return label_picture(labels, k_no_segment, fields.width, fields.height);
        };
        const HatchingFields& own = views_.front().prediction.fields;
        Figure figure{"Segments, and the rule of each", {}, {}};
        auto& row = figure.rows.emplace_back();
        row.push_back({"segments_found", "found in the drawing",
                       picture(spread_labels(strokes_segment_, measured_.level, own.width), own)});
        HatchingStyle uncut = style_;
        uncut.segment_crf.strength = 0;  // The cut then takes the most probable label of each pixel.
        row.push_back({"segments_boosting", "by boosting alone: the most probable label",
                       picture(predicted(uncut, *views_.front().scene).segment, own)});
        for (const ShownView& view : views_) {
            if (row.size() == 4) break;
            if (view.name == "new_view" && views_.size() > 2) continue;
            row.push_back({"segments_" + view.name, "by the random field: " + view.caption,
                           picture(view.prediction.segment, view.prediction.fields)});
        }
        for (std::size_t c = 0; c < style_.rules.size(); ++c)
            figure.legend.push_back({label_color(c), fmt::format("{:.0f}% of the strokes: {}", 100 * style_.share[c],
                                                                 describe_rule(style_.rules[c]))});
        return figure;
    }

    const FiguresArguments& arguments_;
    Progress progress_;
    AlignedDrawing drawing_;
    DrawingProperties measured_;
    HatchingStyle style_, unsegmented_;
    std::vector<std::uint8_t> strokes_segment_;                       // per pixel: that the mixture found at strokes
    std::vector<ShownView> views_;                                    // that of the drawing first, then the new view
    std::array<std::array<float, 2>, k_stroke_properties> ranges_{};  // of the drawing
};

void run_hatch_figures(FiguresArguments& arguments) {
    const auto limits = apply_common_options(arguments.common);
    require_hatch_scene(arguments.scene);
    require_input(arguments.drawing);
    if (!arguments.mask.empty()) require_input(arguments.mask);
    require_distinct_names(arguments.others);
    for (const fs::path& mesh : arguments.others) require_input(mesh);
    require_output_folder(arguments.out);
    StyleFigures figures(arguments);
    figures.make();
    if (!arguments.common.quiet)
        fmt::print("{}{}\n", describe_hatching_style(figures.style()), (arguments.out / "figures.svg").string());
    write_report(arguments.common, {{"drawing", arguments.drawing.string()},
                                    {"segments", figures.style().rules.size()},
                                    {"figures", (arguments.out / "figures.svg").string()}});
}

}  // namespace

void add_hatch_figures_command(Command& hatch) {
    auto arguments = std::make_shared<FiguresArguments>();
    Command* command = hatch.add_subcommand("figures", "Shows how the style of a drawing is learned, as pictures");
    command->footer(
        "Learns the style as 'hatch train' does, and once more without segments. Writes pictures, figures.svg with all "
        "of them, and the style:\n"
        "- the drawing, drawings by hand-picked rules, and learned ones of the same view, a new view and other "
        "meshes;\n"
        "- the properties as read from the drawing and as predicted, in the same colors;\n"
        "- the segments with their rules: found in the drawing, by boosting alone, and by the random field.\n\n"
        "Example:\n  exemplar hatch figures bunny.off traced.png --template bunny.png --on cow.obj --out figures");
    command->add_option("MESH", arguments->scene.mesh, "mesh that the drawing shows")->required()->type_name("");
    command->add_option("DRAWING", arguments->drawing, "the drawing (PNG, JPEG, TIFF or SVG)")
        ->required()
        ->type_name("");
    command->add_option("--on", arguments->others, "other meshes to draw in the style")
        ->type_name("MESH")
        ->allow_extra_args(false);
    command
        ->add_option("--mask", arguments->mask,
                     "picture of the view, white where to learn from the drawing (PNG, JPEG or TIFF)")
        ->type_name("FILE");
    add_page_option(*command, arguments->page);
    command->add_option("--out", arguments->out, "folder for the pictures")->required()->type_name("FOLDER");
    command->add_option("--seed", arguments->seed, "of all random choices")
        ->capture_default_str()
        ->check(whole_number(0));
    add_template_option(*command, arguments->scene, add_hatch_scene_options(*command, arguments->scene));
    add_device_option(*command, arguments->common);
    add_common_options(*command, arguments->common);
    command->callback([arguments] { run_hatch_figures(*arguments); });
}

}  // namespace exemplar
