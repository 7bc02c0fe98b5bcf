// Loops of several files: files that have the same tag hold parts of one loop.
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "api/historian/loops_reader.h"

namespace tunewright::api {

class JoinedLoops {
public:
    /// `seconds_per_unit`: of the times of all loops; 0 if it is not known.
    explicit JoinedLoops(double seconds_per_unit) : seconds_(seconds_per_unit) {}

    /// Takes the loops of a file whose last line has been read. Parts of one loop are joined by their dates; without
    /// dates in both files, or if one part cannot be read, that is the loop's fault and names the files.
    void add(const std::string& file, LoopsReader& reader);

    /// Takes a file that cannot be read as a loop with that fault, under the name of the file.
    void add_unreadable(const std::string& file, std::string reason);

    /// Values and times that are kept.
    std::size_t numbers() const { return numbers_; }

    /// All loops in the order of their tags, each in the order of time.
    std::vector<TaggedLoop> take();

private:
    struct Part {
        std::string file;  ///< the first one with this loop
        TaggedLoop loop;
        bool joined = false;
    };

    void join(Part& part, const std::string& file, TaggedLoop loop);

    double seconds_;
    std::size_t numbers_ = 0;
    std::map<std::string, Part> parts_;  ///< by tag in lower case
};

}  // namespace tunewright::api
