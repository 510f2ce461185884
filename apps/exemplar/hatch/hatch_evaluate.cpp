// exemplar hatch evaluate: styles whose rule is known, learned from one drawing and tested on other views and meshes.

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <numeric>

#include "apps/exemplar/arguments.h"
#include "apps/exemplar/hatch/hatch_reading.h"
#include "apps/exemplar/hatch/hatch_scene.h"
#include "apps/help/command.h"
#include "host/core/errors.h"
#include "host/core/progress.h"
#include "host/core/random.h"
#include "host/core/statistics.h"
#include "host/core/stopwatch.h"
#include "host/data/npy.h"
#include "host/hatching/fields/occlusion_barriers.h"
#include "host/hatching/hatching_errors.h"
#include "host/hatching/refinement/stroke_relaxation.h"
#include "host/hatching/refinement/stroke_statistics.h"
#include "host/hatching/refinement/tone_matching.h"
#include "host/hatching/style/style_learning.h"
#include "host/synth/hatching/hatched_drawing.h"

namespace exemplar {
namespace {

namespace fs = std::filesystem;

struct EvaluateArguments {
    std::vector<std::string> styles;
    std::vector<fs::path> meshes;
    std::string size = "1000x1000";
    fs::path peers;
    std::uint64_t seed = 1;
    CommonOptions common;
};

/// Exported pixels of each picture to test on, at most.
constexpr std::size_t k_test_rows = 20'000;
/// The training view first.
constexpr std::array<const char*, 4> k_views{"three-quarter", "front", "side", "three-quarter-back"};

HatchSceneArguments scene_of(const EvaluateArguments& arguments, const fs::path& mesh, const char* view) {
    HatchSceneArguments scene;
    scene.mesh = mesh;
    scene.camera.view = view;
    scene.camera.size = arguments.size;
    return scene;
}

/// Learns one rule for the whole drawing, without segments, by boosting on all features or on those of curvature.
OrientationFunction one_rule(PixelFeatures& pixels, const DrawingProperties& drawing, bool curvature_only,
                             std::uint64_t seed) {
    std::vector<std::uint32_t> rows;
    Random random(seed);
    for (std::uint32_t row = 0; row < pixels.size(); ++row) {
        const std::uint32_t p = pixels.pixels().pixel[row];
        if (drawing.center[p] && !drawing.crossing[p] && drawing.level[p] == 1 && random.uniform() < 0.5)
            rows.push_back(row);
    }
    OrientationFields fields = pixels.orientations(rows);
    constexpr std::size_t k_curvature_fields = 6;  // k_max and k_min at three scales
    for (std::size_t k = k_curvature_fields; curvature_only && k < k_orientation_fields; ++k)
        std::ranges::fill(fields.field(k), DoubledAngle{});
    std::vector<DoubledAngle> target;
    target.reserve(rows.size());
    for (const std::uint32_t row : rows)
        target.push_back(doubled_angle(drawing.orientation[pixels.pixels().pixel[row]]));
    const std::vector<float> weight(rows.size(), 1.0f);
    std::vector<std::uint8_t> held(rows.size());
    for (auto& value : held) value = random.uniform() < 0.25 ? 1 : 0;
    return learn_orientation({fields, target, weight, held}).function;
}

/// Median error of a rule, in degrees.
double rule_error(const OrientationFunction& function, PixelFeatures& pixels, const HatchingFields& truth) {
    const OrientationFields fields = pixels.orientations({});
    std::vector<float> errors;
    for (std::size_t row = 0; row < pixels.size(); ++row) {
        const std::uint32_t p = pixels.pixels().pixel[row];
        if (truth.level[p] == 0) continue;
        errors.push_back(orientation_difference(angle_of(function.evaluate(fields, row)), truth.orientation[0][p]) *
                         57.29578f);
    }
    return static_cast<double>(upper_median(errors));
}

FeatureMatrix levels_of(const HatchingFields& fields, const PixelFeatures& pixels,
                        std::span<const std::uint32_t> rows) {
    FeatureMatrix targets;
    targets.rows = rows.size();
    const std::span<float> levels = targets.add("level");
    for (std::size_t i = 0; i < rows.size(); ++i) levels[i] = fields.level[pixels.pixels().pixel[rows[i]]];
    return targets;
}

/// The level and the properties of rows.
FeatureMatrix targets_of(const HatchingFields& fields, const PixelFeatures& pixels,
                         std::span<const std::uint32_t> rows) {
    FeatureMatrix targets = levels_of(fields, pixels, rows);
    const auto pixel = [&](std::size_t i) { return pixels.pixels().pixel[rows[i]]; };
    for (std::size_t k = 0; k < k_stroke_properties; ++k) {
        const auto property = static_cast<StrokeProperty>(k);
        const std::span<float> column = targets.add(name_of(property));
        for (std::size_t i = 0; i < rows.size(); ++i) column[i] = property_of(fields, property)[pixel(i)];
    }
    return targets;
}

std::vector<std::uint32_t> some_of(std::vector<std::uint32_t> rows, std::size_t most, std::uint64_t seed) {
    Random(seed).shuffle(rows);
    rows.resize(std::min(rows.size(), most));
    return rows;
}

/// Returns the rows of the pixels on the finest square grid that has at most so many, so that they make a picture.
std::vector<std::uint32_t> grid_rows(const PixelFeatures& pixels, std::size_t most) {
    const auto width = static_cast<std::uint32_t>(pixels.view().width);
    std::vector<std::uint32_t> rows;
    for (std::uint32_t step = 1; step == 1 || rows.size() > most; ++step) {
        rows.clear();
        for (std::uint32_t row = 0; row < pixels.size(); ++row) {
            const std::uint32_t p = pixels.pixels().pixel[row];
            if (p % width % step == 0 && p / width % step == 0) rows.push_back(row);
        }
    }
    return rows;
}

std::vector<std::uint32_t> all_rows(const PixelFeatures& pixels) {
    std::vector<std::uint32_t> rows(pixels.size());
    std::iota(rows.begin(), rows.end(), 0U);
    return rows;
}

/// Returns the rows that properties are learned from: pixels of center lines.
std::vector<std::uint32_t> stroke_rows(const PixelFeatures& pixels, const DrawingProperties& drawing) {
    std::vector<std::uint32_t> rows;
    for (std::uint32_t row = 0; row < pixels.size(); ++row) {
        const std::uint32_t p = pixels.pixels().pixel[row];
        if (drawing.center[p] && drawing.level[p] > 0) rows.push_back(row);
    }
    return rows;
}

/// Returns where rows are in the picture.
FeatureMatrix places_of(const PixelFeatures& pixels, std::span<const std::uint32_t> rows) {
    FeatureMatrix places;
    places.rows = rows.size();
    const auto width = static_cast<std::uint32_t>(pixels.view().width);
    const std::span<float> x = places.add("x");
    for (std::size_t i = 0; i < rows.size(); ++i) x[i] = static_cast<float>(pixels.pixels().pixel[rows[i]] % width);
    const std::span<float> y = places.add("y");
    for (std::size_t i = 0; i < rows.size(); ++i) {
        const std::uint32_t line = pixels.pixels().pixel[rows[i]] / width;
        y[i] = static_cast<float>(line);
    }
    return places;
}

/// A set of rows for other programs: files of `folder` that begin with `name`.
struct RowExport {
    fs::path folder;
    std::string name;
    std::vector<std::uint32_t> rows;

