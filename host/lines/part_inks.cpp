#include "host/lines/part_inks.h"

#include <fmt/format.h>

#include <algorithm>

#include "host/core/errors.h"

namespace exemplar {
namespace {

/// Returns the ink of each label, and adds inks that are not those of the style.
std::vector<std::uint32_t> ink_of_labels(const FaceLabels& labels, const std::map<std::string, PartInk>& ink_of_label,
                                         PartInks& inks) {
    std::vector<std::uint32_t> ink(labels.names.size(), 0);
    bool known = false;
    for (std::size_t label = 0; label < ink.size(); ++label) {
        auto found = ink_of_label.find(labels.names[label]);
        if (found == ink_of_label.end()) found = ink_of_label.find("*");
        if (found == ink_of_label.end()) continue;
        known = true;
        if (found->second == PartInk{}) continue;
        ink[label] = static_cast<std::uint32_t>(inks.inks.size());
        inks.inks.push_back(found->second);
        inks.names.push_back(labels.names[label]);
    }
    if (!known)
        throw UsageError(fmt::format("none of the labels {} has a line or a hatching of its own; name one, or \"*\"",
                                     fmt::join(labels.names, ", ")));
    return ink;
}

/// Adds the pieces of a visible run to the strokes of their inks.
void divide_run(const StrokeRun& run, const PartInks& inks, std::map<std::uint32_t, std::vector<Stroke>>& strokes) {
    const auto ink_at = [&](std::size_t i) { return inks.ink_of_face.at(run.points[i].face); };
    for (std::size_t first = 0, last = 0; first + 1 < run.points.size(); first = last) {
        const std::uint32_t ink = ink_at(first);
        last = first + 1;
        while (last + 1 < run.points.size() && ink_at(last) == ink) ++last;
        if (inks.inks[ink].width <= 0) continue;
        Stroke& stroke = strokes[ink].emplace_back();
        stroke.points.assign(run.points.begin() + static_cast<std::ptrdiff_t>(first),
                             run.points.begin() + static_cast<std::ptrdiff_t>(last) + 1);
        for (StrokePoint& point : stroke.points) point.width *= inks.inks[ink].width;
        stroke.points.back().visible = true;
        stroke.closed = run.closed && last - first + 1 == run.points.size();
    }
}

}  // namespace

PartInks inks_of_parts(const TriangleMesh& mesh, const FaceLabels& labels,
                       const std::map<std::string, PartInk>& ink_of_label) {
    const bool of_file = labels.label.size() == mesh.source_face_count;
    if (!of_file && labels.label.size() != mesh.face_count())
        throw UsageError(
            fmt::format("{} labels are not of a mesh with {} faces", labels.label.size(), mesh.source_face_count));
    PartInks inks{{PartInk{}}, {std::string()}, {}};
    const std::vector<std::uint32_t> ink = ink_of_labels(labels, ink_of_label, inks);
    inks.ink_of_face.reserve(mesh.face_count());
    for (std::uint32_t f = 0; f < mesh.face_count(); ++f) {
        const std::int32_t label = labels.label[of_file ? mesh.source_of(f) : f];
        inks.ink_of_face.push_back(label < 0 ? 0 : ink[static_cast<std::size_t>(label)]);
    }
    return inks;
}

std::string name_of_layer(std::string_view layer, const PartInks& inks, std::uint32_t ink) {
    return ink > 0 ? fmt::format("{}: {}", layer, inks.names[ink]) : std::string(layer);
}

std::vector<InkedStrokes> strokes_by_ink(std::span<const Stroke> strokes, const PartInks& inks) {
    std::map<std::uint32_t, std::vector<Stroke>> by_ink;
    for (const Stroke& stroke : strokes)
        for (const StrokeRun& run : visible_runs(stroke)) divide_run(run, inks, by_ink);
    std::vector<InkedStrokes> result;
    result.reserve(by_ink.size());
    for (auto& [ink, own] : by_ink) result.push_back({ink, std::move(own)});
    return result;
}

}  // namespace exemplar
