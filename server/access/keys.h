// The API keys of a service: a file with one line for each, "NAME sha256:DIGEST" or "NAME sha256:DIGEST admin" for
// somebody who runs the service and may see and act on everybody's jobs. Only digests are kept, so whoever reads the
// file cannot call. A key has 256 random bits; guessing one is out of reach, so one fast digest is enough.
#pragma once

#include <chrono>
#include <filesystem>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

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

bool is_key_name(std::string_view name);

/// `tunewright key NAME`: a new API key.
struct KeyCommand {
    std::string name;
    std::string file;  ///< "": the line for such a file goes to standard error
    bool admin = false;
};

/// Prints the key, which is kept nowhere, and adds its digest to the file. A new file is readable by its owner alone.
/// Returns the exit code of the process: 0; 1 where the file cannot be written; 2 for a name that is not allowed.
int make_key(const KeyCommand& command);

/// The keys that are in force. The file is looked at once a second at most, and read again when it has changed.
///
/// - A file without a key admits nobody.
/// - A file that is gone or cannot be read admits nobody, and usable() is false: a revoked key never comes back because
///   of a fault.
/// - A file with a line that is no key's is perhaps being written: the last good keys stay in force for kPatience, then
///   it admits nobody and usable() is false.
class KeyRing {
public:
    static constexpr std::chrono::seconds kPatience{10};
    using Clock = std::chrono::steady_clock;

    /// Reads the file. Throws std::invalid_argument with a sentence where it cannot be read or has no key.
    explicit KeyRing(std::string path, std::function<Clock::time_point()> now = Clock::now);

    /// Whose key that is; nothing for one that is not known. The time that this takes depends on the digest alone,
    /// of which nobody can choose a part.
    std::optional<KeyHolder> holder_of(std::string_view key);

    /// Whether the file could be used when it was last looked at, which is now if that was a second ago.
    bool usable();

private:
    /// What tells one state of the file from another.
    struct Stamp {
        std::filesystem::file_time_type modified;
        std::uintmax_t size = 0;
        bool operator==(const Stamp&) const = default;
    };

    static std::optional<Stamp> stamp_of(const std::string& path);
    void look();
    void read_again(const std::optional<Stamp>& stamp);
    void admit_nobody(const std::string& why);

    std::string path_;
    std::function<Clock::time_point()> now_;
    std::mutex mutex_;
    std::unordered_map<std::string, KeyHolder> holders_;  ///< by digest
    std::optional<Stamp> stamp_;                          ///< of what was read last; empty: nothing could be
    Clock::time_point looked_;
    std::optional<Clock::time_point> broken_since_;  ///< a line that is no key's, the last good keys still in force
    bool usable_ = true;
};

}  // namespace tunewright::server
