// The secrets that sign notifications: a file with one line for each, "NAME whsec_BASE64", watched like the file of
// keys. Two lines with the same name allow replacing a secret without an interruption: both sign.
#pragma once

#include <functional>
#include <mutex>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "server/access/watched_file.h"

namespace tunewright::server {

class Secrets {
public:
    using Clock = WatchedFile::Clock;

    /// Reads the file. Throws std::invalid_argument with a sentence if it cannot be read or has no secret.
    explicit Secrets(const std::string& path, std::function<Clock::time_point()> now = Clock::now);

    /// The bytes of the secrets of that name; "" stands for the first name of the file. Empty if there are none.
    std::vector<std::string> of(std::string_view name);

private:
    WatchedFile::Meaning meaning();

    std::mutex mutex_;
    std::vector<std::pair<std::string, std::string>> lines_;  ///< names and bytes
    WatchedFile file_;
};

/// Options of `tunewright secret NAME`, which makes a new secret for the file and for the receiver.
struct SecretCommand {
    std::string name;
    std::string file;  ///< "": the line for the file is written to standard error
};

/// Prints the secret and adds its line to the file. A new file is readable by its owner only. Returns the exit code of
/// the process: 0; 1 if the file cannot be written; 2 for a name that is not allowed.
int make_secret(const SecretCommand& command);

}  // namespace tunewright::server
