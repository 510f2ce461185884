#pragma once

#include <vulkan/vulkan_core.h>

#include <span>
#include <unordered_map>
#include <vector>

namespace exemplar {

/// How one command uses one resource.
struct Access {
    VkBuffer buffer = VK_NULL_HANDLE;
    VkPipelineStageFlags2 stage = 0;
    VkAccessFlags2 reads = 0;
    VkAccessFlags2 writes = 0;
};

/// The accesses that a command must wait for.
struct Barrier {
    VkBuffer buffer = VK_NULL_HANDLE;
    VkPipelineStageFlags2 source_stage = 0;
    VkAccessFlags2 source_access = 0;
    VkPipelineStageFlags2 target_stage = 0;
    VkAccessFlags2 target_access = 0;
};

/// Tracks the last uses of every buffer of one command sequence and derives the barriers between commands:
/// read after write, write after write (memory dependencies) and write after read (an execution dependency).
/// Reads after reads need none. Buffers are tracked as a whole. Needs no device, so it can be tested alone.
class HazardTracker {
  public:
    /// Returns the barriers needed before a command with these accesses, and records the accesses. Those of the same
    /// buffer are merged.
    std::vector<Barrier> before(std::span<const Access> accesses);
    /// Forgets all accesses; call it after a barrier that covers all earlier commands.
    void reset() { states_.clear(); }

  private:
    // One barrier makes a write visible to these accesses in these stages. Stages of one barrier and accesses of
    // another do not combine.
    struct VisibleAccess {
        VkPipelineStageFlags2 stages;
        VkAccessFlags2 reads;
    };
    struct State {
        VkPipelineStageFlags2 write_stage = 0;
        VkAccessFlags2 write_access = 0;
        VkPipelineStageFlags2 read_stages = 0;  // since the write
        std::vector<VisibleAccess> visible;     // one per barrier since the write
    };
    static bool needs_barrier(const State& state, const Access& access);
    static void remember(State& state, const Access& access, bool barrier);
    std::unordered_map<VkBuffer, State> states_;
};

}  // namespace exemplar
