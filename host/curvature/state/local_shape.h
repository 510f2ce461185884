#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "host/core/half.h"
#include "host/curvature/state/state.h"

namespace exemplar {

/// Fast StateReader::read_surface for a state that is_local(): half-precision maps, sixteen inputs at a time. Sums
/// are in another order, so rounding differs. Keeps its work space, so only one thread at a time may use it.
class LocalShapeReader {
  public:
    explicit LocalShapeReader(const StateReader& state);
    void read(std::span<const Vec3> vertices, std::span<const Vec3> normals, std::span<const Eigen::Matrix3f> rotations,
              std::span<float> x);

  private:
    static constexpr std::size_t k_lanes = 16;
    struct Block {
        std::uint32_t control, first_input, inputs;  ///< at most k_lanes
        std::size_t map;                             ///< start in map_: k_lanes values per number of the shape
    };
    void append_blocks(std::uint32_t control);
    /// Does what LocalShapeState::read does, into shape_.
    void read_shape(std::uint32_t control, std::span<const Vec3> vertices, std::span<const Vec3> normals,
                    const Eigen::Matrix3f& rotation);
    void read_block(const Block& block, std::size_t numbers, std::span<float> x) const;

    const StateReader& state_;
    const LocalShapeState& local_;
    std::vector<Block> blocks_;
    std::vector<Half> map_;
    std::vector<float> bias_;  ///< k_lanes per block: minus the map of the mean shape
    std::vector<float> shape_;
};

}  // namespace exemplar
