#pragma once

#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <deque>
#include <exception>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "host/core/stopwatch.h"

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
    /// Waits for one value, then removes and returns it and up to `max_count` - 1 more that are already queued. Returns
    /// none once the queue is closed and empty, or abandoned.
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

/// Statistics of one stage of a pipeline.
struct StageStatistics {
    std::string name;
    std::size_t workers = 0;
    std::size_t items = 0;   ///< processed
    std::size_t groups = 0;  ///< calls of its work function
    double busy = 0;         ///< seconds of work, summed over its workers
    double load = 0;         ///< mean share of the running time that a worker was busy, in [0, 1]
};

/// Passes items through consecutive stages that run concurrently, each with threads of its own. A bounded queue in
/// front of each stage limits the number of items in flight. Items may overtake each other where a stage has several
/// workers.
template <typename Item>
class Pipeline {
  public:
    struct Stage {
        std::string name;
        std::size_t workers;  ///< at least 1
        std::size_t group;    ///< maximum number of items per call; a worker takes those that wait already
        std::size_t room;     ///< capacity of the queue in front of the stage
        std::function<void(std::span<Item>)> work;
    };

    /// `source` returns the next item, or nothing at the end. One thread calls it.
    Pipeline(std::function<std::optional<Item>()> source, std::vector<Stage> stages)
        : source_(std::move(source)), stages_(std::move(stages)) {
        for (const Stage& stage : stages_) {
            queues_.push_back(std::make_unique<BoundedQueue<Item>>(stage.room));
            reports_.push_back({.name = stage.name, .workers = stage.workers});
        }
        running_ = std::vector<std::atomic<std::size_t>>(stages_.size());
    }

    /// Runs until the source has ended and all items have left the last stage. If the source or a stage throws, all
    /// stop once their current calls return, and the first exception is rethrown here. In that case `abandoned` is
    /// called, from any thread, to wake threads that wait for something else.
    void run(const std::function<void()>& abandoned = {}) {
        abandoned_ = abandoned;
        const Stopwatch watch;
        {
            std::vector<std::jthread> threads;
            guard([&] { start(threads); });  // the system may have no more threads
        }
        for (StageStatistics& report : reports_)
            report.load = report.busy / (watch.wall() * static_cast<double>(report.workers));
        if (error_) std::rethrow_exception(error_);
    }

    /// Returns the statistics of the stages, in order; valid after run().
    const std::vector<StageStatistics>& reports() const { return reports_; }

  private:
    void start(std::vector<std::jthread>& threads) {
        for (std::size_t s = 0; s < stages_.size(); ++s) running_[s] = stages_[s].workers;
        threads.emplace_back([this] { guard([this] { run_source(); }); });
        for (std::size_t s = 0; s < stages_.size(); ++s)
            for (std::size_t w = 0; w < stages_[s].workers; ++w)
                threads.emplace_back([this, s] { guard([this, s] { run_stage(s); }); });
    }
    void run_source() {
        while (std::optional<Item> item = source_())
            if (!queues_.front()->push(std::move(*item))) break;
        queues_.front()->close();
    }
    void run_stage(std::size_t s) {
        for (;;) {
            std::vector<Item> items = queues_[s]->pop_batch(stages_[s].group);
            if (items.empty()) break;
            const Stopwatch watch;
            stages_[s].work(items);
            count(s, items.size(), watch.wall());
            if (s + 1 == stages_.size()) continue;
            for (Item& item : items) queues_[s + 1]->push(std::move(item));
        }
        if (--running_[s] == 0 && s + 1 < stages_.size()) queues_[s + 1]->close();
    }
    void count(std::size_t report, std::size_t items, double seconds) {
        const std::lock_guard lock(mutex_);
        reports_[report].items += items;
        ++reports_[report].groups;
        reports_[report].busy += seconds;
    }
    template <typename Work>
    void guard(Work&& work) {
        try {
            work();
        } catch (...) {
            {
                const std::lock_guard lock(mutex_);
                if (!error_) error_ = std::current_exception();
            }
            for (auto& queue : queues_) queue->abandon();
            if (abandoned_) abandoned_();
        }
    }

    std::function<std::optional<Item>()> source_;
    std::vector<Stage> stages_;
    std::function<void()> abandoned_;
    std::vector<std::unique_ptr<BoundedQueue<Item>>> queues_;  ///< in front of each stage
    std::vector<std::atomic<std::size_t>> running_;            ///< workers of each stage that have not finished
    std::vector<StageStatistics> reports_;
    std::mutex mutex_;
    std::exception_ptr error_;
};

}  // namespace exemplar
