#pragma once

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

namespace exemplar {

/// Hands values from some threads to others, in order, and lets the former wait while it is full. Thread-safe.
template <typename T>
class BoundedQueue {
  public:
    explicit BoundedQueue(std::size_t capacity) : capacity_(capacity) {}

    /// Waits while the queue is full. False, and the value is dropped, if it was abandoned.
    bool push(T value) {
        std::unique_lock lock(mutex_);
        room_.wait(lock, [&] { return values_.size() < capacity_ || abandoned_; });
        if (abandoned_) return false;
        values_.push_back(std::move(value));
        lock.unlock();
        filled_.notify_one();
        return true;
    }
    /// Waits for a value; nothing once the queue is closed and empty, or abandoned.
    std::optional<T> pop() {
        std::vector<T> one = pop_some(1);
        return one.empty() ? std::nullopt : std::optional<T>(std::move(one.front()));
    }
    /// Waits for a value and takes it with up to `most` - 1 that follow without waiting for them; none as pop().
    std::vector<T> pop_some(std::size_t most) {
        std::unique_lock lock(mutex_);
        filled_.wait(lock, [&] { return !values_.empty() || closed_ || abandoned_; });
        std::vector<T> taken;
        while (!values_.empty() && taken.size() < most && !abandoned_) {
            taken.push_back(std::move(values_.front()));
            values_.pop_front();
        }
        lock.unlock();
        room_.notify_all();
        return taken;
    }
    /// No more values will come.
    void close() { end(closed_); }
    /// Nobody waits any longer, and what is in the queue is dropped.
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
