// The secrets that sign what the service sends: a file with one line for each, "NAME whsec_BASE64", watched as the file
// of keys is. Two lines with the same name let a secret be changed without a moment in which neither works: both sign.
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

    /// Reads the file. Throws std::invalid_argument with a sentence where it cannot be read or has no secret.
    explicit Secrets(const std::string& path, std::function<Clock::time_point()> now = Clock::now);

    /// The bytes of the secrets of that name; "" stands for the name that comes first. None where there is none.
    std::vector<std::string> of(std::string_view name);

private:
    WatchedFile::Meaning meaning();

    std::mutex mutex_;
    std::vector<std::pair<std::string, std::string>> lines_;  ///< names and bytes
    WatchedFile file_;
};

/// `tunewright secret NAME`: a new secret, for the file and for the receiver.
struct SecretCommand {
    std::string name;
    std::string file;  ///< "": the line for such a file goes to standard error
};

/// Prints the secret and adds its line to the file. A new file is readable by its owner alone. Returns the exit code of
/// the process: 0; 1 where the file cannot be written; 2 for a name that is not allowed.
int make_secret(const SecretCommand& command);

}  // namespace tunewright::server
