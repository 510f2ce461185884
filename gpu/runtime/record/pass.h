#pragma once

#include <vulkan/vulkan_core.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <optional>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include "gpu/runtime/kernels/draw_pipeline.h"
#include "gpu/runtime/record/buffer.h"

namespace exemplar {

/// Images that a pass draws into, in the optimal layouts of color and depth attachments.
struct PassTarget {
    VkImageView color = VK_NULL_HANDLE;
    VkImageView depth = VK_NULL_HANDLE;
    VkExtent2D extent{};
    std::optional<std::array<float, 4>> clear_color{};  ///< none: draws over the contents
    std::optional<float> clear_depth{};
};

/// One draw call.
struct Draw {
    std::uint32_t vertices = 0;
    std::uint32_t first_vertex = 0;
    /// Index buffer of uints, read from index `first_vertex` on; not together with `indirect`.
    const Buffer* indices = nullptr;
    /// Holds a VkDrawIndirectCommand that replaces the counts above.
    const Buffer* indirect = nullptr;
    std::size_t indirect_offset = 0;  ///< bytes, a multiple of 4
    std::optional<VkRect2D> scissor{};
};

/// Draw calls into one target, in order; Stream::render records them. Buffers must live until then.
class Pass {
  public:
    Pass(std::string name, const PassTarget& target) : name_(std::move(name)), target_(target) {}

    /// `bindings` are in the order of the shaders' binding numbers.
    void draw(const DrawPipeline& pipeline, const Draw& draw, std::initializer_list<BufferRange> bindings) {
        items_.push_back({pipeline.program(), draw, bindings, {}});
    }
    template <typename Push>
    void draw(const DrawPipeline& pipeline, const Draw& draw, std::initializer_list<BufferRange> bindings,
              const Push& push) {
        static_assert(std::is_trivially_copyable_v<Push>);
        const auto bytes = std::as_bytes(std::span(&push, 1));
        items_.push_back({pipeline.program(), draw, bindings, {bytes.begin(), bytes.end()}});
    }

    struct Item {
        std::shared_ptr<const Program> program;
        Draw draw;
        std::vector<BufferRange> bindings;
        std::vector<std::byte> push;
    };
    const std::string& name() const { return name_; }
    const PassTarget& target() const { return target_; }
    const std::vector<Item>& items() const { return items_; }

  private:
    std::string name_;
    PassTarget target_;
    std::vector<Item> items_;
};

}  // namespace exemplar
