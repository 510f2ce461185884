// Writes the report page that the browser test opens: make_page FILE.html. Built-in shapes, invented predictions.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <limits>
#include <list>

#include "apps/report/report_page.h"
#include "host/synth/shapes/shapes.h"

namespace {

using namespace exemplar;

constexpr std::size_t k_faces = 2000;
constexpr double k_unknown = std::numeric_limits<double>::quiet_NaN();

/// The shape's labels, wrong by one in the slab of width `wrong` around the middle height, where it is also unsure.
ReportMesh with_invented_errors(const std::string& name, const SynthShape& shape, float wrong) {
    ReportMesh item;
    item.name = name;
    item.mesh = &shape.mesh;
    item.truth = shape.labels.label;
    float low = std::numeric_limits<float>::max(), high = -low;
    for (const Vec3& vertex : shape.mesh.vertices) low = std::min(low, vertex.y()), high = std::max(high, vertex.y());
    const auto classes = static_cast<std::int32_t>(shape.labels.names.size());
    std::size_t right = 0;
    for (std::size_t f = 0; f < shape.mesh.face_count(); ++f) {
        const float y = shape.mesh.vertices[shape.mesh.faces[f][0]].y();
        const float from_middle = 2 * std::abs(y - (low + high) / 2) / (high - low);
        const bool is_wrong = from_middle < wrong;
        right += !is_wrong;
        item.predicted.push_back(is_wrong ? (item.truth[f] + 1) % classes : item.truth[f]);
        item.confidence.push_back(std::clamp(from_middle, 0.0f, 1.0f));
        item.entropy.push_back(1 - item.confidence.back() * item.confidence.back());
        item.border.push_back(f % 7 == 0 ? 1.0F : 0.0F);
    }
    item.recognition_rate = static_cast<double>(right) / static_cast<double>(shape.mesh.face_count());
    return item;
}

std::vector<ReportCurve> invented_curves() {
    std::vector<ReportCurve> curves;
    for (const char* name : {"unary 0", "unary 1", "pairwise 0"}) {
        ReportCurve curve{name, {}, 120, curves.size() != 1};
        const double best = 0.4 - 0.1 * static_cast<double>(curves.size());
        for (std::size_t rounds = 1; rounds <= 200; rounds += 10) {
            const double x = static_cast<double>(rounds) / 120;
            curve.points.push_back(
                {rounds, best + std::exp(-4 * x) + 0.02 * x * x, 0.1 * best + 0.3 * std::exp(-4 * x)});
        }
        curves.push_back(curve);
    }
    return curves;
}

ReportData make_group(const std::string& kind, std::list<SynthShape>& shapes) {
    ReportData group;
    group.title = kind;
    group.subtitle = "built-in shapes, invented errors <i>&amp;</i>";
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
        shapes.push_back(make_shape(kind, seed, k_faces));
        group.meshes.push_back(
            with_invented_errors(fmt::format("{}-{}", kind, seed), shapes.back(), 0.1f * static_cast<float>(seed)));
        const ReportMesh& mesh = group.meshes.back();
        group.scores.push_back({mesh.name,
                                {{"recognition rate", mesh.recognition_rate},
                                 {"cut discrepancy", 0.05 * static_cast<double>(seed), k_unknown, true, false}}});
        group.recognition_rate = mesh.recognition_rate;
    }
    group.label_names = shapes.back().labels.names;
    const std::size_t classes = group.label_names.size();
    for (std::size_t c = 0; c < classes; ++c) group.label_colors.push_back(label_color(c));
    group.confusion.assign(classes * classes, 0.01);
    for (std::size_t c = 0; c < classes; ++c) group.confusion[c * classes + c] = c ? 0.1 : 5;
    group.measures = {{"recognition rate", group.recognition_rate, 0.9},
                      {"Rand index error", 0.12, 0.143, true},
                      {"cut discrepancy", 0.15, k_unknown, true, false}};
    group.reference_name = "thesis";
    group.stage_features = {{"unary 0", {{"curvature", 40}, {"shape_context", 60}}},
                            {"unary 1", {{"curvature", 10}, {"context", 90}}}};
    group.first_features = {"curvature.k1.2", "shape_context.44"};
    group.curves = invented_curves();
    group.tables = {{"Anything",
                     "Texts from <b>elsewhere</b>.",
                     {"Name", "Count", "Remark"},
                     {{"<script>alert(1)</script>.off", "1,234", "<img src=x onerror=alert(1)>"}, {"plain", "5", ""}}}};
    group.timings = {{"features", 12.5}, {"training", 480}};
    group.summary = {{"Recognition rate", fmt::format("{:.1f} %", 100 * group.recognition_rate)}};
    return group;
}

/// Red and blue in turns, a second each.
constexpr const char* k_playing_svg =
    R"(<svg xmlns="http://www.w3.org/2000/svg" width="200px" height="50px" viewBox="0 0 200 50">)"
    R"(<rect width="200" height="50" fill="#ff0000"><animate attributeName="fill" calcMode="discrete" )"
    R"(values="#ff0000;#0000ff" keyTimes="0;0.5" dur="2s" repeatCount="indefinite"/></rect></svg>)";

}  // namespace

int main(int argc, char** argv) {
    if (argc != 2) {
        fmt::print(stderr, "usage: make_page FILE.html\n");
        return 2;
    }
    try {
        std::list<SynthShape> shapes;
        const std::vector<ReportData> groups{make_group("human", shapes), make_group("cup", shapes)};
        const std::vector<ReportDrawing> drawings{
            {.title = "A drawing", .text = "It plays.", .svg = k_playing_svg, .captions = {"left", "right"}}};
        write_report_page(argv[1], "Report for the browser's test", groups, drawings);
    } catch (const std::exception& error) {
        fmt::print(stderr, "error: {}\n", error.what());
        return 1;
    }
    return 0;
}
