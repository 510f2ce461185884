#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <list>
#include <memory>
#include <span>
#include <string_view>

#include "gpu/runtime/record/buffer.h"

namespace exemplar {

/// Stands for contents: XXH3 with 128 bits of what they are made of.
using ContentKey = std::array<std::uint64_t, 2>;
/// Of values that are used in a certain way; equal bytes in other parts or another use give another key.
ContentKey content_key(std::string_view use, std::span<const std::span<const std::byte>> parts);
inline ContentKey content_key(std::string_view use, std::initializer_list<std::span<const std::byte>> parts) {
    return content_key(use, std::span(parts.begin(), parts.size()));
}

/// Buffers that are filled once and used again as long as their contents are asked for, whoever has them: so what
/// belongs to a mesh is uploaded for its first view only. Those that were not asked for the longest are given up.
class KeptBuffers {
  public:
    /// Keeps at most so many bytes, and always what was asked for last.
    explicit KeptBuffers(std::size_t most_bytes) : most_bytes_(most_bytes) {}

    /// The buffer of that key; if there is none, what make() returns. It lives at least as long as the result.
    template <typename Make>
    std::shared_ptr<Buffer> get(const ContentKey& key, Make&& make) {
        const auto known = std::ranges::find(kept_, key, &Kept::key);
        if (known != kept_.end())
            kept_.splice(kept_.begin(), kept_, known);
        else
            add(key, std::make_shared<Buffer>(make()));
        return kept_.front().buffer;
    }
    std::size_t bytes() const { return bytes_; }

  private:
    struct Kept {
        ContentKey key;
        std::shared_ptr<Buffer> buffer;
    };
    void add(const ContentKey& key, std::shared_ptr<Buffer> buffer);
    std::size_t most_bytes_, bytes_ = 0;
    std::list<Kept> kept_;  // by how lately they were asked for
};

}  // namespace exemplar
