// A file of lines "NAME VALUE" that an operator edits while the service runs: keys, secrets. It is checked at most once
// a second, and read again when it has changed.
//
// - A file that is missing or cannot be read counts as empty: an error never brings back an entry that was removed.
// - A file with a line that cannot be read may be half-written: its previous content stays valid for kMaxBrokenTime,
//   then it counts as empty.
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

/// True for 1 to 64 of A-Z a-z 0-9 . _ -
bool is_key_name(std::string_view name);

struct NamedLine {
    std::size_t number = 0;  ///< number of the line, from 1
    std::string_view name, value;
};

/// The text of such a file; empty if it cannot be read or is longer than 16 MiB.
std::optional<std::string> text_of_lines(const std::string& path);

/// The lines of such a file without blank ones and comments, which begin with #. The caller checks the names.
std::vector<NamedLine> named_lines(std::string_view text);

/// Appends the line in one write, so that a concurrent reader sees all of it or none. A new file is readable by its
/// owner only. False on failure; errno has the reason.
bool append_line(const std::string& path, const std::string& line);

class WatchedFile {
public:
    static constexpr std::chrono::seconds kMaxBrokenTime{10};
    using Clock = std::chrono::steady_clock;

    struct Meaning {
        std::string what;                                        ///< for sentences: "file of keys"
        std::string consequence;                                 ///< effect of an empty file: "nobody is admitted"
        std::string kind;                                        ///< the content of its lines: "key"
        std::string option;                                      ///< option that names the file: "--keys"
        std::function<std::size_t(std::string_view text)> take;  ///< returns the number of entries; throws
                                                                 ///< std::invalid_argument
        std::function<void()> forget;
    };

    /// Reads the file. Throws std::invalid_argument with a sentence if it cannot be read.
    WatchedFile(std::string path, Meaning meaning, std::function<Clock::time_point()> now);

    /// Checks the file unless that was done within the last second. Must not be called by two threads at once.
    void look();
    /// True if the file could be used at the last check.
    bool usable() const { return usable_; }
    const std::string& path() const { return path_; }

private:
    /// Identifies a state of the file. A file that replaces another may have the same size and time of modification,
    /// but not the same inode number or, if the number is reused, the time of status change, which cannot be set.
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
    std::optional<Stamp> stamp_;  ///< of the content that was read last; empty: it could not be read
    Clock::time_point looked_;
    std::optional<Clock::time_point> broken_since_;  ///< since when a line cannot be read and the previous content is
                                                     ///< valid
    bool usable_ = true;
};

}  // namespace tunewright::server
