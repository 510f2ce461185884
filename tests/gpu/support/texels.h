#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include "gpu/imaging/canvas.h"
#include "tests/gpu/support/environment.h"

namespace exemplar::test_support {

/// The pixels of a canvas of 8 bits a channel that a picture was drawn on, red lowest.
inline std::vector<std::uint32_t> texels_of(const Canvas& canvas, Stream& stream) {
    std::vector<std::uint32_t> texels(std::size_t{canvas.extent().width} * canvas.extent().height);
    const Buffer buffer(shared_device(), 4 * texels.size());
    canvas.copy_color(stream, canvas.extent(), buffer);
    stream.fetch<std::uint32_t>(buffer, texels);
    return texels;
}

/// What `record` leaves on a canvas that was cleared.
inline std::vector<std::uint32_t> drawn_texels(const Canvas& canvas, const std::array<float, 4>& clear,
                                               const std::function<void(Stream&)>& record) {
    Stream stream(shared_device());
    canvas.begin(stream);
    stream.render(Pass("clear", canvas.cleared(clear)));
    canvas.separate_passes(stream);
    record(stream);
    canvas.end(stream);
    return texels_of(canvas, stream);
}

}  // namespace exemplar::test_support
