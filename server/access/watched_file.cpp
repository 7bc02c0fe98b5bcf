#include "server/access/watched_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>

#include "server/http/message.h"
#include "server/log.h"

namespace tunewright::server {
namespace {

constexpr std::string_view kBlanks = " \t\r";                // the file may come from another operating system
constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";  // editors on Windows write it first
constexpr std::size_t kMaxNameLength = 64;
constexpr std::chrono::seconds kLookInterval{1};

}  // namespace

std::optional<std::string> text_of_lines(const std::string& path) {
    constexpr std::size_t kLongest = 16 << 20;
    std::error_code error;
    if (std::filesystem::is_directory(path, error)) return std::nullopt;
    std::ifstream file(path, std::ios::binary);
    if (!file) return std::nullopt;
    std::string text;
    // A device may be endless.
    for (std::istreambuf_iterator<char> at(file), end; at != end; ++at) {
        if (text.size() == kLongest) return std::nullopt;
        text += *at;
    }
    if (file.bad()) return std::nullopt;
    return text;
}

bool is_key_name(std::string_view name) {
    return !name.empty() && name.size() <= kMaxNameLength && std::ranges::all_of(name, [](char c) {
        return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '.' || c == '_' ||
               c == '-';
    });
}

std::vector<NamedLine> named_lines(std::string_view text) {
    std::vector<NamedLine> lines;
    if (text.starts_with(kByteOrderMark)) text.remove_prefix(kByteOrderMark.size());
    for (std::size_t number = 1; !text.empty(); number++) {
        const std::size_t end = text.find('\n');
        const std::string_view whole = text.substr(0, end);
        text = end == std::string_view::npos ? std::string_view{} : text.substr(end + 1);
        // Neither a name nor a value contains #.
        const std::string_view line = http::trim(whole.substr(0, whole.find('#')), kBlanks);
        if (line.empty()) continue;
        const std::size_t blank = line.find_first_of(" \t");
        const std::string_view rest =
            blank == std::string_view::npos ? std::string_view{} : http::trim(line.substr(blank), kBlanks);
        lines.push_back({number, line.substr(0, blank), rest});
    }
    return lines;
}

bool append_line(const std::string& path, const std::string& line) {
    const int fd = ::open(path.c_str(), O_WRONLY | O_APPEND | O_CREAT | O_CLOEXEC, 0600);
    if (fd < 0) return false;
    // An editor may have left the last line without its line end.
    char last = '\n';
    const int reading = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
    if (reading >= 0) {
        const off_t end = ::lseek(reading, 0, SEEK_END);
        if (end > 0 && ::pread(reading, &last, 1, end - 1) != 1) last = '\n';
        ::close(reading);
    }
    const std::string text = (last == '\n' ? "" : "\n") + line;
    const bool written = ::write(fd, text.data(), text.size()) == static_cast<ssize_t>(text.size());
    return ::close(fd) == 0 && written;
}

WatchedFile::WatchedFile(std::string path, Meaning meaning, std::function<Clock::time_point()> now)
    : path_(std::move(path)), meaning_(std::move(meaning)), now_(std::move(now)), looked_(now_()) {
    const auto refuse = [&](const std::string& why) {
        throw std::invalid_argument("The " + meaning_.what + " " + path_ + " cannot be used: " + why + ".");
    };
    stamp_ = stamp_of(path_);
    const auto text = text_of_lines(path_);
    if (std::error_code none; std::filesystem::is_directory(path_, none))
        refuse("it is a folder; " + meaning_.option + " names a file");
    if (!text) refuse("it cannot be read; " + meaning_.option + " names it");
    try {
        meaning_.take(*text);
    } catch (const std::invalid_argument& error) {
        refuse(error.what());
    }
}

std::optional<WatchedFile::Stamp> WatchedFile::stamp_of(const std::string& path) {
    struct stat state {};
    if (::stat(path.c_str(), &state) != 0) return std::nullopt;
    const auto nanoseconds = [](const timespec& time) { return time.tv_sec * 1'000'000'000LL + time.tv_nsec; };
    return Stamp{state.st_dev, state.st_ino, state.st_size, nanoseconds(state.st_mtim), nanoseconds(state.st_ctim)};
}

void WatchedFile::look() {
    const auto now = now_();
    if (now - looked_ < kLookInterval) return;
    looked_ = now;
    const auto stamp = stamp_of(path_);
    // A file that could not be read may be readable again without a change.
    if (!stamp || stamp != stamp_ || !usable_) read_again(stamp);
    if (broken_since_ && now - *broken_since_ >= kMaxBrokenTime)
        hold_nothing("for " + std::to_string(kMaxBrokenTime.count()) + " s it has contained a line that is not a " +
                     meaning_.kind);
}

void WatchedFile::read_again(const std::optional<Stamp>& stamp) {
    stamp_ = stamp;
    const auto text = stamp ? text_of_lines(path_) : std::nullopt;
    if (!text) return hold_nothing("it cannot be read");
    try {
        const std::size_t count = meaning_.take(*text);
        log_info("the " + meaning_.what + " has changed: " + std::to_string(count) + " " + meaning_.kind + "s");
        usable_ = true;
        broken_since_.reset();
    } catch (const std::invalid_argument& fault) {
        if (!usable_) return;
        if (!broken_since_) broken_since_ = looked_;
        log_error("the " + meaning_.what + " has changed and is not used: " + fault.what());
    }
}

void WatchedFile::hold_nothing(const std::string& why) {
    if (usable_) log_error(meaning_.consequence + ": the " + meaning_.what + " " + path_ + " cannot be used, " + why);
    meaning_.forget();
    usable_ = false;
    broken_since_.reset();
}

}  // namespace tunewright::server