    void write(const char* part, const FeatureMatrix& matrix) const {
        write_npy(folder / fmt::format("{}_{}.npy", name, part), matrix);
    }
    /// Writes features, measured or true targets, and coordinates.
    void write_examples(PixelFeatures& pixels, const HatchingFields& targets) const {
        fs::create_directories(folder);
        std::vector<std::uint32_t> all(k_pixel_features);
        std::iota(all.begin(), all.end(), 0U);
        write("x", pixels.scalars(all, rows));
        write("y", targets_of(targets, pixels, rows));
        write("pixel", places_of(pixels, rows));
    }
};

/// Returns the measured values of a drawing as hatching fields.
HatchingFields measured_fields(const DrawingProperties& drawing) {
    HatchingFields fields(drawing.width, drawing.height);
    fields.level = drawing.level;
    for (std::size_t k = 0; k < k_stroke_properties; ++k)
        property_of(fields, static_cast<StrokeProperty>(k)) = drawing.property[k];
    return fields;
}

/// Returns the measured values that properties are learned from. Learning leaves out lengths of strokes that cross
/// others, so they are 0.
HatchingFields stroke_fields(const DrawingProperties& drawing) {
    HatchingFields fields = measured_fields(drawing);
    for (std::size_t p = 0; p < fields.size(); ++p)
        if (drawing.crossed[p]) fields.length[p] = 0;
    return fields;
}

/// Returns the true segment of each pixel, 0 or 1; nothing for styles of one segment.
std::vector<std::uint8_t> true_segments(const std::string& style, const HatchingFields& truth) {
    if (style != "parts") return {};
    std::vector<std::uint8_t> segments(truth.size());
    // Thick parts have strokes of length 50 at a spacing of 9, thin ones 25 at 7. Their ratio depends on no scale.
    for (std::size_t p = 0; p < segments.size(); ++p) segments[p] = truth.length[p] > 4.5f * truth.spacing[p] ? 1 : 0;
    return segments;
}

/// Tells which true segment a learned one stands for: the one that it covers most of in the training view.
class SegmentMatching {
  public:
    SegmentMatching() = default;
    SegmentMatching(std::span<const std::uint8_t> predicted, std::span<const std::uint8_t> truth,
                    std::span<const std::uint32_t> pixels) {
        std::vector<std::array<std::size_t, 2>> shared(k_no_segment);
        for (const std::uint32_t p : pixels) ++shared[predicted[p]][truth[p]];
        // A segment that the training view lacks stands for none.
        for (const auto& [first, second] : shared)
            meaning_.push_back(first + second == 0 ? k_no_segment : second > first ? 1 : 0);
    }
    double accuracy(std::span<const std::uint8_t> predicted, std::span<const std::uint8_t> truth,
                    std::span<const std::uint32_t> pixels) const {
        const auto right =
            std::ranges::count_if(pixels, [&](std::uint32_t p) { return meaning_[predicted[p]] == truth[p]; });
        return static_cast<double>(right) / static_cast<double>(pixels.size());
    }

