#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace exemplar {

/// The priority queue of Dijkstra's algorithm: pops (distance, face) by increasing distance, then increasing face.
/// Distances are >= 0. Entries are never changed in place: push a better one, and skip the outdated one when it is
/// popped. Implemented as a heap with four children per node whose entries are single integers, since the bits of a
/// non-negative float increase with its value.
class DistanceQueue {
  public:
    struct Entry {
        float distance;
        std::uint32_t face;
    };
    bool empty() const { return size_ == 0; }

    void push(float distance, std::uint32_t face) {
        if (size_ + k_arity >= keys_.size()) grow();
        const std::uint64_t key = (std::uint64_t{std::bit_cast<std::uint32_t>(distance)} << 32) | face;
        std::size_t hole = size_++;
        while (hole > 0) {
            const std::size_t parent = (hole - 1) / k_arity;
            if (keys_[parent] <= key) break;
            keys_[hole] = keys_[parent];
            hole = parent;
        }
        keys_[hole] = key;
    }

    /// Removes and returns the entry with the smallest distance; the queue must not be empty.
    Entry pop() {
        const std::uint64_t top = keys_[0];
        const std::uint64_t last = keys_[--size_];
        keys_[size_] = k_absent;
        std::size_t hole = 0;
        for (std::size_t child = 1; child < size_; child = k_arity * hole + 1) {
            const std::size_t smallest = smallest_of_four(child);
            if (keys_[smallest] >= last) break;
            keys_[hole] = keys_[smallest];
            hole = smallest;
        }
        if (size_ > 0) keys_[hole] = last;
        return {std::bit_cast<float>(static_cast<std::uint32_t>(top >> 32)), static_cast<std::uint32_t>(top)};
    }

  private:
    static constexpr std::size_t k_arity = 4;
    static constexpr std::uint64_t k_absent = ~std::uint64_t{0};

    void grow() { keys_.resize(std::max<std::size_t>(64, 2 * keys_.size()), k_absent); }

    /// Slots past the last entry hold k_absent, so a node's four children can always be compared.
    std::size_t smallest_of_four(std::size_t first) const {
        const std::size_t low = keys_[first + 1] < keys_[first] ? first + 1 : first;
        const std::size_t high = keys_[first + 3] < keys_[first + 2] ? first + 3 : first + 2;
        return keys_[high] < keys_[low] ? high : low;
    }

    std::vector<std::uint64_t> keys_;
    std::size_t size_ = 0;
};

}  // namespace exemplar
