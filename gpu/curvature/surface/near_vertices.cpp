#include "gpu/curvature/surface/near_vertices.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <span>

#include "host/core/errors.h"
#include "host/core/parallel.h"
#include "host/mesh/vertex_neighbors.h"

namespace exemplar {
namespace {

using shared::uvec4;

constexpr std::size_t k_chunk = 1024;  // vertices

// Floods the surface from one vertex after another.
class Flood {
  public:
    Flood(const TriangleMesh& mesh, const VertexNeighbors& neighbors, double radius)
        : mesh_(mesh),
          neighbors_(neighbors),
          limit_(static_cast<float>(radius * radius)),
          seen_by_(mesh.vertex_count(), k_nobody) {}

    /// Returns the vertices around `center` in breadth-first order; valid until the next call.
    std::span<const std::uint32_t> around(std::uint32_t center) {
        reached_ = {center};
        seen_by_[center] = center;
        for (std::size_t next = 0; next < reached_.size(); ++next)
            for (const std::uint32_t v : neighbors_.of(reached_[next])) {
                if (seen_by_[v] == center) continue;
                seen_by_[v] = center;
                if ((mesh_.vertices[v] - mesh_.vertices[center]).squaredNorm() < limit_) reached_.push_back(v);
            }
        return std::span(reached_).subspan(1);
    }

  private:
    static constexpr std::uint32_t k_nobody = 0xffffffffu;
    const TriangleMesh& mesh_;
    const VertexNeighbors& neighbors_;
    float limit_;
    std::vector<std::uint32_t> seen_by_, reached_;
};

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

NearVertices build_near_vertices(const TriangleMesh& mesh, double radius, std::size_t max_texels_per_range) {
    const std::size_t count = mesh.vertex_count();
    const VertexNeighbors neighbors = build_vertex_neighbors(mesh.faces, count);
    std::vector<std::vector<uvec4>> chunks((count + k_chunk - 1) / k_chunk);
    std::vector<std::uint32_t> lengths(count);
    std::atomic<std::size_t> total = 0;
    parallel_ranges(chunks.size(), 1, [&](std::size_t begin, std::size_t end) {
        Flood flood(mesh, neighbors, radius);
        for (std::size_t v = begin * k_chunk; v < std::min(end * k_chunk, count); ++v) {
            const auto vertex = static_cast<std::uint32_t>(v);
            lengths[v] = append_row(vertex, flood.around(vertex), chunks[v / k_chunk]);
            if ((total += lengths[v]) > max_texels_per_range)
                throw UsageError(fmt::format(
                    "smoothing over {:.3g} mesh units reaches too many of {} vertices for the memory there is "
                    "({} texels of four); smooth less (--smoothing 0: not at all), or simplify the mesh",
                    radius, count, max_texels_per_range));
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
