// The framing of a request: where its head ends, how long its body is, and whether it may be trusted at all. Strict on
// purpose, and before any other parser sees a byte: what two parsers could read differently is refused.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace tunewright::server::http {

inline constexpr std::size_t kMaxHeadBytes = 16 * 1024;
inline constexpr std::size_t kMaxLineBytes = 8000;  ///< below the parsing library's own 8192
inline constexpr std::size_t kMaxHeaders = 100;

struct Head {
    enum class State { incomplete, complete, refused };
    State state = State::incomplete;
    int status = 0;      ///< of refused
    std::string detail;  ///< of refused: a sentence for the client

    std::size_t size = 0;  ///< bytes up to and with the blank line
    std::size_t content_length = 0;
    bool keep_alive = true;
    bool expects_continue = false;
    std::string clean;  ///< the head as the parsing library gets it: without the fields that it would act upon itself
};

/// Reads the head at the start of `input`. Refused are: more than 16 KiB or 100 fields (431), a target over 8,000 bytes
/// (414), a body over `body_limit` (413), another version than 1.0 and 1.1 (505), any Transfer-Encoding (411),
/// a Content-Encoding (415), and as malformed (400) bare line feeds, folded lines, spaces before a colon, control
/// characters, a missing or double Host, and a Content-Length that is repeated or not a number.
Head read_head(std::string_view input, std::size_t body_limit);

}  // namespace tunewright::server::http
