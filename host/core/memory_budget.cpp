#include "host/core/memory_budget.h"

#include <unistd.h>

#include <algorithm>
#include <cstdint>
#include <fstream>
#include <iterator>
#include <limits>
#include <sstream>
#include <string_view>
#include <utility>

namespace exemplar {
namespace {

namespace fs = std::filesystem;

/// Returns the smallest number in the files `name` of `folder` and of every folder on the path from there to
/// `group`.
std::size_t min_along_path(fs::path folder, const fs::path& group, const char* name) {
    std::size_t least = std::numeric_limits<std::size_t>::max();
    const auto look = [&] {
        std::ifstream file(folder / name);
        if (std::uint64_t value = 0; file >> value) least = std::min<std::size_t>(least, value);  // not if it is "max"
    };
    look();
    for (const fs::path& part : group.relative_path()) {
        if (part == "..") break;  // the group is not visible in this mount
        folder /= part;
        look();
    }
    return least;
}

bool names_memory(std::string_view controllers) {
    while (!controllers.empty()) {
        const std::size_t end = std::min(controllers.find(','), controllers.size());
        if (controllers.substr(0, end) == "memory") return true;
        controllers.remove_prefix(std::min(end + 1, controllers.size()));
    }
    return false;
}

}  // namespace

MemoryBudget::Share::~Share() {
    if (!budget_) return;
    {
        const std::lock_guard lock(budget_->mutex_);
        budget_->taken_ -= bytes_;
    }
    budget_->freed_.notify_all();
}

void MemoryBudget::Share::resize(std::size_t bytes) {
    if (!budget_) return;
    {
        const std::lock_guard lock(budget_->mutex_);
        budget_->taken_ += bytes - bytes_;
        bytes_ = bytes;
    }
    budget_->freed_.notify_all();
}

MemoryBudget::Share MemoryBudget::take(std::size_t bytes) {
    std::unique_lock lock(mutex_);
    freed_.wait(lock, [&] { return abandoned_ || taken_ == 0 || taken_ + bytes <= bytes_; });
    taken_ += bytes;
    return {this, bytes};
}

void MemoryBudget::abandon() {
    {
        const std::lock_guard lock(mutex_);
        abandoned_ = true;
    }
    freed_.notify_all();
}

std::size_t usable_memory() {
    const std::size_t bytes =
        static_cast<std::size_t>(sysconf(_SC_PHYS_PAGES)) * static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
    std::ifstream file("/proc/self/cgroup");
    const std::string groups(std::istreambuf_iterator<char>(file), {});
    return std::min(bytes, memory_limit(groups, "/sys/fs/cgroup"));
}

std::size_t resident_memory() {
    std::ifstream file("/proc/self/statm");
    std::size_t total = 0, resident = 0;
    file >> total >> resident;
    return resident * static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
}

std::size_t memory_limit(const std::string& groups, const fs::path& root) {
    std::size_t least =
        std::min(min_along_path(root, {}, "memory.max"), min_along_path(root / "memory", {}, "memory.limit_in_bytes"));
    std::istringstream lines(groups);
    for (std::string line; std::getline(lines, line);) {
        // NUMBER:CONTROLLERS:GROUP, where the group may hold colons; version 2 names no controllers
        const std::size_t first = line.find(':'), second = line.find(':', first + 1);
        if (first == std::string::npos || second == std::string::npos) continue;
        const std::string controllers = line.substr(first + 1, second - first - 1);
        const fs::path group = line.substr(second + 1);
        if (controllers.empty()) least = std::min(least, min_along_path(root, group, "memory.max"));
        if (names_memory(controllers))
            least = std::min(least, min_along_path(root / "memory", group, "memory.limit_in_bytes"));
    }
    return least;
}

}  // namespace exemplar
