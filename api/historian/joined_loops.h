// Loops of several files: files that have the same tag hold parts of one loop, and files of one tag each make a loop.
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "api/historian/loops_reader.h"

namespace tunewright::api {

/// add() for each file, then finish(), then next() until it returns false.
class JoinedLoops {
public:
    /// `seconds_per_unit`: of the times of all loops; 0 if it is not known.
    explicit JoinedLoops(double seconds_per_unit) : seconds_(seconds_per_unit) {}

    /// Takes the loops of a file whose last line has been read. Parts of one loop are joined by their dates; without
    /// dates in both files, or if one part cannot be read, that is the loop's fault and names the files.
    void add(const std::string& file, LoopsReader& reader);

    /// Takes a file that cannot be read: if it is not the only one, as a loop with that fault and the name of the file.
    void add_unreadable(const std::string& file, Problem problem);

    /// Values and times that are kept.
    std::size_t numbers() const { return numbers_; }

    /// 422 if there is no loop at all, or if the only file cannot be read.
    std::optional<Problem> finish();

    /// The loops in the order of their tags, each in the order of time. False after the last one.
    bool next(TaggedLoop& loop);

    /// Findings about the files; after finish().
    std::vector<std::string> notes() const;

private:
    struct Part {
        std::string file;  ///< the first one with this loop or tag
        TaggedLoop loop;
        int files = 1;  ///< that hold a part of it
    };
    using Parts = std::map<std::string, Part>;  ///< by tag in lower case

    void add(Parts& parts, const std::string& file, TaggedLoop loop);
    void join(Part& part, const std::string& file, TaggedLoop loop);
    void join_tags_of_files();

    double seconds_;
    std::size_t numbers_ = 0, files_ = 0;
    Parts parts_, tags_;
    std::optional<Problem> unreadable_;                       ///< of the last file that cannot be read
    std::vector<std::pair<std::string, std::string>> notes_;  ///< with their files; "": of all of them
};

}  // namespace tunewright::api
