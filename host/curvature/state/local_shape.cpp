#include "host/curvature/state/local_shape.h"

#include <algorithm>
#include <cstring>

#include "host/core/eight.h"

namespace exemplar {

using Eigen::Index;

LocalShapeReader::LocalShapeReader(const StateReader& state)
    : state_(state), local_(std::get<LocalShapeState>(state.source)) {
    std::size_t largest = 0;
    for (std::uint32_t c = 0; c < state.controls.size(); ++c) {
        append_blocks(c);
        largest = std::max(largest, local_.size(c));
    }
    shape_.resize(largest);
}

void LocalShapeReader::append_blocks(std::uint32_t control) {
    const Control& all = state_.controls[control];
    const Eigen::MatrixXf& map = local_.map[control];
    const Eigen::VectorXf bias = -map * local_.mean[control];
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
        const std::size_t numbers = local_.size(control);
        if (b == 0 || blocks_[b - 1].control != control) read_shape(control, vertices, normals, rotations[control]);
        read_block(blocks_[b], numbers, x);
    }
}

void LocalShapeReader::read_shape(std::uint32_t control, std::span<const Vec3> vertices, std::span<const Vec3> normals,
                                  const Eigen::Matrix3f& rotation) {
    static_assert(LocalShapeState::k_numbers == 4);
    const std::uint32_t* const begin = local_.vertex.data() + local_.begin[control];
    const std::uint32_t* const end = local_.vertex.data() + local_.begin[control + 1];
    if (begin == end) return;
    const auto turning = [&](int j) { return FourFloats{rotation(j, 0), rotation(j, 1), rotation(j, 2), 0}; };
    const auto rising = [&](int j) { return FourFloats{0, 0, 0, rotation(j, 2) / local_.unit}; };
    const FourFloats turn[] = {turning(0), turning(1), turning(2)}, rise[] = {rising(0), rising(1), rising(2)};
    const FourFloats start = load_three(vertices[*begin].data());
    FourFloats sum{};
    float* out = shape_.data();
    for (const std::uint32_t* v = begin; v != end; ++v, out += 4) {
        const FourFloats n = load_three(normals[*v].data()), p = load_three(vertices[*v].data()) - start;
        const FourFloats numbers =
            n[0] * turn[0] + n[1] * turn[1] + n[2] * turn[2] + p[0] * rise[0] + p[1] * rise[1] + p[2] * rise[2];
        sum += numbers;
        std::memcpy(out, &numbers, sizeof(numbers));
    }
    const float middle = sum[3] / static_cast<float>(end - begin);
    for (float* height = shape_.data() + 3; height < out; height += 4) *height -= middle;
}

void LocalShapeReader::read_block(const Block& block, std::size_t numbers, std::span<float> x) const {
    static_assert(k_lanes == 16 && LocalShapeState::k_numbers % 2 == 0);
    const auto bias = static_cast<std::size_t>(&block - blocks_.data()) * k_lanes;
    EightFloats low, high, low_odd{}, high_odd{};
    std::memcpy(&low, &bias_[bias], sizeof(low));
    std::memcpy(&high, &bias_[bias + 8], sizeof(high));
    const Half* map = map_.data() + block.map;
    for (std::size_t i = 0; i < numbers; i += 2, map += 2 * k_lanes) {  // four sums, which do not wait for each other
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
