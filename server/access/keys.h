// The API keys of a service: a file with one line for each, "NAME sha256:DIGEST". Only digests are kept, so whoever
// reads the file cannot call. A key has 256 random bits; guessing one is out of reach, so one fast digest is enough.
#pragma once

#include <chrono>
#include <filesystem>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace tunewright::server {

struct KeyLine {
    std::string name;    ///< 1 to 64 of A-Z a-z 0-9 . _ -
    std::string digest;  ///< SHA-256 of the key, 64 hexadecimal digits
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
};

/// Prints the key, which is kept nowhere, and adds its digest to the file. A new file is readable by its owner alone.
/// Returns the exit code of the process: 0; 1 where the file cannot be written; 2 for a name that is not allowed.
int make_key(const KeyCommand& command);

class KeyRing {
public:
    /// Reads the file. Throws std::invalid_argument with a sentence where it cannot be read or used.
    explicit KeyRing(std::string path);

    /// The name of a key; nothing for one that is not known. Takes the same time wherever keys differ. A file that has
    /// changed is read again, at most once a second; while the new one cannot be used the old keys stay.
    std::optional<std::string> name_of(std::string_view key);

private:
    void reload_if_changed();

    std::string path_;
    std::mutex mutex_;
    std::vector<KeyLine> lines_;
    std::filesystem::file_time_type modified_;
    std::chrono::steady_clock::time_point looked_;
};

}  // namespace tunewright::server
