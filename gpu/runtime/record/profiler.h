#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <string_view>

namespace exemplar {

/// Collects the device time per kernel, from timestamps around every dispatch of the streams that use this profiler,
/// and counts the submissions that these streams have waited for.
class Profiler {
  public:
    struct Entry {
        std::size_t dispatches = 0;
        double milliseconds = 0.0;  ///< of all dispatches together
    };

    void add(std::string_view kernel, double milliseconds) {
        Entry& entry = entries_[std::string(kernel)];
        ++entry.dispatches;
        entry.milliseconds += milliseconds;
    }
    /// By kernel name; filled when a stream has waited for its work. Empty on a device without timestamps.
    const std::map<std::string, Entry>& entries() const { return entries_; }
    /// Milliseconds of one kernel; 0 if it never ran.
    double milliseconds(const std::string& kernel) const {
        const auto found = entries_.find(kernel);
        return found == entries_.end() ? 0.0 : found->second.milliseconds;
    }
    void add_submission() { ++submissions_; }
    /// Number of submissions that streams have waited for.
    std::size_t submissions() const { return submissions_; }
    void reset() {
        entries_.clear();
        submissions_ = 0;
    }

  private:
    std::size_t submissions_ = 0;
    std::map<std::string, Entry> entries_;
};

}  // namespace exemplar
