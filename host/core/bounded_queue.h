#pragma once

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

namespace exemplar {

/// A first-in, first-out queue between producer and consumer threads. Producers wait while it is full. Thread-safe.
template <typename T>
class BoundedQueue {
  public:
    explicit BoundedQueue(std::size_t capacity) : capacity_(capacity) {}

    /// Appends a value; waits while the queue is full. Returns false and drops the value if the queue was abandoned.
    bool push(T value) {
        std::unique_lock lock(mutex_);
        room_.wait(lock, [&] { return values_.size() < capacity_ || abandoned_; });
        if (abandoned_) return false;
        values_.push_back(std::move(value));
        lock.unlock();
        filled_.notify_one();
        return true;
    }
    /// Removes and returns the first value; waits for one. Returns nothing once the queue is closed and empty, or
    /// abandoned.
    std::optional<T> pop() {
        std::vector<T> one = pop_batch(1);
        return one.empty() ? std::nullopt : std::optional<T>(std::move(one.front()));
    }
    /// Waits for one value, then removes it and up to `most` - 1 more that are already queued. Returns none where
    /// pop() returns nothing.
    std::vector<T> pop_batch(std::size_t max_count) {
        std::unique_lock lock(mutex_);
        filled_.wait(lock, [&] { return !values_.empty() || closed_ || abandoned_; });
        std::vector<T> taken;
        while (!values_.empty() && taken.size() < max_count && !abandoned_) {
            taken.push_back(std::move(values_.front()));
            values_.pop_front();
        }
        lock.unlock();
        room_.notify_all();
        return taken;
    }
    /// Declares that no more values will be pushed.
    void close() { end(closed_); }
    /// Wakes all waiting threads and drops the queued values.
    void abandon() {
        end(abandoned_);
        const std::lock_guard lock(mutex_);
        values_.clear();
    }

  private:
    void end(bool& flag) {
        {
            const std::lock_guard lock(mutex_);
            flag = true;
        }
        filled_.notify_all();
        room_.notify_all();
    }
    std::mutex mutex_;
    std::condition_variable filled_, room_;
    std::deque<T> values_;
    std::size_t capacity_;
    bool closed_ = false, abandoned_ = false;
};

}  // namespace exemplar
