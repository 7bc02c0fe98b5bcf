// The pieces that the body of a batch is cut into while it arrives: lines of text in any usual encoding, and the raw
// requests in them.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include "api/json/problem.h"

namespace tunewright::api {

/// One request of a batch, cut out of the body.
struct RawEntry {
    long line = 0;                 ///< the line of the body, from 1, where it begins; 0: it is in many lines
    std::string text;              ///< a tuning request, unless `fault` is set
    std::optional<Problem> fault;  ///< why it is not a request, if that is known before it is parsed
    std::string name;              ///< name of a request with a fault or in many lines, if it is known
};

/// The fault of a request that has `bytes` bytes where `max` are accepted.
Problem too_long(std::size_t bytes, std::size_t max);

/// 422: a member of the batch that is not allowed.
Problem not_valid(std::string pointer, std::string detail);

/// Lines of a text that arrives piece by piece.
class Lines {
public:
    enum class Ends {
        newline,  ///< \n alone ends a line: JSON, in which \r is white space
        any,      ///< \n, \r\n and \r, as in exports
    };

    /// Receives a line: its number from 1, its text as UTF-8, and its length in bytes. A line of more than `longest`
    /// bytes comes with an empty text. The text is valid during the call; after the function returns false, no line
    /// follows.
    using Take = std::function<bool(long number, std::string_view text, std::size_t bytes)>;

    Lines(Ends ends, std::size_t longest) : ends_(ends), longest_(longest) {}

    /// Reads the next bytes; `take` gets each line that ends in them. A byte order mark at the start decides the
    /// encoding and is not part of the first line; with Ends::any, lines that are not valid UTF-8 are read as
    /// Windows-1252 (api/csv/text.h).
    bool feed(std::string_view bytes, const Take& take);
    /// Passes on the last line if it has no line end.
    bool finish(const Take& take);

private:
    enum class Code { unknown, bytes, utf16_little, utf16_big };

    bool feed_known(std::string_view bytes, const Take& take);
    bool feed_bytes(std::string_view bytes, const Take& take);
    void keep(std::string_view bytes);
    bool end_line(const Take& take);

    Ends ends_;
    std::size_t longest_;
    Code code_ = Code::unknown;
    std::string head_;  ///< the first bytes, until they show the encoding
    std::string line_;
    std::size_t bytes_ = 0;
    std::string half_;  ///< the first byte of a UTF-16 unit
    bool after_return_ = false;
    long number_ = 1;
};

}  // namespace tunewright::api
