// The API keys of a service: a file with one line for each, "NAME sha256:DIGEST" or "NAME sha256:DIGEST admin" for an
// administrator, who may see and change all jobs. Only digests are stored, so a reader of the file cannot call. A key
// has 256 random bits and cannot be guessed, so one fast digest is enough.
#pragma once

#include <chrono>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "server/access/watched_file.h"

namespace tunewright::server {

struct KeyLine {
    std::string name;    ///< 1 to 64 of A-Z a-z 0-9 . _ -
    std::string digest;  ///< SHA-256 of the key, 64 hexadecimal digits
    bool admin = false;
};

/// The holder of a key.
struct KeyHolder {
    std::string name;
    bool admin = false;
    bool operator==(const KeyHolder&) const = default;
};

/// The lines of a file of keys; blank ones and those that start with # are skipped. Several keys may have one name, so
/// that a key can be replaced without an interruption. Throws std::invalid_argument with the line's number and the
/// rule.
std::vector<KeyLine> parse_keys(std::string_view text);

/// "tw_" and 256 random bits as 64 hexadecimal digits.
std::string new_key();

/// Options of `tunewright key NAME`, which makes a new API key.
struct KeyCommand {
    std::string name;
    std::string file;  ///< "": the line for the file is written to standard error
    bool admin = false;
    bool rotate = false;  ///< the name may already have a key, which stays valid
};

/// Prints the key, which is not stored anywhere, and adds its digest to the file. A new file is readable by its owner
/// only. Returns the exit code of the process: 0; 1 if the file cannot be written; 2 for a name that is not allowed, or
/// that has a key although `rotate` is false.
int make_key(const KeyCommand& command);

/// The valid keys, from a watched file: a file that cannot be used admits nobody, and usable() distinguishes it from a
/// file without keys.
class KeyRing {
public:
    static constexpr std::chrono::seconds kMaxBrokenTime = WatchedFile::kMaxBrokenTime;
    using Clock = WatchedFile::Clock;

    /// Reads the file. Throws std::invalid_argument with a sentence if it cannot be read or has no key.
    explicit KeyRing(const std::string& path, std::function<Clock::time_point()> now = Clock::now);

    /// The holder of the key; empty for an unknown key. The duration depends on the digest alone, which a caller cannot
    /// choose.
    std::optional<KeyHolder> holder_of(std::string_view key);

    /// True if the file could be used when it was last read; it is checked again if that was a second ago or more.
    bool usable();

private:
    WatchedFile::Meaning meaning();

    std::mutex mutex_;
    std::unordered_map<std::string, KeyHolder> holders_;  ///< by digest
    WatchedFile file_;
};

}  // namespace tunewright::server
