#include "host/synth/shapes/shapes.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "host/core/errors.h"
#include "host/core/random.h"
#include "host/core/text.h"
#include "host/synth/modeling/field.h"
#include "host/synth/modeling/part_labels.h"
#include "host/synth/modeling/remesh.h"
#include "host/synth/modeling/surface.h"
#include "host/synth/shapes/models.h"

namespace exemplar {
namespace {

constexpr int k_any_genus = -1;
constexpr std::uint64_t k_attempts = 100;
constexpr std::size_t k_min_faces = 100, k_max_faces = 200'000;  // with more, the grid takes gigabytes
constexpr std::uint64_t k_orientation_task = 1000;

struct ShapeKind {
    std::string_view name;
    std::span<const std::string_view> parts;
    ShapeModel (*sculpt)(Random&);
    int genus;  // handles of a good shape: one more means that limbs have merged
};

const std::array<ShapeKind, 7>& kinds() {
    static const std::array<ShapeKind, 7> table{{{"human", k_human_parts, sculpt_human, 0},
                                                 {"fourleg", k_fourleg_parts, sculpt_fourleg, 0},
                                                 {"cup", k_cup_parts, sculpt_cup, 1},
                                                 {"chair", k_chair_parts, sculpt_chair, k_any_genus},
                                                 {"table", k_table_parts, sculpt_table, k_any_genus},
                                                 {"octopus", k_octopus_parts, sculpt_octopus, 0},
                                                 {"glasses", k_glasses_parts, sculpt_glasses, 0}}};
    return table;
}

const ShapeKind& find_shape_kind(std::string_view name) {
    for (const ShapeKind& kind : kinds())
        if (kind.name == name) return kind;
    std::vector<std::string> names;
    std::string list;
    for (const ShapeKind& kind : kinds()) {
        names.emplace_back(kind.name);
        list += (list.empty() ? "" : ", ") + names.back();
    }
    throw UsageError(fmt::format("unknown shape kind '{}'{}; the kinds are {}", name, suggestion(name, names), list));
}

void turn_randomly(TriangleMesh& mesh, Random random) {
    // A normalized vector of four normal deviates is a uniformly distributed unit quaternion.
    const double w = random.normal(), x = random.normal(), y = random.normal(), z = random.normal();
    const Eigen::Matrix3f rotation = Eigen::Quaterniond(w, x, y, z).normalized().toRotationMatrix().cast<float>();
    const Vec3 center = area_centroid(mesh);
    for (Vec3& v : mesh.vertices) v = center + rotation * (v - center);
}

}  // namespace

std::span<const std::string_view> synth_kinds() {
    static const auto names = [] {
        std::array<std::string_view, 7> list;
        std::transform(kinds().begin(), kinds().end(), list.begin(), [](const ShapeKind& kind) { return kind.name; });
        return list;
    }();
    return names;
}

std::span<const std::string_view> synth_labels(std::string_view kind) {
    return find_shape_kind(kind).parts;
}

SynthShape make_shape(std::string_view kind_name, std::uint64_t seed, std::size_t faces, bool random_orientation) {
    const ShapeKind& kind = find_shape_kind(kind_name);
    if (faces < k_min_faces || faces > k_max_faces)
        throw UsageError(
            fmt::format("a shape of {} faces cannot be made; ask for {} to {}", faces, k_min_faces, k_max_faces));
    const Random root = Random(seed).fork(static_cast<std::uint64_t>(&kind - kinds().data()));
    SynthShape shape;
    // A pose in which limbs touch has another genus; such shapes are generated again.
    for (std::uint64_t attempt = 0; attempt < k_attempts; ++attempt) {
        Random random = root.fork(attempt);
        const ShapeModel model = kind.sculpt(random);
        const ImplicitField field(model.primitives);
        const TriangleMesh fine = fine_mesh(field, model.detail, faces);
        if ((kind.genus != k_any_genus && genus_of(fine) != kind.genus) || !is_one_component(fine)) continue;
        shape.mesh = remesh(fine, field, faces);
        shape.labels.label = label_faces(shape.mesh, field);
        break;
    }
    if (shape.mesh.faces.empty())
        throw UsageError(fmt::format("no {} of seed {} came out in one piece; take another seed", kind_name, seed));
    shape.labels.names.assign(kind.parts.begin(), kind.parts.end());
    if (random_orientation) turn_randomly(shape.mesh, root.fork(k_orientation_task));
    return shape;
}

}  // namespace exemplar
