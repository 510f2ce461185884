#include "apps/exemplar/lines/lines_comparison.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>

#include "host/curvature/model/evaluation.h"
#include "host/imaging/side_by_side.h"

namespace exemplar {
namespace {

using Shares = LineDifference::Shares;

void print_share_row(std::string_view name, const Shares& in_view, const Shares& from_around) {
    fmt::print("{:<24}{:>14.2f}{:>8.2f}{:>20.2f}{:>8.2f}\n", name, 100 * in_view.truth, 100 * in_view.misclassified,
               100 * from_around.truth, 100 * from_around.misclassified);
}

nlohmann::json describe_row(const Shares& in_view, const Shares& from_around) {
    return {{"faces_with_line", in_view.truth},
            {"misclassified", in_view.misclassified},
            {"six_sides", {{"faces_with_line", from_around.truth}, {"misclassified", from_around.misclassified}}}};
}

}  // namespace

std::vector<LineType> types_to_compare(std::span<const LineType> types) {
    std::vector<LineType> result;
    std::copy_if(types.begin(), types.end(), std::back_inserter(result), needs_curvature);
    return result;
}

LinesComparison::LinesComparison(const LinesJob& job, LinesSource& source, FrameDrawer& drawer)
    : source_(source), drawer_(drawer), types_(types_to_compare(job.types)), in_view_(types_), from_around_(types_) {}

Image LinesComparison::draw(std::size_t frame) {
    const std::array<Vec3, 6> eyes = eyes_around(source_.vertices(frame));
    std::array<Image, 2> images;
    std::array<FaceTypes, 2> in_view;
    std::array<std::array<FaceTypes, eyes.size()>, 2> from_around;
    constexpr std::array k_sources{CurvatureSource::learned, CurvatureSource::estimated};
    for (std::size_t i = 0; i < k_sources.size(); ++i) {
        images[i] = drawer_.draw(frame, k_sources[i]);
        in_view[i] = drawer_.face_types();
        std::transform(eyes.begin(), eyes.end(), from_around[i].begin(),
                       [&](const Vec3& eye) { return drawer_.face_types_from(eye); });
    }
    in_view_.add(in_view[1], in_view[0]);
    for (std::size_t e = 0; e < eyes.size(); ++e) from_around_.add(from_around[1][e], from_around[0][e]);
    return side_by_side(images);
}

void LinesComparison::print() const {
    fmt::print("{:<24}{:>22}{:>28}\n", "faces, %", "in this view", "from six sides");
    fmt::print("{:<24}{:>14}{:>8}{:>20}{:>8}\n", "", "with a line", "wrong", "with a line", "wrong");
    for (const LineType type : types_) print_share_row(name_of(type), in_view_.of(type), from_around_.of(type));
    if (types_.size() > 1) print_share_row("any of these", in_view_.of_any(), from_around_.of_any());
}

nlohmann::json LinesComparison::describe() const {
    nlohmann::json types = nlohmann::json::object();
    for (const LineType type : types_)
        types[std::string(name_of(type))] = describe_row(in_view_.of(type), from_around_.of(type));
    return {{"types", types}, {"any", describe_row(in_view_.of_any(), from_around_.of_any())}};
}

}  // namespace exemplar
