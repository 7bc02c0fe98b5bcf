// `tunewright mcp`: the Model Context Protocol on standard input and output, one message a line.
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <condition_variable>
#include <deque>
#include <exception>
#include <iostream>
#include <map>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>
#include <thread>
#include <utility>
#include <variant>
#include <vector>

#include "api/mcp/message.h"
#include "api/mcp/protocol.h"
#include "server/cli/command_tree.h"
#include "server/cli/local_tool_host.h"

namespace tunewright::server {
namespace {

namespace mcp = api::mcp;

constexpr std::size_t kMaxLine = 32 << 20;  // bytes of a message
constexpr std::size_t kMaxWaiting = 64;     // calls that wait for their turn

/// Lines of standard input. A line that is too long is read to its end and dropped.
class InputLines {
public:
    /// The next line without its end; empty at the end of the input. `too_long`: it was dropped.
    std::optional<std::string> next(bool& too_long) {
        std::string line;
        too_long = false;
        while (true) {
            const std::size_t end = buffer_.find('\n', from_);
            const std::size_t stop = end == std::string::npos ? buffer_.size() : end;
            if (line.size() + (stop - from_) > kMaxLine) too_long = true;
            if (too_long)
                line.clear();
            else
                line.append(buffer_, from_, stop - from_);
            from_ = stop + 1;
            if (end != std::string::npos) return line;
            if (!fill()) return line.empty() && !too_long ? std::nullopt : std::optional(std::move(line));
        }
    }

private:
    /// Reads more; false at the end of the input.
    bool fill() {
        std::array<char, 1 << 16> piece;
        ssize_t count = 0;
        do count = ::read(STDIN_FILENO, piece.data(), piece.size());
        while (count < 0 && errno == EINTR);
        buffer_.assign(piece.data(), static_cast<std::size_t>(std::max<ssize_t>(count, 0)));
        from_ = 0;
        return count > 0;
    }

    std::string buffer_;
    std::size_t from_ = 0;
};

/// Reads messages and answers them: what computes waits for its turn on another thread, so that a ping or a
/// cancellation is heard meanwhile.
class McpServer {
public:
    /// Returns at the end of the input, when all calls are answered.
    int run() {
        std::jthread worker([this] { work(); });
        bool too_long = false;
        while (auto line = lines_.next(too_long)) {
            if (too_long)
                write(mcp::error_message(
                    nullptr, {mcp::kInvalidRequest, "A message has more than " + std::to_string(kMaxLine >> 20) +
                                                        " MiB, the limit. Send less."}));
            else if (line->find_first_not_of(" \t\r") != std::string::npos)
                take(mcp::read_messages(*line));
        }
        const std::lock_guard lock(mutex_);
        ended_ = true;
        arrived_.notify_one();
        return 0;
    }

private:
    void take(mcp::Incoming incoming) {
        bool waits = false;
        for (const auto& part : incoming.parts) {
            const auto* one = std::get_if<mcp::Message>(&part);
            if (one == nullptr) continue;
            if (one->method == "notifications/cancelled") cancel(one->params.value("requestId", api::Json()));
            waits = waits || mcp::computes(*one);
        }
        if (!waits) return write(answers(incoming));
        const std::unique_lock lock(mutex_);
        if (waiting_.size() < kMaxWaiting) {
            for (const std::string& id : ids(incoming)) stops_[id] = {};
            waiting_.push_back(std::move(incoming));
            arrived_.notify_one();
            return;
        }
        for (const auto& part : incoming.parts)
            if (const auto* message = std::get_if<mcp::Message>(&part); message && !message->id.is_null())
                write(mcp::error_message(message->id,
                                         {mcp::kOverloaded, "Too many calls are waiting. Send this one again later."}));
    }

    static std::vector<std::string> ids(const mcp::Incoming& incoming) {
        std::vector<std::string> found;
        for (const auto& part : incoming.parts)
            if (const auto* message = std::get_if<mcp::Message>(&part); message && mcp::computes(*message))
                found.push_back(message->id.dump());
        return found;
    }

    void cancel(const api::Json& id) {
        const std::lock_guard lock(mutex_);
        if (const auto found = stops_.find(id.dump(-1, ' ', false, api::Json::error_handler_t::replace));
            found != stops_.end())
            found->second.request_stop();
    }

    /// The answers to all parts, in their form.
    std::string answers(const mcp::Incoming& incoming) {
        std::vector<std::string> made;
        for (const auto& part : incoming.parts) {
            const auto* message = std::get_if<mcp::Message>(&part);
            made.push_back(message ? answer(*message) : std::get<std::string>(part));
        }
        return mcp::joined(incoming, made);
    }

    /// "" for a call that was cancelled: nobody waits for its answer.
    std::string answer(const mcp::Message& message) {
        if (!mcp::computes(message)) return mcp::answer(message, host_);
        const std::string id = message.id.dump();
        const std::stop_token stop = stop_of(id);
        host_.stop_with(stop);
        std::string made;
        if (!stop.stop_requested()) try {
                made = mcp::answer(message, host_);
            } catch (const std::exception& fault) {
                std::cerr << "tunewright: " << message.method << " failed: " << fault.what() << std::endl;
                made = mcp::error_message(message.id, {mcp::kInternalError, "The server failed to handle this call."});
            }
        const std::lock_guard lock(mutex_);
        stops_.erase(id);
        return stop.stop_requested() ? "" : made;
    }

    std::stop_token stop_of(const std::string& id) {
        const std::lock_guard lock(mutex_);
        return stops_[id].get_token();
    }

    void work() {
        while (true) {
            std::unique_lock lock(mutex_);
            arrived_.wait(lock, [this] { return ended_ || !waiting_.empty(); });
            if (waiting_.empty()) return;
            const mcp::Incoming incoming = std::move(waiting_.front());
            waiting_.pop_front();
            lock.unlock();
            write(answers(incoming));
        }
    }

    void write(const std::string& message) {
        if (message.empty()) return;
        const std::lock_guard lock(output_);
        std::cout << message << "\n" << std::flush;
    }

    InputLines lines_;
    LocalToolHost host_;
    std::mutex mutex_, output_;
    std::condition_variable arrived_;
    std::deque<mcp::Incoming> waiting_;
    std::map<std::string, std::stop_source> stops_;  ///< of calls that wait or run, by id
    bool ended_ = false;
};

int serve_on_standard_streams() {
    if (isatty(STDIN_FILENO) != 0)
        std::cerr << "tunewright mcp is started by a client of the Model Context Protocol, which sends one message a "
                     "line; Ctrl-D ends it."
                  << std::endl;
    return McpServer().run();
}

}  // namespace

void add_mcp_command(CommandTree& tree) {
    tree.add("mcp", "Tools for agents: the Model Context Protocol on standard input and output",
             serve_on_standard_streams);
}

}  // namespace tunewright::server
