#include "gpu/hatching/buffer_cache.h"

#include <xxhash.h>

#include <new>
#include <utility>

namespace exemplar {

ContentKey content_key(std::string_view use, std::span<const std::span<const std::byte>> parts) {
    const std::unique_ptr<XXH3_state_t, decltype(&XXH3_freeState)> state(XXH3_createState(), XXH3_freeState);
    if (!state) throw std::bad_alloc();
    XXH3_128bits_reset_withSeed(state.get(), XXH3_64bits(use.data(), use.size()));
    for (const std::span<const std::byte> part : parts) {
        const std::uint64_t size = part.size();
        XXH3_128bits_update(state.get(), &size, sizeof size);
        XXH3_128bits_update(state.get(), part.data(), part.size());
    }
    const XXH128_hash_t hash = XXH3_128bits_digest(state.get());
    return {hash.low64, hash.high64};
}

void BufferCache::add(const ContentKey& key, std::shared_ptr<Buffer> buffer) {
    bytes_ += buffer->bytes();
    kept_.push_front({key, std::move(buffer)});
    while (bytes_ > max_bytes_ && kept_.size() > 1) {
        bytes_ -= kept_.back().buffer->bytes();
        kept_.pop_back();
    }
}

}  // namespace exemplar