  private:
    std::vector<std::uint8_t> meaning_;
};

/// Returns the share of the larger true segment: the accuracy of a constant guess.
double majority_segment(std::span<const std::uint8_t> truth, std::span<const std::uint32_t> pixels) {
    const auto second = std::ranges::count_if(pixels, [&](std::uint32_t p) { return truth[p] == 1; });
    const double share = static_cast<double>(second) / static_cast<double>(pixels.size());
    return std::max(share, 1 - share);
}

nlohmann::json row_of(const HatchingErrors& e) {
    return {{"orientation_degrees", e.orientation},
            {"level_accuracy", e.level_accuracy},
            {"majority_level", e.majority_level},
            {"thickness", e.property[0]},
            {"intensity", e.property[1]},
            {"spacing", e.property[2]},
            {"length", e.property[3]},
            {"pixels", e.pixels}};
}

class StyleEvaluation {
  public:
    StyleEvaluation(const EvaluateArguments& arguments, std::string style, Progress& progress)
        : arguments_(arguments), name_(std::move(style)), progress_(progress) {}

    nlohmann::json run() {
        train();
        for (std::size_t v = 0; v < k_views.size(); ++v) test(arguments_.meshes[0], k_views[v], v == 0);
        for (std::size_t m = 1; m < arguments_.meshes.size(); ++m) test(arguments_.meshes[m], k_views[0], false);
        result_["style"] = name_;
        result_["in_words"] = describe_hatching_style(style_);
        return result_;
    }

