#include "host/synth/damage/damage.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <string>

#include "host/core/errors.h"
#include "host/core/text.h"
#include "host/synth/damage/damage_kinds.h"

namespace exemplar {

DamagedMesh undamaged(const TriangleMesh& mesh) {
    DamagedMesh damaged;
    damaged.mesh.vertices = mesh.vertices;
    damaged.mesh.faces = mesh.faces;
    damaged.mesh.source_face_count = static_cast<std::uint32_t>(mesh.face_count());
    damaged.origin.resize(mesh.face_count());
    std::iota(damaged.origin.begin(), damaged.origin.end(), 0U);
    return damaged;
}

void keep_faces(DamagedMesh& damaged, const std::vector<bool>& kept) {
    std::size_t next = 0;
    for (std::size_t f = 0; f < kept.size(); ++f) {
        if (!kept[f]) continue;
        damaged.mesh.faces[next] = damaged.mesh.faces[f];
        damaged.origin[next++] = damaged.origin[f];
    }
    damaged.mesh.faces.resize(next);
    damaged.origin.resize(next);
    damaged.mesh.source_face_count = static_cast<std::uint32_t>(next);
}

void add_face(DamagedMesh& damaged, const Face& face, std::uint32_t origin) {
    damaged.mesh.faces.push_back(face);
    damaged.mesh.source_face_count = static_cast<std::uint32_t>(damaged.mesh.face_count());
    damaged.origin.push_back(origin);
}

std::vector<std::uint32_t> random_share(std::size_t count, double share, Random& random) {
    std::vector<std::uint32_t> items(count);
    std::iota(items.begin(), items.end(), 0U);
    random.shuffle(items);
    const auto wanted = static_cast<std::size_t>(std::lround(share * static_cast<double>(count)));
    items.resize(std::clamp<std::size_t>(wanted, std::min<std::size_t>(1, count), count));
    return items;
}

Vec3d random_direction(Random& random) {
    Vec3d direction;
    for (double& x : direction) x = random.normal();
    return direction.norm() > 0 ? Vec3d(direction.normalized()) : Vec3d(Vec3d::UnitZ());
}

namespace {

constexpr std::array<Damage, 20> k_damages{{
    {"holes", "2% of the faces cut out, in 4 patches", cut_holes},
    {"duplicated-faces", "5% of the faces twice", duplicate_faces},
    {"flipped-faces", "10% of the faces turned around", flip_faces},
    {"inside-out", "all faces turned around", turn_inside_out},
    {"split-parts", "cut apart along 3 random planes, nothing missing", split_parts},
    {"unwelded", "every triangle by itself, as in an STL file whose vertices were not joined", unweld},
    {"fins", "1% of the faces with a third face on an edge, sticking out", add_fins},
    {"slivers", "5% of the edges split a thousandth from one end", make_slivers},
    {"noise", "vertices moved by 0.5% of the diagonal, or a tenth of their edges if that is less", add_noise},
    {"strong-noise", "vertices moved by 1% of the diagonal, or a quarter of their edges if that is less",
     add_strong_noise},
    {"decimated", "simplified to a tenth of the faces", decimate},
    {"refined-4x", "every face cut into 4", refine_to_4},
    {"refined-9x", "every face cut into 9", refine_to_9},
    {"rotated", "turned at random", rotate},
    {"scaled-down", "a millionth of the size", scale_down},
    {"scaled-up", "a million times the size", scale_up},
    {"far-away", "moved by 100 times its diagonal", move_far},
    {"quads", "most triangles paired to quads, which are cut along either diagonal", pair_to_quads},
    {"loose-vertices", "100 vertices without a face, up to 10 diagonals away", add_loose_vertices},
    {"shuffled", "vertices, faces and their corners in another order", shuffle_order},
}};

}  // namespace

std::span<const Damage> damages() {
    return k_damages;
}

const Damage& damage_named(std::string_view name) {
    const auto found = std::ranges::find(k_damages, name, &Damage::name);
    if (found != k_damages.end()) return *found;
    std::vector<std::string> names(k_damages.size());
    std::ranges::transform(k_damages, names.begin(), [](const Damage& damage) { return std::string(damage.name); });
    throw UsageError(fmt::format("unknown damage '{}'{}; the damages are {}", name, suggestion(name, names),
                                 fmt::join(names, ", ")));
}

}  // namespace exemplar
