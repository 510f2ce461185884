#include "gpu/runtime/record/hazards.h"

#include <algorithm>

namespace exemplar {
namespace {

// One entry per buffer: a command that reads one part and writes another part of a buffer both reads and writes it.
std::vector<Access> merge(std::span<const Access> accesses) {
    std::vector<Access> merged;
    for (const Access& access : accesses) {
        const auto same = std::ranges::find(merged, access.buffer, &Access::buffer);
        if (same == merged.end()) {
            merged.push_back(access);
        } else {
            same->stage |= access.stage;
            same->reads |= access.reads;
            same->writes |= access.writes;
        }
    }
    return merged;
}

}  // namespace

bool HazardTracker::needs_barrier(const State& state, const Access& access) {
    if (access.writes) return state.write_stage || state.read_stages;
    const auto covers = [&](const VisibleAccess& sight) {
        return (sight.stages & access.stage) == access.stage && (sight.reads & access.reads) == access.reads;
    };
    return state.write_stage && std::ranges::none_of(state.visible, covers);
}

void HazardTracker::remember(State& state, const Access& access, bool barrier) {
    if (access.writes) {
        state = {.write_stage = access.stage, .write_access = access.writes, .read_stages = 0, .visible = {}};
        return;
    }
    state.read_stages |= access.stage;
    if (barrier) state.visible.push_back({access.stage, access.reads});
}

std::vector<Barrier> HazardTracker::before(std::span<const Access> accesses) {
    std::vector<Barrier> barriers;
    for (const Access& access : merge(accesses)) {
        State& state = states_[access.buffer];
        const bool barrier = needs_barrier(state, access);
        if (barrier)
            barriers.push_back({.buffer = access.buffer,
                                .source_stage = state.write_stage | (access.writes ? state.read_stages : 0),
                                .source_access = state.write_access,
                                .target_stage = access.stage,
                                .target_access = access.reads | access.writes});
        remember(state, access, barrier);
    }
    return barriers;
}

}  // namespace exemplar