  private:
    void train() {
        HatchScene scene(scene_of(arguments_, arguments_.meshes[0], k_views[0]), arguments_.common.device, true);
        const RuledDrawing drawn = draw_by_rule(name_, scene.pixels(), scene.tools().placer, arguments_.seed);
        const HatchingFields& truth = drawn.truth;
        Stopwatch watch;
        // Rounded to eight bits, as in a file.
        FloatImage darkness(truth.width, truth.height, 1);
        for (std::size_t i = 0; i < drawn.ink.size(); ++i) darkness.data[i] = std::round(255 * drawn.ink[i]) / 255;
        const DrawingProperties drawing = drawing_properties(measure_strokes(darkness, object_mask(scene.pixels())));
        result_["measured"] = measured_errors(drawing, truth);
        result_["measured"]["level_accuracy"] =
            compare_hatching(measured_fields(drawing), truth, scene.pixels().pixels().pixel).level_accuracy;
        StyleReport report;
        style_ = learn_hatching_style(scene.pixels(), drawing, scene.tools().scorer, {.seed = arguments_.seed}, report);
        result_["training_seconds"] = watch.wall();
        global_ = one_rule(scene.pixels(), drawing, false, arguments_.seed);
        curvature_ = one_rule(scene.pixels(), drawing, true, arguments_.seed);
        if (!arguments_.peers.empty()) export_training(scene.pixels(), drawing);
        progress_.advance(1, name_ + " learned");
    }

    /// Writes what a style is learned from: levels at as many pixels, and properties at all that it chooses from.
    void export_training(PixelFeatures& pixels, const DrawingProperties& drawing) const {
        RowExport{arguments_.peers, name_ + "_train", some_of(all_rows(pixels), StyleLearningOptions().samples, 1)}
            .write_examples(pixels, measured_fields(drawing));
        const std::vector<std::uint32_t> strokes = stroke_rows(pixels, drawing);
        RowExport{arguments_.peers, name_ + "_strokes", some_of(strokes, strokes.size(), 1)}.write_examples(
            pixels, stroke_fields(drawing));
    }

    /// Writes rows of a picture with the truth, what was learned, and the levels without the cut. The training view
    /// is told apart, since what was learned has seen its pixels.
    void export_test(HatchScene& scene, const HatchingFields& truth, const HatchingFields& learned,
                     const std::string& picture, bool training_view) const {
        PixelFeatures& pixels = scene.pixels();
        const RowExport test{arguments_.peers, fmt::format("{}_{}_{}", name_, training_view ? "seen" : "test", picture),
                             grid_rows(pixels, k_test_rows)};
        test.write_examples(pixels, truth);
        test.write("learned", targets_of(learned, pixels, test.rows));
        HatchingStyle uncut = style_;
        uncut.level_crf.strength = 0;  // The cut then takes the most probable level of each pixel.
        const HatchingPrediction boosted =
            predict_hatching(uncut, pixels, scene.tools().scorer, scene.tools().evaluator);
        test.write("boosted", levels_of(boosted.fields, pixels, test.rows));
    }

    /// Compares segments with the true ones. The training view comes first, and teaches which is which.
    void add_segments(nlohmann::json& row, std::span<const std::uint8_t> predicted, const HatchingFields& truth,
                      std::span<const std::uint32_t> pixels, bool training_view) {
        const std::vector<std::uint8_t> segments = true_segments(name_, truth);
        if (segments.empty()) return;
        if (training_view) matching_ = SegmentMatching(predicted, segments, pixels);
        row["segment_accuracy"] = matching_.accuracy(predicted, segments, pixels);
        row["majority_segment"] = majority_segment(segments, pixels);
    }

