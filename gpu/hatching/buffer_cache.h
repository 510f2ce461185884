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

/// Identifies the contents of a buffer: the 128-bit XXH3 hash of what they are made of.
using ContentKey = std::array<std::uint64_t, 2>;
/// Returns the key of values for a certain use. The same bytes in other parts, or for another use, have another key.
ContentKey content_key(std::string_view use, std::span<const std::span<const std::byte>> parts);
inline ContentKey content_key(std::string_view use, std::initializer_list<std::span<const std::byte>> parts) {
    return content_key(use, std::span(parts.begin(), parts.size()));
}

/// A cache of device buffers by the hash of their contents, so that what belongs to a mesh is uploaded for its first
/// view only. Evicts the least recently used buffers first.
class BufferCache {
  public:
    /// Keeps at most that many bytes, but always the buffer used last.
    explicit BufferCache(std::size_t max_bytes) : max_bytes_(max_bytes) {}

    /// Returns the buffer of a key; if it is not cached, stores what make() returns. The buffer lives at least as
    /// long as the result.
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
    std::size_t max_bytes_, bytes_ = 0;
    std::list<Kept> kept_;  // most recently used first
};

}  // namespace exemplar
