#include "server/notify/secrets.h"

#include <cerrno>
#include <cstring>
#include <iostream>
#include <stdexcept>

#include "server/notify/signature.h"

namespace tunewright::server {
namespace {

constexpr int kFailed = 1;
constexpr int kBadName = 2;

}  // namespace

Secrets::Secrets(const std::string& path, std::function<Clock::time_point()> now)
    : file_(path, meaning(), std::move(now)) {
    if (lines_.empty())
        throw std::invalid_argument(
            "The file of secrets " + path +
            " cannot be used: it has no secret; `tunewright secret NAME --file FILE` adds one.");
}

WatchedFile::Meaning Secrets::meaning() {
    WatchedFile::Meaning made{"file of secrets", "no notifications are sent", "secret", "--notify-secrets", {}, {}};
    made.take = [this](std::string_view text) {
        std::vector<std::pair<std::string, std::string>> lines;
        for (const NamedLine& line : named_lines(text)) {
            auto bytes = secret_bytes(line.value);
            if (!is_key_name(line.name) || !bytes)
                throw std::invalid_argument(
                    "line " + std::to_string(line.number) +
                    " must be NAME whsec_BASE64 of 24 to 64 bytes, as written by `tunewright secret NAME`");
            lines.emplace_back(line.name, *std::move(bytes));
        }
        lines_ = std::move(lines);
        return lines_.size();
    };
    made.forget = [this] { lines_.clear(); };
    return made;
}

std::vector<std::string> Secrets::of(std::string_view name) {
    const std::lock_guard lock(mutex_);
    file_.look();
    std::vector<std::string> found;
    if (lines_.empty()) return found;
    const std::string_view wanted = name.empty() ? std::string_view(lines_.front().first) : name;
    for (const auto& [given, bytes] : lines_)
        if (given == wanted) found.push_back(bytes);
    return found;
}

int make_secret(const SecretCommand& command) {
    if (!is_key_name(command.name)) {
        std::cerr << "tunewright: the name must be 1 to 64 letters, digits, dots, underscores or hyphens.\n";
        return kBadName;
    }
    const std::string secret = new_secret();
    const std::string line = command.name + " " + secret + "\n";
    if (command.file.empty()) {
        std::cerr << "# For the file of secrets:\n" << line;
    } else if (!append_line(command.file, line)) {
        std::cerr << "tunewright: cannot write to " << command.file << ": " << std::strerror(errno) << ".\n";
        return kFailed;
    }
    std::cout << secret << std::endl;
    if (std::cout) return 0;
    std::cerr << "tunewright: the secret cannot be written to standard output.\n";
    return kFailed;
}

}  // namespace tunewright::server
