// The framing of a request: where its head ends, how long its body is, and whether it may be trusted at all. Strict on
// purpose, and before any other parser sees a byte: what two parsers could read differently is refused.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace tunewright::server::http {

inline constexpr std::size_t kMaxHeadBytes = 16 * 1024;
inline constexpr std::size_t kMaxLineBytes = 8000;  ///< below the library's own 8192
inline constexpr std::size_t kMaxHeaders = 100;

struct Head {
    enum class State { incomplete, complete, refused };
    enum class Transfer { length, chunked, unknown };
    State state = State::incomplete;
    int status = 0;      ///< of refused
    std::string detail;  ///< of refused: a sentence for the client

    std::size_t size = 0;  ///< bytes up to and with the blank line
    std::size_t content_length = 0;
    Transfer transfer = Transfer::length;  ///< unknown: a Transfer-Encoding other than one single `chunked`
    bool keep_alive = true;
    bool http_1_0 = false;
    bool expects_continue = false;
    std::vector<std::pair<std::string, std::string>> fields;  ///< as sent, in their order
    /// The head as the serving library gets it: the request line as of HTTP/1.1, and the length of the body. What else
    /// the library would act upon itself (ranges, codings, its own address fields) it never sees.
    std::string clean;
};

/// Whether read_head() may have something to say that it had not when only `from` bytes and three more were there.
bool may_be_read(std::string_view input, std::size_t from);

/// Reads the head at the start of `input`, where one empty line may stand before it. Refused are: more than 16 KiB or
/// 100 fields (431), a target over 8,000 bytes (414), another version than 1.0 and 1.1 (505), a Content-Encoding (415),
/// and as malformed (400) bare line feeds, folded lines, spaces before a colon, control characters, a missing or double
/// Host, a target that names another host, a Content-Length that is repeated or not a number, and a Content-Length
/// beside a Transfer-Encoding.
Head read_head(std::string_view input);

/// A refusal: status, and a sentence for the client.
Head refuse(int status, std::string detail);

/// Turns a complete head into a refusal where its body is not taken: over `limit` bytes (413); with a Transfer-Encoding
/// where bodies are not `streamed` (411); with one that is not just `chunked` where they are (400).
void refuse_body(Head& head, bool streamed, std::size_t limit);

}  // namespace tunewright::server::http