    /// Compares the values measured on the drawing's center lines with the rule.
    static nlohmann::json measured_errors(const DrawingProperties& drawing, const HatchingFields& truth) {
        std::array<std::vector<float>, k_stroke_properties> ratios;
        std::vector<float> angles;
        for (std::uint32_t p = 0; p < truth.size(); ++p) {
            if (!drawing.center[p] || truth.level[p] == 0) continue;
            float difference = orientation_difference(drawing.orientation[p], truth.orientation[0][p]);
            if (truth.level[p] == 2)
                difference =
                    std::min(difference, orientation_difference(drawing.orientation[p], truth.orientation[1][p]));
            if (!drawing.crossing[p]) angles.push_back(difference * 57.29578f);
            for (std::size_t k = 0; k < k_stroke_properties; ++k)
                ratios[k].push_back(
                    std::abs(drawing.property[k][p] / property_of(truth, static_cast<StrokeProperty>(k))[p] - 1));
        }
        nlohmann::json out = {{"orientation_degrees", upper_median(angles)}};
        for (std::size_t k = 0; k < k_stroke_properties; ++k)
            out[name_of(static_cast<StrokeProperty>(k))] = upper_median(ratios[k]);
        return out;
    }

    void test(const fs::path& mesh, const char* view, bool training_view) {
        HatchScene scene(scene_of(arguments_, mesh, view), arguments_.common.device, true);
        PixelFeatures& pixels = scene.pixels();
        const HatchingPrediction predicted =
            predict_hatching(style_, pixels, scene.tools().scorer, scene.tools().evaluator);
        // By now features are measured at the scale of the training view, as the rule was.
        const HatchingFields truth = hatching_by_rule(name_, pixels);
        nlohmann::json row = row_of(compare_hatching(predicted.fields, truth, pixels.pixels().pixel));
        add_segments(row, predicted.segment, truth, pixels.pixels().pixel, training_view);
        row["mesh"] = mesh.stem().string();
        row["view"] = view;
        row["kind"] = training_view ? "training view" : mesh == arguments_.meshes[0] ? "other view" : "other mesh";
        row["global_rule_degrees"] = rule_error(global_, pixels, truth);
        row["curvature_only_degrees"] = rule_error(curvature_, pixels, truth);
        const auto barriers = occlusion_barriers(pixels.gbuffer().depth, truth.width, truth.height);
        std::vector<HatchStroke> strokes = place_evenly(scene.tools().placer, predicted.fields, barriers, {});
        match_tone(strokes, predicted.fields);
        row["drawn_spacing"] = measure_spacing(strokes, predicted.fields).median_error;
        row["drawn_tone"] = measure_tone(strokes, predicted.fields).median_error;
        if (!arguments_.peers.empty())
            export_test(scene, truth, predicted.fields, fmt::format("{}_{}", mesh.stem().string(), view),
                        training_view);
        result_["rows"].push_back(row);
        progress_.advance(1, fmt::format("{} on {}, {}", name_, mesh.stem().string(), view));
    }

