#pragma once

#include <deque>
#include <string>

namespace exemplar {

/// Messages of a running program, newest last. Errors stay until they are dismissed; remarks fade.
class Messages {
  public:
    struct Message {
        std::string text;
        bool is_error = false;
        double seconds_left = 0;  ///< of remarks
    };

    void error(std::string text) { add({std::move(text), true, 0}); }
    void remark(std::string text) { add({std::move(text), false, k_seconds}); }
    void advance(double seconds) {
        for (Message& message : messages_) message.seconds_left -= seconds;
        std::erase_if(messages_, [](const Message& m) { return !m.is_error && m.seconds_left <= 0; });
    }
    void dismiss(std::size_t index) { messages_.erase(messages_.begin() + static_cast<std::ptrdiff_t>(index)); }
    const std::deque<Message>& all() const { return messages_; }

  private:
    static constexpr double k_seconds = 6;
    static constexpr std::size_t k_most = 4;
    void add(Message message) {
        std::erase_if(messages_, [&](const Message& m) { return m.text == message.text; });
        messages_.push_back(std::move(message));
        if (messages_.size() > k_most) messages_.pop_front();
    }
    std::deque<Message> messages_;
};

}  // namespace exemplar
