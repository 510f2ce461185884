#include "host/hatching/tracing/thinning.h"

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

namespace exemplar {
namespace {

using ThinPixel = std::pair<int, int>;

/// Returns the number of components of the ring, connected by eight; 0 if all four direct neighbors are set.
int pieces_of(const std::array<bool, 8>& n) {
    int pieces = 0;
    for (std::size_t k = 0; k < 8; k += 2) pieces += !n[k] && (n[k + 1] || n[(k + 2) % 8]);
    return pieces;
}

/// Guo and Hall's condition for removing a pixel in the first or the second half of a round.
bool may_go(const std::array<bool, 8>& n, bool second_half) {
    if (pieces_of(n) != 1) return false;
    int pairs = 0, shifted_pairs = 0;
    for (std::size_t k = 0; k < 8; k += 2) {
        pairs += n[k] || n[k + 1];
        shifted_pairs += n[k + 1] || n[(k + 2) % 8];
    }
    const int neighbors = std::min(pairs, shifted_pairs);
    if (neighbors < 2 || neighbors > 3) return false;
    return second_half ? !((n[6] || n[7] || !n[1]) && n[0]) : !((n[2] || n[3] || !n[5]) && n[4]);
}

/// Thins a mask in place, looking only at pixels that are on its border.
class Thinning {
  public:
    explicit Thinning(PixelMask& mask) : mask_(mask), listed_(mask.width, mask.height, 1) {
        for (int y = 0; y < mask.height; ++y)
            for (int x = 0; x < mask.width; ++x) {
                if (!mask.pixel(x, y)[0]) continue;
                const std::array<bool, 8> n = ring_neighbors(mask, x, y);
                if (!std::all_of(n.begin(), n.end(), [](bool set) { return set; })) list({x, y});
            }
    }

    void run() {
        for (bool changed = true; changed;) {
            changed = half(false);
            changed = half(true) || changed;
        }
    }

  private:
    void list(const ThinPixel& pixel) {
        std::uint8_t& listed = listed_.pixel(pixel.first, pixel.second)[0];
        if (!std::exchange(listed, std::uint8_t{1})) border_.push_back(pixel);
    }

    /// Half a round: removes at once all pixels that the mask before it allows to be removed. Returns whether there
    /// were any.
    bool half(bool second) {
        std::vector<ThinPixel> gone;
        for (const auto& [x, y] : border_)
            if (may_go(ring_neighbors(mask_, x, y), second)) gone.emplace_back(x, y);
        for (const auto& [x, y] : gone) mask_.pixel(x, y)[0] = 0;
        std::erase_if(border_, [&](const ThinPixel& p) { return !mask_.pixel(p.first, p.second)[0]; });
        for (const auto& [x, y] : gone)
            for (const auto& [dx, dy] : k_neighbor_offsets)
                if (x + dx >= 0 && y + dy >= 0 && x + dx < mask_.width && y + dy < mask_.height &&
                    mask_.pixel(x + dx, y + dy)[0])
                    list({x + dx, y + dy});
        return !gone.empty();
    }

    PixelMask& mask_;
    PixelMask listed_;
    std::vector<ThinPixel> border_;
};

}  // namespace

std::array<bool, 8> ring_neighbors(const PixelMask& mask, int x, int y) {
    std::array<bool, 8> ring{};
    for (std::size_t k = 0; k < 8; ++k) {
        const int px = x + k_neighbor_offsets[k][0], py = y + k_neighbor_offsets[k][1];
        ring[k] = px >= 0 && py >= 0 && px < mask.width && py < mask.height && mask.pixel(px, py)[0];
    }
    return ring;
}

void remove_stair_corners(PixelMask& skeleton) {
    for (int y = 0; y < skeleton.height; ++y)
        for (int x = 0; x < skeleton.width; ++x) {
            if (!skeleton.pixel(x, y)[0]) continue;
            const std::array<bool, 8> n = ring_neighbors(skeleton, x, y);
            if (std::count(n.begin(), n.end(), true) >= 2 && pieces_of(n) == 1) skeleton.pixel(x, y)[0] = 0;
        }
}

PixelMask thinned(PixelMask mask) {
    Thinning(mask).run();
    remove_stair_corners(mask);
    return mask;
}

}  // namespace exemplar
