// One file of recorded loops that arrives in pieces.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "api/batch/pieces.h"
#include "api/historian/loops_reader.h"

namespace tunewright::api {

class RecordedFile {
public:
    explicit RecordedFile(LoopsOptions options) : loops_(std::move(options)), lines_(Lines::Ends::any, kMaxLine) {}

    /// Reads the next bytes, cut anywhere. 422 if the file cannot be read; nothing may be read after that.
    std::optional<Problem> feed(std::string_view bytes);
    /// After the last bytes.
    std::optional<Problem> finish();

    /// The loops; after finish().
    LoopsReader& loops() { return loops_; }
    const std::vector<std::string>& notes() const { return loops_.notes(); }

private:
    static constexpr std::size_t kMaxLine = std::size_t{1} << 20;

    Lines::Take taker(std::optional<Problem>& problem);

    LoopsReader loops_;
    Lines lines_;
};

inline std::optional<Problem> RecordedFile::feed(std::string_view bytes) {
    std::optional<Problem> problem;
    lines_.feed(bytes, taker(problem));
    return problem;
}

inline std::optional<Problem> RecordedFile::finish() {
    std::optional<Problem> problem;
    lines_.finish(taker(problem));
    return problem ? problem : loops_.finish();
}

inline Lines::Take RecordedFile::taker(std::optional<Problem>& problem) {
    return [&](long number, std::string_view text, std::size_t bytes) {
        if (bytes > kMaxLine)
            problem = unreadable_loops("Line " + std::to_string(number) +
                                       " has more than 1 MiB. Send the file in parts, with fewer loops in each.");
        else
            problem = loops_.line(static_cast<int>(number), text);
        return !problem;
    };
}

}  // namespace tunewright::api
