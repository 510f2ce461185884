#include "host/parts/splitting/cut_loops.h"

#include <algorithm>
#include <unordered_map>

#include "host/core/disjoint_sets.h"

namespace exemplar {
namespace {

/// Traces the borders of parts: at the end of a cut half-edge, turns through the faces of its part to the next one.
class CutTracer {
  public:
    CutTracer(const TriangleMesh& mesh, const HalfEdges& edges, std::span<const std::uint32_t> part_of_face)
        : mesh_(mesh),
          edges_(edges),
          part_(part_of_face),
          loop_of_(edges.twin.size(), k_invalid_index),
          is_traced_(edges.twin.size(), false) {}

    CutLoops trace() {
        for (std::uint32_t h = 0; h < edges_.twin.size(); ++h)
            if (is_cut(h) && !is_traced_[h]) trace_border(h);
        return group_loops();
    }

  private:
    std::uint32_t part_of(std::uint32_t half_edge) const { return part_[face_of_half_edge(half_edge)]; }
    bool is_cut(std::uint32_t h) const {
        return edges_.twin[h] != k_invalid_index && part_of(h) != part_of(edges_.twin[h]);
    }

    /// Returns the next half-edge of the part's border; k_invalid_index where the mesh ends.
    std::uint32_t next_on_border(std::uint32_t h) const {
        for (h = next_half_edge(h); !is_cut(h); h = next_half_edge(edges_.twin[h]))
            if (edges_.twin[h] == k_invalid_index) return k_invalid_index;
        return h;
    }

    /// Traces the border through `start` and cuts it into loops where it returns to a vertex. An open border stays
    /// without loops.
    void trace_border(std::uint32_t start) {
        std::vector<std::uint32_t> path;
        for (std::uint32_t h = start;;) {
            path.push_back(h);
            is_traced_[h] = true;
            h = next_on_border(h);
            if (h == start) break;
            if (h == k_invalid_index || is_traced_[h]) return;  // it is open; the second is the rest of an open border
        }
        cut_at_repeated_vertices(path);
    }

    void cut_at_repeated_vertices(const std::vector<std::uint32_t>& path) {
        std::vector<std::uint32_t> stack;
        std::unordered_map<std::uint32_t, std::size_t> place;  // of a start vertex in the stack
        for (const std::uint32_t h : path) {
            place.emplace(half_edge_start(mesh_, h), stack.size());
            stack.push_back(h);
            const auto found = place.find(half_edge_end(mesh_, h));
            if (found == place.end()) continue;
            const auto begin = stack.begin() + static_cast<std::ptrdiff_t>(found->second);
            add_loop({begin, stack.end()});
            std::for_each(begin, stack.end(), [&](std::uint32_t of) { place.erase(half_edge_start(mesh_, of)); });
            stack.erase(begin, stack.end());
        }
    }

    void add_loop(std::vector<std::uint32_t> half_edges) {
        for (const std::uint32_t h : half_edges) loop_of_[h] = static_cast<std::uint32_t>(loops_.size());
        const std::uint32_t part = part_of(half_edges.front());
        loops_.push_back({part, std::move(half_edges)});
    }

    /// Joins loops on two sides of an edge, and leaves out groups with an edge whose other side is in no loop.
    CutLoops group_loops() {
        DisjointSets sets(loops_.size());
        std::vector<bool> is_open(loops_.size(), false);
        for (std::uint32_t i = 0; i < loops_.size(); ++i)
            for (const std::uint32_t h : loops_[i].half_edges) {
                const std::uint32_t other = loop_of_[edges_.twin[h]];
                if (other != k_invalid_index)
                    sets.join(i, other);
                else
                    is_open[i] = true;
            }
        for (std::uint32_t i = 0; i < loops_.size(); ++i)
            if (is_open[i]) is_open[sets.find(i)] = true;
        CutLoops found;
        std::vector<std::uint32_t> group(loops_.size(), k_invalid_index);
        std::size_t closed = 0;
        for (std::uint32_t i = 0; i < loops_.size(); ++i) {
            const std::uint32_t root = sets.find(i);
            if (is_open[root]) continue;
            if (group[root] == k_invalid_index) {
                group[root] = static_cast<std::uint32_t>(found.groups.size());
                found.groups.emplace_back();
            }
            closed += loops_[i].half_edges.size();
            found.groups[group[root]].push_back(std::move(loops_[i]));
        }
        std::size_t cut = 0;
        for (std::uint32_t h = 0; h < edges_.twin.size(); ++h) cut += is_cut(h) ? 1 : 0;
        found.open_edges = (cut - closed) / 2;
        return found;
    }

    const TriangleMesh& mesh_;
    const HalfEdges& edges_;
    std::span<const std::uint32_t> part_;
    std::vector<std::uint32_t> loop_of_;  ///< per half-edge
    std::vector<bool> is_traced_;         ///< per half-edge
    std::vector<CutLoop> loops_;
};

}  // namespace

CutLoops find_cut_loops(const TriangleMesh& mesh, const HalfEdges& edges, std::span<const std::uint32_t> part_of_face) {
    return CutTracer(mesh, edges, part_of_face).trace();
}

}  // namespace exemplar
