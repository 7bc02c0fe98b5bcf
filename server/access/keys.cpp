#include "server/access/keys.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <iostream>
#include <iterator>
#include <stdexcept>

#include "api/json/digest.h"
#include "server/log.h"
#include "server/random.h"

namespace tunewright::server {
namespace {

constexpr std::size_t kMaxNameLength = 64;
constexpr std::string_view kPrefix = "sha256:";
constexpr std::string_view kAdmin = "admin";
constexpr std::chrono::seconds kLookInterval{1};

bool is_hex(char c) { return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'f'); }

std::string_view trim(std::string_view text) {
    constexpr std::string_view blanks = " \t\r";
    const std::size_t first = text.find_first_not_of(blanks);
    if (first == std::string_view::npos) return {};
    return text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

KeyLine parse_line(std::string_view line, std::size_t number) {
    const std::size_t blank = line.find_first_of(" \t");
    const std::string_view name = line.substr(0, blank);
    const std::string_view rest = blank == std::string_view::npos ? std::string_view{} : trim(line.substr(blank));
    const std::size_t second = std::min(rest.find_first_of(" \t"), rest.size());
    const std::string_view role = trim(rest.substr(second));
    const std::string_view digest =
        rest.starts_with(kPrefix) ? rest.substr(kPrefix.size(), second - kPrefix.size()) : std::string_view{};
    const bool known = role.empty() || role == kAdmin;
    if (!is_key_name(name) || digest.size() != 64 || !std::ranges::all_of(digest, is_hex) || !known)
        throw std::invalid_argument("line " + std::to_string(number) +
                                    " must be NAME sha256:DIGEST, with admin after it for whoever runs the service, as "
                                    "`tunewright key NAME` writes it");
    return {std::string(name), std::string(digest), role == kAdmin};
}

/// The text of the file; nothing where it cannot be read.
std::optional<std::string> read_file(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    if (!file) return std::nullopt;
    std::string text{std::istreambuf_iterator<char>(file), {}};
    if (file.bad()) return std::nullopt;
    return text;
}

std::unordered_map<std::string, KeyHolder> holders_by_digest(std::string_view text) {
    std::unordered_map<std::string, KeyHolder> holders;
    for (KeyLine& line : parse_keys(text))
        holders.insert_or_assign(std::move(line.digest), KeyHolder{std::move(line.name), line.admin});
    return holders;
}

constexpr int kFailed = 1;
constexpr int kBadName = 2;

/// Appended in one write, so that a service that reads meanwhile sees the line or not.
bool append(const std::string& path, const std::string& line) {
    const int fd = ::open(path.c_str(), O_WRONLY | O_APPEND | O_CREAT | O_CLOEXEC, 0600);
    if (fd < 0) return false;
    const bool written = ::write(fd, line.data(), line.size()) == static_cast<ssize_t>(line.size());
    return ::close(fd) == 0 && written;
}

}  // namespace

bool is_key_name(std::string_view name) {
    return !name.empty() && name.size() <= kMaxNameLength && std::ranges::all_of(name, [](char c) {
        return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '.' || c == '_' ||
               c == '-';
    });
}

std::vector<KeyLine> parse_keys(std::string_view text) {
    std::vector<KeyLine> lines;
    for (std::size_t number = 1; !text.empty(); number++) {
        const std::size_t end = text.find('\n');
        const std::string_view line = trim(text.substr(0, end));
        text = end == std::string_view::npos ? std::string_view{} : text.substr(end + 1);
        if (!line.empty() && line.front() != '#') lines.push_back(parse_line(line, number));
    }
    return lines;
}

std::string new_key() { return "tw_" + random_hex(32); }

KeyRing::KeyRing(std::string path, std::function<Clock::time_point()> now)
    : path_(std::move(path)), now_(std::move(now)), looked_(now_()) {
    const auto refuse = [&](const std::string& why) {
        throw std::invalid_argument("The file of keys " + path_ + " cannot be used: " + why + ".");
    };
    stamp_ = stamp_of(path_);
    const auto text = read_file(path_);
    if (!text) refuse("it cannot be read");
    try {
        holders_ = holders_by_digest(*text);
    } catch (const std::invalid_argument& error) {
        refuse(error.what());
    }
    if (holders_.empty()) refuse("it has no key; `tunewright key NAME --keys FILE` adds one");
}

std::optional<KeyRing::Stamp> KeyRing::stamp_of(const std::string& path) {
    std::error_code error;
    Stamp stamp{std::filesystem::last_write_time(path, error)};
    if (!error) stamp.size = std::filesystem::file_size(path, error);
    return error ? std::nullopt : std::optional(stamp);
}

void KeyRing::look() {
    const auto now = now_();
    if (now - looked_ < kLookInterval) return;
    looked_ = now;
    const auto stamp = stamp_of(path_);
    // What cannot be read may be readable again without having changed.
    if (!stamp || stamp != stamp_ || !usable_) read_again(stamp);
    if (broken_since_ && now - *broken_since_ >= kPatience)
        admit_nobody("it has had a line that is no key's for " + std::to_string(kPatience.count()) + " s");
}

void KeyRing::read_again(const std::optional<Stamp>& stamp) {
    stamp_ = stamp;
    const auto text = stamp ? read_file(path_) : std::nullopt;
    if (!text) return admit_nobody("it cannot be read");
    try {
        auto names = holders_by_digest(*text);
        log_info("the file of keys has changed: " + std::to_string(names.size()) + " keys");
        holders_ = std::move(names);
        usable_ = true;
        broken_since_.reset();
    } catch (const std::invalid_argument& fault) {
        if (!usable_) return;
        if (!broken_since_) broken_since_ = looked_;
        log_error(std::string("the file of keys has changed and is not used: ") + fault.what());
    }
}

void KeyRing::admit_nobody(const std::string& why) {
    if (usable_) log_error("nobody is admitted: the file of keys " + path_ + " cannot be used, " + why);
    holders_.clear();
    usable_ = false;
    broken_since_.reset();
}

std::optional<KeyHolder> KeyRing::holder_of(std::string_view key) {
    const std::string digest = api::sha256_hex(key);
    const std::lock_guard lock(mutex_);
    look();
    const auto found = holders_.find(digest);
    return found == holders_.end() ? std::nullopt : std::optional(found->second);
}

bool KeyRing::usable() {
    const std::lock_guard lock(mutex_);
    look();
    return usable_;
}

int make_key(const KeyCommand& command) {
    if (!is_key_name(command.name)) {
        std::cerr << "tunewright: the name must be 1 to 64 letters, digits, dots, underscores or hyphens.\n";
        return kBadName;
    }
    const std::string key = new_key();
    const std::string line = command.name + " sha256:" + api::sha256_hex(key) + (command.admin ? " admin\n" : "\n");
    if (command.file.empty()) {
        std::cerr << "# For the file of keys:\n" << line;
    } else if (!append(command.file, line)) {
        std::cerr << "tunewright: cannot write to " << command.file << ": " << std::strerror(errno) << ".\n";
        return kFailed;
    }
    std::cout << key << std::endl;
    return 0;
}

}  // namespace tunewright::server
