// The API keys of a service: a file with one line for each, "NAME sha256:DIGEST" or "NAME sha256:DIGEST admin" for
// somebody who runs the service and may see and act on everybody's jobs. Only digests are kept, so whoever reads the
// file cannot call. A key has 256 random bits; guessing one is out of reach, so one fast digest is enough.
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

/// Whom a key belongs to.
struct KeyHolder {
    std::string name;
    bool admin = false;
    bool operator==(const KeyHolder&) const = default;
};

/// The lines of a file of keys; blank ones and those that start with # are skipped. Several keys may have one name, so
/// that a key can be changed without a moment in which neither works.
/// Throws std::invalid_argument with the line's number and the rule.
std::vector<KeyLine> parse_keys(std::string_view text);

/// "tw_" and 256 random bits as 64 hexadecimal digits.
std::string new_key();

/// `tunewright key NAME`: a new API key.
struct KeyCommand {
    std::string name;
    std::string file;  ///< "": the line for such a file goes to standard error
    bool admin = false;
    bool rotate = false;  ///< the name may have a key already, which stays in force
};

/// Prints the key, which is kept nowhere, and adds its digest to the file. A new file is readable by its owner alone.
/// Returns the exit code of the process: 0; 1 where the file cannot be written; 2 for a name that is not allowed, or
/// that has a key while `rotate` is not asked for.
int make_key(const KeyCommand& command);

/// The keys that are in force, by a watched file: one that holds nothing admits nobody, and usable() tells the file
/// that has no key from the one that cannot be used.
class KeyRing {
public:
    static constexpr std::chrono::seconds kMaxBrokenTime = WatchedFile::kMaxBrokenTime;
    using Clock = WatchedFile::Clock;

    /// Reads the file. Throws std::invalid_argument with a sentence where it cannot be read or has no key.
    explicit KeyRing(const std::string& path, std::function<Clock::time_point()> now = Clock::now);

    /// Whose key that is; nothing for one that is not known. The time that this takes depends on the digest alone,
    /// of which nobody can choose a part.
    std::optional<KeyHolder> holder_of(std::string_view key);

    /// Whether the file could be used when it was last looked at, which is now if that was a second ago.
    bool usable();

private:
    WatchedFile::Meaning meaning();

    std::mutex mutex_;
    std::unordered_map<std::string, KeyHolder> holders_;  ///< by digest
    WatchedFile file_;
};

}  // namespace tunewright::server
