#include "host/parts/rigging/part_contacts.h"

#include <algorithm>
#include <numeric>

#include "host/core/interrupt.h"
#include "host/mesh/queries/point_tree.h"

namespace exemplar {
namespace {

constexpr std::size_t k_target_components = 16, k_probed_faces = 512;

/// The faces of each component, the component with the largest area first.
std::vector<std::vector<std::uint32_t>> components_by_area(const TriangleMesh& mesh, const Topology& topology) {
    const std::vector<std::uint32_t> component = face_components(mesh, topology);
    const std::vector<float> area = face_areas(mesh);
    const std::size_t count = 1 + *std::max_element(component.begin(), component.end());
    std::vector<std::vector<std::uint32_t>> faces(count);
    std::vector<double> total(count, 0);
    for (std::uint32_t f = 0; f < component.size(); ++f) {
        faces[component[f]].push_back(f);
        total[component[f]] += area[f];
    }
    std::vector<std::size_t> order(count);
    std::iota(order.begin(), order.end(), 0U);
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return total[a] > total[b]; });
    std::vector<std::vector<std::uint32_t>> sorted;
    sorted.reserve(count);
    for (const std::size_t c : order) sorted.push_back(std::move(faces[c]));
    return sorted;
}

PointTree tree_of(const std::vector<Vec3>& center, const std::vector<std::uint32_t>& faces) {
    std::vector<Vec3> points;
    points.reserve(faces.size());
    for (const std::uint32_t f : faces) points.push_back(center[f]);
    return PointTree(std::move(points));
}

}  // namespace

std::vector<PieceContact> component_contacts(const TriangleMesh& mesh, const Topology& topology) {
    const auto components = components_by_area(mesh, topology);
    const std::vector<Vec3> center = face_centers(mesh);
    std::vector<PointTree> trees;
    std::vector<PieceContact> contacts;
    contacts.reserve(components.size() - 1);
    for (std::size_t c = 0; c < components.size(); ++c) {
        check_interrupt();
        float best = std::numeric_limits<float>::infinity();
        PieceContact contact;
        const std::size_t step = std::max<std::size_t>(1, components[c].size() / k_probed_faces);
        for (std::size_t i = 0; i < components[c].size() && c > 0; i += step)
            for (std::size_t t = 0; t < trees.size(); ++t) {
                const std::uint32_t face = components[c][i];
                const std::uint32_t other = components[t][trees[t].nearest(center[face])];
                const float distance = (center[face] - center[other]).squaredNorm();
                if (distance >= best) continue;
                best = distance;
                contact = {face, other, (center[face] + center[other]) / 2};
            }
        if (c > 0) contacts.push_back(contact);
        if (trees.size() < k_target_components) trees.push_back(tree_of(center, components[c]));
    }
    return contacts;
}

}  // namespace exemplar
