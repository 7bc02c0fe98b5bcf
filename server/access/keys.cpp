#include "server/access/keys.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <iostream>
#include <stdexcept>

#include "api/json/digest.h"
#include "server/http/message.h"
#include "server/log.h"
#include "server/random.h"

namespace tunewright::server {
namespace {

constexpr std::string_view kPrefix = "sha256:";
constexpr std::string_view kAdmin = "admin";

bool is_hex(char c) { return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'f'); }

KeyLine parse_line(const NamedLine& line) {
    const std::size_t blank = std::min(line.value.find_first_of(" \t"), line.value.size());
    const std::string_view value = line.value.substr(0, blank), role = http::trim(line.value.substr(blank));
    const std::string_view digest = value.starts_with(kPrefix) ? value.substr(kPrefix.size()) : "";
    const bool known = role.empty() || role == kAdmin;
    if (!is_key_name(line.name) || digest.size() != 64 || !std::ranges::all_of(digest, is_hex) || !known)
        throw std::invalid_argument("line " + std::to_string(line.number) +
                                    " must be NAME sha256:DIGEST, with admin after it for an administrator, as written "
                                    "by `tunewright key NAME`");
    return {std::string(line.name), std::string(digest), role == kAdmin};
}

std::unordered_map<std::string, KeyHolder> holders_by_digest(std::string_view text) {
    std::unordered_map<std::string, KeyHolder> holders;
    for (KeyLine& line : parse_keys(text))
        holders.insert_or_assign(std::move(line.digest), KeyHolder{std::move(line.name), line.admin});
    return holders;
}

constexpr int kFailed = 1;
constexpr int kBadName = 2;

bool has_key(const std::string& file, const std::string& name) {
    const auto text = text_of_lines(file);
    if (!text) return false;
    const auto lines = named_lines(*text);
    return std::any_of(lines.begin(), lines.end(), [&](const NamedLine& line) { return line.name == name; });
}

}  // namespace

std::vector<KeyLine> parse_keys(std::string_view text) {
    std::vector<KeyLine> lines;
    for (const NamedLine& line : named_lines(text)) lines.push_back(parse_line(line));
    return lines;
}

std::string new_key() { return "tw_" + random_hex(32); }

KeyRing::KeyRing(const std::string& path, std::function<Clock::time_point()> now)
    : file_(path, meaning(), std::move(now)) {
    if (holders_.empty())
        throw std::invalid_argument("The file of keys " + path +
                                    " cannot be used: it has no key; `tunewright key NAME --keys FILE` adds one.");
}

WatchedFile::Meaning KeyRing::meaning() {
    WatchedFile::Meaning made{"file of keys", "nobody is admitted", "key", "--keys", {}, {}};
    made.take = [this](std::string_view text) {
        holders_ = holders_by_digest(text);
        return holders_.size();
    };
    made.forget = [this] { holders_.clear(); };
    return made;
}

std::optional<KeyHolder> KeyRing::holder_of(std::string_view key) {
    const std::string digest = api::sha256_hex(key);
    const std::lock_guard lock(mutex_);
    file_.look();
    const auto found = holders_.find(digest);
    return found == holders_.end() ? std::nullopt : std::optional(found->second);
}

bool KeyRing::usable() {
    const std::lock_guard lock(mutex_);
    file_.look();
    return file_.usable();
}

int make_key(const KeyCommand& command) {
    if (!is_key_name(command.name)) {
        std::cerr << "tunewright: the name must be 1 to 64 letters, digits, dots, underscores or hyphens.\n";
        return kBadName;
    }
    if (!command.rotate && has_key(command.file, command.name)) {
        std::cerr
            << "tunewright: " << command.name << " has a key in " << command.file
            << ". Use --rotate for a second one: both work until the old line is deleted. Or choose another name.\n";
        return kBadName;
    }
    const std::string key = new_key();
    const std::string line = command.name + " sha256:" + api::sha256_hex(key) + (command.admin ? " admin\n" : "\n");
    if (command.file.empty()) {
        std::cerr << "# For the file of keys:\n" << line;
    } else if (!append_line(command.file, line)) {
        std::cerr << "tunewright: cannot write to " << command.file << ": " << std::strerror(errno) << ".\n";
        return kFailed;
    }
    std::cout << key << std::endl;
    if (std::cout) return 0;
    std::cerr << "tunewright: the key cannot be written to standard output. Delete its line again"
              << (command.file.empty() ? "" : ", the last of " + command.file) << ", and make another.\n";
    return kFailed;
}

}  // namespace tunewright::server
