// A file of lines "NAME VALUE" that an operator edits while the service runs: keys, secrets. It is looked at once a
// second at most, and read again when it has changed.
//
// - A file that is gone or cannot be read holds nothing: what was taken out of it never comes back because of a fault.
// - A file with a line that cannot be read is perhaps being written: what it held last stays in force for
// kMaxBrokenTime,
//   then it holds nothing.
#pragma once

#include <sys/types.h>

#include <chrono>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace tunewright::server {

/// 1 to 64 of A-Z a-z 0-9 . _ -
bool is_key_name(std::string_view name);

struct NamedLine {
    std::size_t number = 0;  ///< from 1
    std::string_view name, value;
};

/// The text of such a file; nothing where it cannot be read or is longer than 16 MiB.
std::optional<std::string> text_of_lines(const std::string& path);

/// The lines of such a file but for blank ones and, from a # on, comments. What is no name is for the caller to see.
std::vector<NamedLine> named_lines(std::string_view text);

/// Appends the line in one write, so that who reads meanwhile sees it or not. A new file is readable by its owner
/// alone. False where that fails; errno says why.
bool append_line(const std::string& path, const std::string& line);

class WatchedFile {
public:
    static constexpr std::chrono::seconds kMaxBrokenTime{10};
    using Clock = std::chrono::steady_clock;

    struct Meaning {
        std::string what;                                        ///< for sentences: "file of keys"
        std::string consequence;                                 ///< of holding nothing: "nobody is admitted"
        std::string kind;                                        ///< of what stands in its lines: "key"
        std::string option;                                      ///< that names it: "--keys"
        std::function<std::size_t(std::string_view text)> take;  ///< how many; throws std::invalid_argument
        std::function<void()> forget;
    };

    /// Reads the file. Throws std::invalid_argument with a sentence where it cannot be read.
    WatchedFile(std::string path, Meaning meaning, std::function<Clock::time_point()> now);

    /// Looks at the file if that was not done in the last second. Not to be called by two threads at once.
    void look();
    /// Whether it could be used when it was last looked at.
    bool usable() const { return usable_; }
    const std::string& path() const { return path_; }

private:
    /// What tells one state of the file from another. A file that takes the place of another may have its size and the
    /// time of its last change, but not its number nor, where the number is given anew, the time that nobody sets.
    struct Stamp {
        dev_t device = 0;
        ino_t number = 0;
        off_t size = 0;
        std::int64_t modified = 0, changed = 0;  ///< ns
        bool operator==(const Stamp&) const = default;
    };

    static std::optional<Stamp> stamp_of(const std::string& path);
    void read_again(const std::optional<Stamp>& stamp);
    void hold_nothing(const std::string& why);

    std::string path_;
    Meaning meaning_;
    std::function<Clock::time_point()> now_;
    std::optional<Stamp> stamp_;  ///< of what was read last; empty: nothing could be
    Clock::time_point looked_;
    std::optional<Clock::time_point> broken_since_;  ///< a line that cannot be read, what was there before in force
    bool usable_ = true;
};

}  // namespace tunewright::server
