#include "host/labeling/painting/simulated_person.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "host/mesh/queries/distance_queue.h"

namespace exemplar {
namespace {

constexpr float k_unreached = std::numeric_limits<float>::infinity();

std::span<const DualGraph::Arc> arcs_of(const DualGraph& graph, std::uint32_t face) {
    return std::span(graph.arcs).subspan(graph.begin[face], graph.begin[face + 1] - graph.begin[face]);
}

/// Distances inside a region (faces where `inside`), from its faces that have a start distance.
struct RegionSearch {
    std::vector<float> distance;
    std::vector<std::uint32_t> parent;
};

template <typename Inside>
RegionSearch search_region(const DualGraph& graph, std::span<const std::uint32_t> sources, const Inside& inside) {
    RegionSearch search;
    search.distance.assign(graph.face_count(), k_unreached);
    search.parent.assign(graph.face_count(), k_invalid_index);
    DistanceQueue queue;
    for (const std::uint32_t face : sources) search.distance[face] = 0, queue.push(0, face);
    while (!queue.empty()) {
        const auto [at, face] = queue.pop();
        if (at > search.distance[face]) continue;
        for (const auto& [other, length] : arcs_of(graph, face)) {
            if (!inside(other) || at + length >= search.distance[other]) continue;
            search.distance[other] = at + length;
            search.parent[other] = face;
            queue.push(at + length, other);
        }
    }
    return search;
}

std::uint32_t farthest(const RegionSearch& search, std::span<const std::uint32_t> region) {
    std::uint32_t best = region.front();
    float most = -1;
    for (const std::uint32_t face : region)
        if (search.distance[face] != k_unreached && search.distance[face] > most)
            most = search.distance[face], best = face;
    return best;
}

}  // namespace

SimulatedPerson::SimulatedPerson(const TriangleMesh& mesh, std::span<const std::int32_t> truth,
                                 const PersonOptions& options)
    : options_(options),
      truth_(truth.begin(), truth.end()),
      area_(face_areas(mesh)),
      center_(face_centers(mesh)),
      normal_(face_normals(mesh)),
      graph_(build_dual_graph(mesh, build_topology(mesh))) {
    const float total = std::max(std::accumulate(area_.begin(), area_.end(), 0.0F), 1e-30F);
    unit_ = std::sqrt(total);
    for (float& area : area_) area /= total;
}

double SimulatedPerson::right(std::span<const std::int32_t> shown) const {
    double right = 0, all = 0;
    for (std::size_t f = 0; f < area_.size(); ++f) {
        if (truth_[f] < 0) continue;
        all += static_cast<double>(area_[f]);
        if (shown[f] == truth_[f]) right += static_cast<double>(area_[f]);
    }
    return all > 0 ? right / all : 1;
}

// The largest connected region of one true label that is shown wrong; empty if all is right.
std::vector<std::uint32_t> SimulatedPerson::largest_wrong_region(std::span<const std::int32_t> shown) const {
    const auto wrong = [&](std::uint32_t f) { return truth_[f] >= 0 && shown[f] != truth_[f]; };
    std::vector<bool> seen(area_.size(), false);
    std::vector<std::uint32_t> region;
    float largest = 0;
    for (std::uint32_t start = 0; start < area_.size(); ++start) {
        if (seen[start] || !wrong(start)) continue;
        std::vector<std::uint32_t> found{start};
        seen[start] = true;
        float area = 0;
        for (std::size_t i = 0; i < found.size(); ++i) {
            area += area_[found[i]];
            for (const DualGraph::Arc& arc : arcs_of(graph_, found[i])) {
                if (seen[arc.face] || !wrong(arc.face) || truth_[arc.face] != truth_[start]) continue;
                seen[arc.face] = true;
                found.push_back(arc.face);
            }
        }
        if (area > largest) largest = area, region = std::move(found);
    }
    return region;
}

// The way of the brush: through the middle of the region (the face farthest from its border), along the longest
// direction that is seen from one side, both ways.
std::vector<std::uint32_t> SimulatedPerson::brush_path(std::span<const std::uint32_t> region) const {
    std::vector<bool> member(area_.size(), false);
    for (const std::uint32_t f : region) member[f] = true;
    std::vector<std::uint32_t> border;
    for (const std::uint32_t f : region)
        if (std::ranges::any_of(arcs_of(graph_, f), [&](const DualGraph::Arc& arc) { return !member[arc.face]; }))
            border.push_back(f);
    if (border.empty()) border.push_back(region.front());
    const auto inside = [&](std::uint32_t f) { return member[f]; };
    const std::uint32_t middle = farthest(search_region(graph_, border, inside), region);

    constexpr float k_least_cosine = 0.2F;  ///< of normals that are seen together with that of the middle
    const auto seen_with = [&](std::uint32_t f) {
        return member[f] && normal_[f].dot(normal_[middle]) > k_least_cosine;
    };
    const RegionSearch from_middle = search_region(graph_, std::span(&middle, 1), seen_with);
    const std::uint32_t one_end = farthest(from_middle, region);
    const std::uint32_t other_end = farthest(search_region(graph_, std::span(&one_end, 1), seen_with), region);
    const float half = 0.5F * options_.stroke_length * unit_;
    std::vector<std::uint32_t> path{middle};
    for (std::uint32_t end : {one_end, other_end}) {
        while (from_middle.distance[end] > half) end = from_middle.parent[end];
        for (std::uint32_t f = end; f != k_invalid_index; f = from_middle.parent[f]) path.push_back(f);
    }
    return path;
}

std::optional<PersonStroke> SimulatedPerson::next_stroke(std::span<const std::int32_t> shown) const {
    const std::vector<std::uint32_t> region = largest_wrong_region(shown);
    if (region.empty()) return std::nullopt;
    const std::vector<std::uint32_t> path = brush_path(region);
    PersonStroke stroke{truth_[region.front()], {}};
    // The person does not paint over the border of the part, nor what is turned away.
    const Vec3 toward = normal_[path.front()];
    const RegionSearch covered = search_region(
        graph_, path, [&](std::uint32_t f) { return truth_[f] == stroke.label && normal_[f].dot(toward) > 0; });
    for (std::uint32_t f = 0; f < area_.size(); ++f)
        if (covered.distance[f] <= options_.brush_radius * unit_) stroke.faces.push_back(f);
    return stroke;
}

}  // namespace exemplar
