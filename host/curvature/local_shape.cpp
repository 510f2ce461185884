#include "host/curvature/local_shape.h"

#include <algorithm>
#include <cstring>

#include "host/core/eight.h"

namespace exemplar {

using Eigen::Index;

LocalShapeReader::LocalShapeReader(const StateReader& state) : state_(state) {
    std::size_t largest = 0;
    for (std::uint32_t c = 0; c < state.controls.size(); ++c) {
        append_blocks(c);
        largest = std::max(largest, state.local_size(c));
    }
    shape_.resize(largest);
}

void LocalShapeReader::append_blocks(std::uint32_t control) {
    const Control& all = state_.controls[control];
    const Eigen::MatrixXf& map = state_.unmixing[control];
    const Eigen::VectorXf bias = -map * state_.local_mean[control];
    for (std::uint32_t first = 0; first < all.input_count; first += k_lanes) {
        const std::uint32_t inputs = std::min<std::uint32_t>(k_lanes, all.input_count - first);
        blocks_.push_back({control, all.first_input + first, inputs, map_.size()});
        for (Index number = 0; number < map.cols(); ++number)
            for (std::uint32_t lane = 0; lane < k_lanes; ++lane)
                map_.push_back(lane < inputs ? to_half(map(first + lane, number)) : Half{});
        for (std::uint32_t lane = 0; lane < k_lanes; ++lane) bias_.push_back(lane < inputs ? bias[first + lane] : 0.0f);
    }
}

void LocalShapeReader::read(std::span<const Vec3> vertices, std::span<const Vec3> normals,
                            std::span<const Eigen::Matrix3f> rotations, std::span<float> x) {
    for (std::size_t b = 0; b < blocks_.size(); ++b) {
        const std::uint32_t control = blocks_[b].control;
        const std::size_t numbers = state_.local_size(control);
        if (b == 0 || blocks_[b - 1].control != control)
            state_.read_local(control, vertices, normals, rotations[control], {shape_.data(), numbers});
        read_block(blocks_[b], numbers, x);
    }
}

void LocalShapeReader::read_block(const Block& block, std::size_t numbers, std::span<float> x) const {
    static_assert(k_lanes == 16 && StateReader::k_local_numbers % 2 == 0);
    const auto bias = static_cast<std::size_t>(&block - blocks_.data()) * k_lanes;
    EightFloats low, high, low_odd{}, high_odd{};
    std::memcpy(&low, &bias_[bias], sizeof(low));
    std::memcpy(&high, &bias_[bias + 8], sizeof(high));
    const Half* map = map_.data() + block.map;
    for (std::size_t i = 0; i < numbers; i += 2, map += 2 * k_lanes) {  // four sums, as each waits for its last product
        low += eight_from_halves(map) * shape_[i];
        high += eight_from_halves(map + 8) * shape_[i];
        low_odd += eight_from_halves(map + 16) * shape_[i + 1];
        high_odd += eight_from_halves(map + 24) * shape_[i + 1];
    }
    low += low_odd;
    high += high_odd;
    float sums[k_lanes];
    std::memcpy(sums, &low, sizeof(low));
    std::memcpy(sums + 8, &high, sizeof(high));
    std::copy_n(sums, block.inputs, x.begin() + block.first_input);
}

}  // namespace exemplar