    const EvaluateArguments& arguments_;
    std::string name_;
    Progress& progress_;
    HatchingStyle style_;
    OrientationFunction global_, curvature_;
    SegmentMatching matching_;
    nlohmann::json result_;
};

std::string percent_cell(const nlohmann::json& row, const char* key) {
    return fmt::format("{:.1f}%", 100 * row[key].get<double>());
}

/// Returns a share, and in brackets that of a constant guess; a dash if there is nothing to guess.
std::string beside_majority(const nlohmann::json& row, const char* key, const char* majority) {
    if (!row.contains(key)) return "-";
    return fmt::format("{} ({})", percent_cell(row, key), percent_cell(row, majority));
}

void print_result(const nlohmann::json& result) {
    fmt::print("{}: learned in {:.0f} s\n{}", result["style"].get<std::string>(),
               result["training_seconds"].get<double>(), result["in_words"].get<std::string>());
    fmt::print("{:>34} {:>7} {:>7} {:>9} {:>16} {:>18} {:>9} {:>9} {:>8} {:>6} {:>13} {:>6}\n", "", "degrees", "global",
               "curvature", "level (majority)", "segment (majority)", "thickness", "intensity", "spacing", "length",
               "drawn spacing", "tone");
    const nlohmann::json& read = result["measured"];
    fmt::print("{:>34} {:7.1f} {:>17} {:>16} {:>18} {:>9} {:>9} {:>8} {:>6}\n", "as read from the drawing",
               read["orientation_degrees"].get<double>(), "", percent_cell(read, "level_accuracy"), "",
               percent_cell(read, "thickness"), percent_cell(read, "intensity"), percent_cell(read, "spacing"),
               percent_cell(read, "length"));
    for (const nlohmann::json& row : result["rows"]) {
        fmt::print("{:>34} {:7.1f} {:7.1f} {:9.1f} {:>16} {:>18} {:>9} {:>9} {:>8} {:>6} {:>13} {:>6}\n",
                   row["mesh"].get<std::string>() + ", " + row["view"].get<std::string>(),
                   row["orientation_degrees"].get<double>(), row["global_rule_degrees"].get<double>(),
                   row["curvature_only_degrees"].get<double>(),
                   beside_majority(row, "level_accuracy", "majority_level"),
                   beside_majority(row, "segment_accuracy", "majority_segment"), percent_cell(row, "thickness"),
                   percent_cell(row, "intensity"), percent_cell(row, "spacing"), percent_cell(row, "length"),
                   percent_cell(row, "drawn_spacing"), percent_cell(row, "drawn_tone"));
    }
}

void run_hatch_evaluate(EvaluateArguments arguments) {
    const auto limits = apply_common_options(arguments.common);
    if (arguments.styles.empty()) arguments.styles.assign(hatching_rule_names().begin(), hatching_rule_names().end());
    for (const std::string& style : arguments.styles) {
        if (std::ranges::find(hatching_rule_names(), style) == hatching_rule_names().end())
            throw UsageError(fmt::format("--styles '{}' is not built in; there are {}", style,
                                         fmt::join(hatching_rule_names(), ", ")));
    }
    require_distinct_names(arguments.meshes);
    for (const fs::path& mesh : arguments.meshes) {
        HatchSceneArguments scene = scene_of(arguments, mesh, k_views[0]);
        require_hatch_scene(scene);
    }
    if (!arguments.peers.empty()) require_output_folder(arguments.peers);
    Progress progress("evaluating", arguments.styles.size() * (k_views.size() + arguments.meshes.size()));
    nlohmann::json results = nlohmann::json::array();
    for (const std::string& style : arguments.styles)
        results.push_back(StyleEvaluation(arguments, style, progress).run());
    progress.finish();
    if (!arguments.common.quiet) {
        for (const nlohmann::json& result : results) print_result(result);
    }
    write_report(arguments.common, results);
}

}  // namespace

void add_hatch_evaluate_command(Command& hatch) {
    auto arguments = std::make_shared<EvaluateArguments>();
    Command* command =
        hatch.add_subcommand("evaluate", "Learns styles whose rule is known, and tests them on other views and meshes");
    command->footer(
        "The first mesh is drawn and learned from, in one view; tested are three other views of it, and the other\n"
        "meshes. Errors are medians, beside the rule.\n\nExample:\n"
        "  exemplar hatch evaluate cow.obj spot.obj bunny.off horse.ply --styles contour,parts");
    command->add_option("MESH", arguments->meshes, "meshes; the first is learned from")->required()->type_name("");
    command
        ->add_option("--styles", arguments->styles,
                     fmt::format("which of {}; default: all", fmt::join(hatching_rule_names(), ", ")))
        ->type_name("NAME")
        ->check(completion_words(hatching_rule_names()))
        ->delimiter(',')
        ->allow_extra_args(false);
    command->add_option("--size", arguments->size, "pixels of the drawings")->type_name("WxH")->capture_default_str();
    command->add_option("--seed", arguments->seed, "of drawing and learning")
        ->capture_default_str()
        ->check(whole_number(0));
    command
        ->add_option("--export", arguments->peers,
                     "writes features, pixels, truths and what was learned as .npy into this folder")
        ->type_name("FOLDER");
    add_device_option(*command, arguments->common);
    add_common_options(*command, arguments->common);
    command->callback([arguments] { run_hatch_evaluate(*arguments); });
}

}  // namespace exemplar
