#include "gpu/curvature/surface/near_vertices.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <span>

#include "host/core/errors.h"
#include "host/core/parallel.h"
#include "host/mesh/curvature/near_flood.h"
#include "host/mesh/vertex_neighbors.h"

namespace exemplar {
namespace {

using shared::uvec4;

constexpr std::size_t k_chunk = 1024;  // vertices

// Appends the row of a vertex; returns its length in texels.
std::uint32_t append_row(std::uint32_t vertex, std::span<const std::uint32_t> others, std::vector<uvec4>& texels) {
    const std::size_t count = std::max<std::size_t>((others.size() + 3) / 4, 1);
    for (std::size_t i = 0; i < count; ++i) {
        std::array<std::uint32_t, 4> four{};
        for (std::size_t j = 0; j < 4; ++j) four[j] = 4 * i + j < others.size() ? others[4 * i + j] : vertex;
        texels.push_back({four[0], four[1], four[2], four[3]});
    }
    texels.back().w |= shared::k_near_last;
    return static_cast<std::uint32_t>(count);
}

}  // namespace

NearVertices build_near_vertices(const TriangleMesh& mesh, const NearBall& ball, std::size_t max_texels_per_range) {
    const std::size_t count = mesh.vertex_count();
    const VertexNeighbors neighbors = build_vertex_neighbors(mesh.faces, count);
    std::vector<std::vector<uvec4>> chunks((count + k_chunk - 1) / k_chunk);
    std::vector<std::uint32_t> lengths(count);
    std::atomic<std::size_t> total = 0;
    const auto inside = static_cast<float>(ball.radius * ball.radius);
    const auto reached = static_cast<float>(ball.reach * ball.reach);
    parallel_ranges(chunks.size(), 1, [&](std::size_t begin, std::size_t end) {
        NearFlood flood(neighbors, ball.enough);
        for (std::size_t v = begin * k_chunk; v < std::min(end * k_chunk, count); ++v) {
            const auto vertex = static_cast<std::uint32_t>(v);
            const Vec3& center = mesh.vertices[v];
            lengths[v] = append_row(vertex,
                                    flood.around(vertex,
                                                 [&](std::uint32_t other) {
                                                     const float squared =
                                                         (mesh.vertices[other] - center).squaredNorm();
                                                     return squared < inside    ? Nearness::inside
                                                            : squared < reached ? Nearness::margin
                                                                                : Nearness::outside;
                                                 }),
                                    chunks[v / k_chunk]);
            if ((total += lengths[v]) > max_texels_per_range)
                throw UsageError(fmt::format(
                    "smoothing over {:.3g} mesh units reaches too many of {} vertices for the memory there is "
                    "({} texels of four); smooth less (--smoothing 0: not at all), or simplify the mesh",
                    ball.reach, count, max_texels_per_range));
        }
    });
    NearVertices near;
    near.begin.reserve(count);
    near.texels.reserve(total);
    std::uint32_t texel = 0;
    for (const std::uint32_t length : lengths) {
        near.begin.push_back(texel);
        texel += length;
    }
    for (const std::vector<uvec4>& chunk : chunks) near.texels.insert(near.texels.end(), chunk.begin(), chunk.end());
    return near;
}

std::vector<NearTile> tile_rows(const NearVertices& rows, std::size_t max_texels_per_range, std::size_t alignment) {
    const auto count = static_cast<std::uint32_t>(rows.begin.size());
    const auto end_of = [&](std::uint32_t v) {
        return v + 1 < count ? rows.begin[v + 1] : static_cast<std::uint32_t>(rows.texels.size());
    };
    const auto aligned = static_cast<std::uint32_t>(std::max<std::size_t>(alignment, 1));
    std::vector<NearTile> tiles;
    for (std::uint32_t v = 0; v < count; ++v) {
        if (tiles.empty() || end_of(v) - tiles.back().first_texel > max_texels_per_range)
            tiles.push_back({.first = v, .count = 0, .first_texel = rows.begin[v] / aligned * aligned, .texels = 0});
        NearTile& tile = tiles.back();
        ++tile.count;
        tile.texels = end_of(v) - tile.first_texel;
        if (tile.texels > max_texels_per_range)
            throw UsageError(
                fmt::format("smoothing reaches {} texels of vertices from vertex {}, over the limit of {} "
                            "of this device; smooth less",
                            tile.texels, v, max_texels_per_range));
    }
    return tiles;
}

}  // namespace exemplar
