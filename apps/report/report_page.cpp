#include "apps/report/report_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <ostream>
#include <string_view>

#include "embedded/report_page.h"
#include "host/core/errors.h"
#include "host/core/files.h"
#include "host/core/json_text.h"
#include "host/core/text.h"

namespace exemplar {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t k_max_labels = 255;
constexpr std::uint8_t k_unlabeled = 255;
/// Rounding may leave a probability this far outside [0, 1].
constexpr float k_probability_slack = 1e-3f;

// ---- checks

void check_count(std::size_t actual, std::size_t expected, const std::string& where, std::string_view what) {
    if (actual == expected) return;
    throw UsageError(fmt::format("report page: {}: {} {} where {} are needed", where, actual, what, expected));
}

void check_labels(std::span<const std::int32_t> labels, std::int32_t lowest, std::size_t classes,
                  const std::string& where, std::string_view what) {
    for (std::size_t f = 0; f < labels.size(); ++f) {
        if (labels[f] >= lowest && labels[f] < static_cast<std::int32_t>(classes)) continue;
        throw UsageError(fmt::format("report page: {}: {} label of face {} is {}, but there are {} labels", where, what,
                                     f, labels[f], classes));
    }
}

void check_geometry(const TriangleMesh& mesh, const std::string& where) {
    for (std::size_t f = 0; f < mesh.face_count(); ++f)
        for (const std::uint32_t v : mesh.faces[f]) {
            if (v >= mesh.vertex_count())
                throw UsageError(
                    fmt::format("report page: {}: face {} names vertex {} of {}", where, f, v, mesh.vertex_count()));
            if (!mesh.vertices[v].allFinite())
                throw UsageError(
                    fmt::format("report page: {}: vertex {} is not finite; validate the mesh first", where, v));
        }
}

void check_shares(const std::vector<float>& values, const std::string& where, const char* what) {
    for (std::size_t f = 0; f < values.size(); ++f)
        if (!(values[f] >= -k_probability_slack && values[f] <= 1 + k_probability_slack))
            throw UsageError(
                fmt::format("report page: {}: {} of face {} is {}, not in [0, 1]", where, what, f, values[f]));
}

void check_mesh(const ReportMesh& item, std::size_t classes) {
    const std::string where = fmt::format("mesh '{}'", item.name);
    if (!item.mesh) throw UsageError(fmt::format("report page: {}: has no triangles attached (null)", where));
    const std::size_t faces = item.mesh->face_count();
    check_count(item.predicted.size(), faces, where, "predicted labels");
    if (!item.truth.empty()) check_count(item.truth.size(), faces, where, "true labels");
    check_count(item.confidence.size(), faces, where, "confidences");
    if (!item.entropy.empty()) check_count(item.entropy.size(), faces, where, "entropies");
    if (!item.border.empty()) check_count(item.border.size(), faces, where, "borders");
    check_shares(item.confidence, where, "confidence");
    check_shares(item.entropy, where, "entropy");
    check_shares(item.border, where, "border");
    check_labels(item.predicted, 0, classes, where, "predicted");
    check_labels(item.truth, -1, classes, where, "true");
    check_geometry(*item.mesh, where);
}

void check_curve(const ReportCurve& curve, const std::string& where) {
    for (std::size_t i = 1; i < curve.points.size(); ++i)
        if (curve.points[i].rounds <= curve.points[i - 1].rounds)
            throw UsageError(fmt::format("report page: {}: curve '{}' goes from {} to {} rounds; they must ascend",
                                         where, curve.name, curve.points[i - 1].rounds, curve.points[i].rounds));
}

void check_group(const ReportData& group) {
    const std::string where = fmt::format("group '{}'", group.title);
    const std::size_t classes = group.label_names.size();
    if (classes > k_max_labels)
        throw UsageError(
            fmt::format("report page: {}: {} labels; at most {} can be shown", where, classes, k_max_labels));
    check_count(group.label_colors.size(), classes, where, "label colors");
    if (!group.confusion.empty()) check_count(group.confusion.size(), classes * classes, where, "confusion entries");
    for (const double share : group.confusion)
        if (!(share >= 0) || !std::isfinite(share))
            throw UsageError(fmt::format("report page: {}: confusion entry {} is not a share of area", where, share));
    for (const ReportMesh& item : group.meshes) check_mesh(item, classes);
    for (const ReportCurve& curve : group.curves) check_curve(curve, where);
    for (const ReportTable& table : group.tables)
        for (const auto& row : table.rows)
            check_count(row.size(), table.columns.size(), fmt::format("table '{}'", table.title), "cells in a row");
}

// ---- packing

/// Bytes of one mesh in the order the page reads them: positions (3 x u16 each), indices (3 x u16 or u32 each),
/// predicted labels (u8), true labels (u8, 255 = unlabeled; left out if unknown), confidences, entropies and borders
/// (u8 each, the last two left out if unknown). Little-endian.
struct PackedMesh {
    std::string bytes;
    Vec3d origin = Vec3d::Zero();
    Vec3d step = Vec3d::Zero();  ///< position = origin + step * stored integer
};

template <typename Integer>
void append_little_endian(std::string& bytes, Integer value) {
    for (std::size_t i = 0; i < sizeof(Integer); ++i) bytes.push_back(static_cast<char>((value >> (8 * i)) & 0xff));
}

/// Positions rounded to 16 bits in the box of the vertices that faces use; others are clamped into it.
void pack_positions(const TriangleMesh& mesh, PackedMesh& packed) {
    Vec3d low = Vec3d::Constant(std::numeric_limits<double>::infinity()), high = -low;
    for (const Face& face : mesh.faces)
        for (const std::uint32_t v : face) {
            low = low.cwiseMin(mesh.vertices[v].cast<double>());
            high = high.cwiseMax(mesh.vertices[v].cast<double>());
        }
    if (mesh.faces.empty()) low = high = Vec3d::Zero();
    packed.origin = low;
    packed.step = (high - low) / 65535.0;
    for (const Vec3& vertex : mesh.vertices)
        for (int axis = 0; axis < 3; ++axis) {
            const double offset = static_cast<double>(vertex[axis]) - low[axis];
            const double steps = packed.step[axis] > 0 ? offset / packed.step[axis] : 0;
            // The comparisons send NaN coordinates of unused vertices to 0.
            const double inside = steps > 0 ? std::min(steps, 65535.0) : 0;
            append_little_endian(packed.bytes, static_cast<std::uint16_t>(std::lround(inside)));
        }
}

PackedMesh pack_mesh(const ReportMesh& item) {
    PackedMesh packed;
    const TriangleMesh& mesh = *item.mesh;
    packed.bytes.reserve(6 * mesh.vertex_count() + 17 * mesh.face_count());
    pack_positions(mesh, packed);
    const bool wide = mesh.vertex_count() > 65536;
    for (const Face& face : mesh.faces)
        for (const std::uint32_t v : face) {
            if (wide)
                append_little_endian(packed.bytes, v);
            else
                append_little_endian(packed.bytes, static_cast<std::uint16_t>(v));
        }
    for (const std::int32_t label : item.predicted) packed.bytes.push_back(static_cast<char>(label));
    for (const std::int32_t label : item.truth)
        packed.bytes.push_back(static_cast<char>(label < 0 ? k_unlabeled : static_cast<std::uint8_t>(label)));
    for (const std::vector<float>* values : {&item.confidence, &item.entropy, &item.border})
        for (const float value : *values)
            packed.bytes.push_back(static_cast<char>(std::lround(255 * std::clamp(value, 0.0f, 1.0f))));
    return packed;
}

// ---- description

Json number_or_null(double value) {
    return std::isfinite(value) ? Json(value) : Json(nullptr);
}

Json triple(const Vec3d& v) {
    return Json::array({v[0], v[1], v[2]});
}

Json describe_mesh(const ReportMesh& item, const PackedMesh& packed) {
    return {{"name", item.name},
            {"vertices", item.mesh->vertex_count()},
            {"faces", item.mesh->face_count()},
            {"origin", triple(packed.origin)},
            {"step", triple(packed.step)},
            {"truth", !item.truth.empty()},
            {"hasEntropy", !item.entropy.empty()},
            {"hasBorder", !item.border.empty()},
            {"unlabeled", std::ranges::find(item.truth, -1) != item.truth.end()},
            {"rate", number_or_null(item.recognition_rate)}};
}

template <typename Value>
Json pairs(const std::vector<std::pair<std::string, Value>>& rows) {
    Json result = Json::array();
    for (const auto& [key, value] : rows) result.push_back(Json::array({key, value}));
    return result;
}

Json describe_measures(const std::vector<ReportMeasure>& measures) {
    Json result = Json::array();
    for (const ReportMeasure& measure : measures)
        result.push_back({{"name", measure.name},
                          {"value", number_or_null(measure.value)},
                          {"reference", number_or_null(measure.reference)},
                          {"lower", measure.lower_is_better},
                          {"share", measure.share}});
    return result;
}

Json describe_tables(const std::vector<ReportTable>& tables) {
    Json result = Json::array();
    for (const ReportTable& table : tables)
        result.push_back(
            {{"title", table.title}, {"note", table.note}, {"columns", table.columns}, {"rows", table.rows}});
    return result;
}

Json describe_scores(const std::vector<ReportScore>& scores) {
    Json result = Json::array();
    for (const ReportScore& score : scores)
        result.push_back({{"name", score.name}, {"measures", describe_measures(score.measures)}});
    return result;
}

/// Points as [rounds, loss, error].
Json describe_curves(const std::vector<ReportCurve>& curves) {
    Json result = Json::array();
    for (const ReportCurve& curve : curves) {
        Json points = Json::array();
        for (const ReportCurvePoint& point : curve.points)
            points.push_back(Json::array({point.rounds, number_or_null(point.loss), number_or_null(point.error)}));
        result.push_back(
            {{"name", curve.name}, {"points", points}, {"chosen", curve.chosen_rounds}, {"kept", curve.kept}});
    }
    return result;
}

Json describe_stages(const std::vector<ReportStageFeatures>& stages) {
    Json result = Json::array();
    for (const ReportStageFeatures& stage : stages)
        result.push_back({{"stage", stage.stage}, {"families", pairs(stage.families)}});
    return result;
}

Json describe_group(const ReportData& group) {
    Json colors = Json::array();
    for (const auto& [red, green, blue] : group.label_colors)
        colors.push_back(fmt::format("#{:02x}{:02x}{:02x}", red, green, blue));
    Json timings = Json::array();
    for (const auto& [what, seconds] : group.timings) timings.push_back(Json::array({what, number_or_null(seconds)}));
    return {{"title", group.title},
            {"subtitle", group.subtitle},
            {"rate", number_or_null(group.recognition_rate)},
            {"labels", group.label_names},
            {"colors", colors},
            {"confusion", group.confusion},
            {"families", pairs(group.feature_families)},
            {"features", group.first_features},
            {"timings", timings},
            {"summary", pairs(group.summary)},
            {"measures", describe_measures(group.measures)},
            {"reference", group.reference_name},
            {"scores", describe_scores(group.scores)},
            {"stages", describe_stages(group.stage_features)},
            {"curves", describe_curves(group.curves)},
            {"tables", describe_tables(group.tables)},
            {"meshes", Json::array()}};
}

// ---- page

std::string escaped_html(std::string_view text) {
    std::string result;
    for (const char c : text) {
        switch (c) {
            case '&':
                result += "&amp;";
                break;
            case '<':
                result += "&lt;";
                break;
            case '>':
                result += "&gt;";
                break;
            case '"':
                result += "&quot;";
                break;
            case '\'':
                result += "&#39;";
                break;
            default:
                result += c;
        }
    }
    return result;
}

/// JSON for a <script> element: only strings can hold '<', and without it no name can end the element or open a
/// comment.
std::string script_json(const Json& json) {
    std::string result;
    for (const char c : ordered_json_text(json, -1, true)) {
        if (c == '<')
            result += "\\u003c";
        else
            result += c;
    }
    return result;
}

template <std::size_t Size>
std::string_view embedded_text(const unsigned char (&bytes)[Size]) {
    return {reinterpret_cast<const char*>(bytes), Size};
}

/// The template up to the next `mark`; moves `rest` behind the mark.
std::string_view cut_at(std::string_view& rest, std::string_view mark) {
    const std::size_t at = rest.find(mark);
    if (at == std::string_view::npos) throw UsageError(fmt::format("report page: the template lacks {}", mark));
    const std::string_view before = rest.substr(0, at);
    rest.remove_prefix(at + mark.size());
    return before;
}

/// The data elements: one of base64 per mesh, so that the page decodes a mesh when it is first seen, and the JSON.
void write_data(std::ostream& out, const std::string& title, std::span<const ReportData> groups) {
    Json page = {{"title", title}, {"groups", Json::array()}};
    for (std::size_t g = 0; g < groups.size(); ++g) {
        Json group = describe_group(groups[g]);
        for (std::size_t m = 0; m < groups[g].meshes.size(); ++m) {
            const PackedMesh packed = pack_mesh(groups[g].meshes[m]);
            out << fmt::format("<script type=\"text/plain\" id=\"mesh-{}-{}\">{}</script>\n", g, m,
                               base64(packed.bytes));
            group["meshes"].push_back(describe_mesh(groups[g].meshes[m], packed));
        }
        page["groups"].push_back(std::move(group));
    }
    out << "<script type=\"application/json\" id=\"report\">" << script_json(page) << "</script>\n";
}

/// Embeds the drawing as an image: it may be animated, but cannot run scripts or mix with the page.
void write_drawing(std::ostream& out, const ReportDrawing& drawing) {
    out << "<section class=\"wide drawing\">\n<h2>" << escaped_html(drawing.title) << "</h2>\n<p class=\"soft\">"
        << escaped_html(drawing.text) << "</p>\n<figure>\n<img alt=\"" << escaped_html(drawing.title)
        << "\" src=\"data:image/svg+xml;base64," << base64(drawing.svg) << "\">\n<figcaption>";
    for (const std::string& caption : drawing.captions) out << "<span>" << escaped_html(caption) << "</span>";
    out << "</figcaption>\n</figure>\n</section>\n";
}

}  // namespace

void write_report_page(const std::filesystem::path& path, const std::string& title, std::span<const ReportData> groups,
                       std::span<const ReportDrawing> drawings) {
    if (groups.empty()) throw UsageError("report page: there is no group to show; give at least one");
    for (const ReportData& group : groups) check_group(group);
    std::string_view rest = embedded_text(embedded::k_report_page);
    write_file_atomically(path, [&](std::ostream& out) {
        out << cut_at(rest, "{{title}}") << escaped_html(title);
        out << cut_at(rest, "{{style}}") << embedded_text(embedded::k_report_style);
        out << cut_at(rest, "{{drawings}}");
        for (const ReportDrawing& drawing : drawings) write_drawing(out, drawing);
        out << cut_at(rest, "{{data}}");
        write_data(out, title, groups);
        out << cut_at(rest, "{{script}}") << embedded_text(embedded::k_report_script);
        out << rest;
    });
}

}  // namespace exemplar
