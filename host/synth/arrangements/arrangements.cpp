#include "host/synth/arrangements/arrangements.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <string>

#include "host/core/errors.h"
#include "host/core/random.h"

namespace exemplar {
namespace {

Vec3 arranged_point(double x, double y, double z) {
    return {static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)};
}

std::uint32_t append_arranged(TriangleMesh& mesh, const Vec3& p) {
    mesh.vertices.push_back(p);
    return static_cast<std::uint32_t>(mesh.vertices.size() - 1);
}

void add_quad(TriangleMesh& mesh, std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
    mesh.faces.push_back({a, b, c});
    mesh.faces.push_back({a, c, d});
}

TriangleMesh finished(TriangleMesh mesh) {
    mesh.source_face_count = static_cast<std::uint32_t>(mesh.faces.size());
    return mesh;
}

/// Adds a ball of radius 1 from circles of latitude, twice as many faces around as from pole to pole.
void add_ball(TriangleMesh& mesh, std::size_t faces) {
    const auto rings = static_cast<std::uint32_t>(std::max(3.0, std::sqrt(static_cast<double>(faces) / 4)));
    const std::uint32_t around = 2 * rings, top = append_arranged(mesh, Vec3::UnitZ());
    for (std::uint32_t i = 1; i < rings; ++i)
        for (std::uint32_t j = 0; j < around; ++j) {
            const double polar = std::numbers::pi * i / rings, turn = 2 * std::numbers::pi * j / around;
            append_arranged(mesh, arranged_point(std::sin(polar) * std::cos(turn), std::sin(polar) * std::sin(turn),
                                                 std::cos(polar)));
        }
    const std::uint32_t bottom = append_arranged(mesh, -Vec3::UnitZ());
    const auto at = [&](std::uint32_t i, std::uint32_t j) { return top + 1 + (i - 1) * around + j % around; };
    for (std::uint32_t j = 0; j < around; ++j) {
        mesh.faces.push_back({top, at(1, j), at(1, j + 1)});
        for (std::uint32_t i = 1; i + 1 < rings; ++i)
            add_quad(mesh, at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
        mesh.faces.push_back({bottom, at(rings - 1, j + 1), at(rings - 1, j)});
    }
}

TriangleMesh make_floor(std::size_t faces) {
    constexpr double k_half_width = 2000, k_height = -1.01;
    TriangleMesh mesh;
    add_ball(mesh, faces);
    const std::uint32_t a = append_arranged(mesh, arranged_point(-k_half_width, -k_half_width, k_height));
    append_arranged(mesh, arranged_point(k_half_width, -k_half_width, k_height));
    append_arranged(mesh, arranged_point(k_half_width, k_half_width, k_height));
    append_arranged(mesh, arranged_point(-k_half_width, k_half_width, k_height));
    add_quad(mesh, a, a + 1, a + 2, a + 3);
    return finished(std::move(mesh));
}

TriangleMesh make_cone(std::size_t faces) {
    const auto around = static_cast<std::uint32_t>(faces / 2);
    TriangleMesh mesh;
    for (std::uint32_t i = 0; i < around; ++i) {
        const double turn = 2 * std::numbers::pi * i / around;
        append_arranged(mesh, arranged_point(std::cos(turn), std::sin(turn), 0));
    }
    const std::uint32_t top = append_arranged(mesh, {0, 0, 1.5F}), bottom = append_arranged(mesh, {0, 0, -0.5F});
    for (std::uint32_t i = 0; i < around; ++i) {
        mesh.faces.push_back({i, (i + 1) % around, top});
        mesh.faces.push_back({(i + 1) % around, i, bottom});
    }
    return finished(std::move(mesh));
}

TriangleMesh make_slats(std::size_t faces) {
    constexpr std::size_t k_box = 12;
    const Eigen::Matrix3f across = Eigen::AngleAxisf(0.7F, Vec3(1, 2, 3).normalized()).toRotationMatrix();
    TriangleMesh mesh;
    for (std::size_t slat = 0; slat < faces / k_box; ++slat) {
        const double left = 2e-3 * static_cast<double>(slat), right = left + 1e-3;
        const auto base = static_cast<std::uint32_t>(mesh.vertices.size());
        for (const double z : {0.0, 1e-3})
            for (const double x : {left, right})
                for (const double y : {0.0, 1.0}) append_arranged(mesh, across * arranged_point(x, y, z));
        constexpr std::array<std::array<std::uint32_t, 4>, 6> k_sides{
            {{0, 1, 3, 2}, {4, 6, 7, 5}, {0, 4, 5, 1}, {2, 3, 7, 6}, {0, 2, 6, 4}, {1, 5, 7, 3}}};
        for (const auto& [a, b, c, d] : k_sides) add_quad(mesh, base + a, base + b, base + c, base + d);
    }
    return finished(std::move(mesh));
}

TriangleMesh make_spikes(std::size_t faces) {
    Random random(1);
    TriangleMesh mesh;
    add_ball(mesh, faces);
    for (std::size_t v = 0; v < mesh.vertices.size(); v += 4)
        mesh.vertices[v] *= static_cast<float>(1 + 0.1 * std::pow(1000.0, random.uniform(0.0, 1.0)));
    return finished(std::move(mesh));
}

TriangleMesh make_graded(std::size_t faces) {
    const auto cells = static_cast<std::uint32_t>(std::sqrt(static_cast<double>(faces) / 2));
    const double ratio = std::pow(1e-6, 1.0 / std::max(cells - 1.0, 1.0));
    const auto place = [&](std::uint32_t i) { return i == cells ? 0.0 : std::pow(ratio, i); };
    TriangleMesh mesh;
    for (std::uint32_t i = 0; i <= cells; ++i)
        for (std::uint32_t j = 0; j <= cells; ++j) append_arranged(mesh, arranged_point(place(i), place(j), 0));
    for (std::uint32_t i = 0; i < cells; ++i)
        for (std::uint32_t j = 0; j < cells; ++j) {
            const std::uint32_t a = i * (cells + 1) + j, b = a + cells + 1;
            add_quad(mesh, a, b, b + 1, a + 1);
        }
    return finished(std::move(mesh));
}

TriangleMesh make_pieces(std::size_t faces) {
    Random random(1);
    TriangleMesh mesh;
    for (std::size_t piece = 0; piece < faces / 4; ++piece) {
        const Vec3 center =
            arranged_point(random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0));
        const std::uint32_t a = append_arranged(mesh, center);
        for (const Vec3& axis : {Vec3(Vec3::UnitX()), Vec3(Vec3::UnitY()), Vec3(Vec3::UnitZ())})
            append_arranged(mesh, center + 0.01F * axis);
        for (const Face& face : {Face{0, 2, 1}, Face{0, 1, 3}, Face{0, 3, 2}, Face{1, 2, 3}})
            mesh.faces.push_back({a + face[0], a + face[1], a + face[2]});
    }
    return finished(std::move(mesh));
}

TriangleMesh make_strip(std::size_t faces) {
    TriangleMesh mesh;
    for (std::size_t i = 0; i <= faces / 2; ++i)
        for (const double y : {0.0, 1.0}) append_arranged(mesh, arranged_point(static_cast<double>(i), y, 0));
    for (std::uint32_t i = 0; i < faces / 2; ++i) add_quad(mesh, 2 * i, 2 * i + 2, 2 * i + 3, 2 * i + 1);
    return finished(std::move(mesh));
}

constexpr std::array<Arrangement, 7> k_arrangements{{{"floor", make_floor},
                                                     {"cone", make_cone},
                                                     {"slats", make_slats},
                                                     {"spikes", make_spikes},
                                                     {"graded", make_graded},
                                                     {"pieces", make_pieces},
                                                     {"strip", make_strip}}};

}  // namespace

std::span<const Arrangement> arrangements() {
    return k_arrangements;
}

const Arrangement& arrangement_named(std::string_view name) {
    const auto found = std::ranges::find(k_arrangements, name, &Arrangement::name);
    if (found == k_arrangements.end()) throw UsageError(fmt::format("no arrangement of faces is called '{}'", name));
    return *found;
}

}  // namespace exemplar
