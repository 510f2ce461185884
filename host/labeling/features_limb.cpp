#include <algorithm>
#include <array>
#include <numeric>

#include "host/labeling/feature_families.h"

namespace exemplar {
namespace {

constexpr std::array<double, 3> k_prominences{0.02, 0.08, 0.2};
constexpr std::array<const char*, 6> k_columns{"area", "tip", "base", "length", "height", "width"};
constexpr std::uint32_t k_none = 0xffffffffU;

/// The faces above a falling level of the average geodesic distance, in connected pieces: each begins at a tip, and
/// grows until it meets another. A piece that stands out by less than the prominence at that level is a bump of the
/// other one; else both were limbs, and what they join into is trunk.
class LimbFinder {
  public:
    LimbFinder(const PreparedMesh& prepared, std::span<const float> level, std::span<const float> width,
               float prominence, FeatureMatrix& out, std::size_t first_column)
        : prepared_(prepared),
          level_(level),
          width_(width),
          prominence_(prominence),
          out_(out),
          first_(first_column),
          parent_(level.size(), k_none),
          next_(level.size(), k_none),
          pieces_(level.size()) {}

    /// `order`: all faces by falling level.
    void run(const std::vector<std::uint32_t>& order) {
        for (const std::uint32_t face : order) {
            start(face);
            const DualGraph& graph = prepared_.graph;
            for (std::uint32_t a = graph.begin[face]; a < graph.begin[face + 1]; ++a)
                if (parent_[graph.arcs[a].face] != k_none) meet(find(face), find(graph.arcs[a].face), level_[face]);
        }
    }

  private:
    struct Piece {
        float tip = 0.0F;
        bool limb = true;
        double area = 0.0, width = 0.0;
        std::uint32_t last = 0;  ///< of its list of faces, which begins at its root
    };

    void start(std::uint32_t face) {
        const double area = static_cast<double>(prepared_.area_share[face]);
        parent_[face] = face;
        pieces_[face] = {level_[face], true, area, area * static_cast<double>(width_[face]), face};
    }
    std::uint32_t find(std::uint32_t face) {
        while (parent_[face] != face) face = parent_[face] = parent_[parent_[face]];
        return face;
    }
    void meet(std::uint32_t a, std::uint32_t b, float level) {
        if (a == b) return;
        if (pieces_[a].tip < pieces_[b].tip) std::swap(a, b);
        if (pieces_[b].tip - level >= prominence_) finish(a, level), finish(b, level);
        Piece &kept = pieces_[a], &joined = pieces_[b];
        kept.area += joined.area, kept.width += joined.width;
        next_[kept.last] = b, kept.last = joined.last;
        parent_[b] = a;
    }
    void finish(std::uint32_t root, float base) {
        Piece& piece = pieces_[root];
        if (!piece.limb) return;
        piece.limb = false;
        const float length = piece.tip - base;
        const float width = piece.area > 0.0 ? static_cast<float>(piece.width / piece.area) : 0.0F;
        for (std::uint32_t face = root;; face = next_[face]) {
            const float height = length > 0.0F ? (level_[face] - base) / length : 0.0F;
            const std::array<float, k_columns.size()> values{
                static_cast<float>(piece.area), piece.tip, base, length, height, width};
            for (std::size_t k = 0; k < values.size(); ++k) out_.column(first_ + k)[face] = values[k];
            if (face == piece.last) break;
        }
    }

    const PreparedMesh& prepared_;
    std::span<const float> level_, width_;
    float prominence_;
    FeatureMatrix& out_;
    std::size_t first_;
    std::vector<std::uint32_t> parent_, next_;
    std::vector<Piece> pieces_;
};

}  // namespace

FeatureMatrix limb_features(const PreparedMesh& prepared, std::span<const float> mean_distance,
                            std::span<const float> width) {
    FeatureMatrix matrix;
    matrix.rows = prepared.face_count();
    for (const double prominence : k_prominences)
        for (const char* column : k_columns) matrix.add(at_radius(std::string("limb.") + column, prominence));
    std::vector<std::uint32_t> order(matrix.rows);
    std::iota(order.begin(), order.end(), 0U);
    std::ranges::stable_sort(order,
                             [&](std::uint32_t a, std::uint32_t b) { return mean_distance[a] > mean_distance[b]; });
    const auto [low, high] = std::ranges::minmax(mean_distance);
    for (std::size_t k = 0; k < k_prominences.size(); ++k) {
        const float prominence = static_cast<float>(k_prominences[k]) * (high - low);
        LimbFinder(prepared, mean_distance, width, prominence, matrix, k * k_columns.size()).run(order);
    }
    return matrix;
}

}  // namespace exemplar
