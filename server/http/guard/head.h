// The framing of a request: the end of its head, the length of its body, and whether it is acceptable. Deliberately
// strict, and before any other parser sees a byte: input that two parsers could read differently is refused.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace tunewright::server::http {

inline constexpr std::size_t kMaxHeadBytes = 16 * 1024;
inline constexpr std::size_t kMaxLineBytes = 8000;  ///< below the library's own limit of 8192
inline constexpr std::size_t kMaxHeaders = 100;

struct Head {
    enum class State { incomplete, complete, refused };
    enum class Transfer { length, chunked, unknown };
    State state = State::incomplete;
    int status = 0;      ///< of refused
    std::string detail;  ///< of refused: a sentence for the client

    std::size_t size = 0;  ///< bytes including the blank line
    std::size_t content_length = 0;
    Transfer transfer = Transfer::length;  ///< unknown: a Transfer-Encoding other than one single `chunked`
    bool keep_alive = true;
    bool http_1_0 = false;
    bool expects_continue = false;
    std::vector<std::pair<std::string, std::string>> fields;  ///< as sent, in their order
    /// The head for the HTTP library: the request line as HTTP/1.1, and the length of the body. The library never sees
    /// other fields that it would act upon (ranges, codings, address fields).
    std::string clean;
};

/// True if read_head() may have a result now although it had none with the first `from` bytes and three more.
bool may_be_read(std::string_view input, std::size_t from);

/// Reads the head at the start of `input`, optionally after one empty line. It refuses: more than 16 KiB or 100 fields
/// (431), a target over 8,000 bytes (414), another version than 1.0 and 1.1 (505), a Content-Encoding (415), and as
/// malformed (400) bare line feeds, folded lines, spaces before a colon, control characters, a missing or double Host,
/// a target that names another host, a Content-Length that is repeated or not a number, and a Content-Length together
/// with a Transfer-Encoding.
Head read_head(std::string_view input);

/// A refusal: status, and a sentence for the client.
Head refuse(int status, std::string detail);

/// Turns a complete head into a refusal if its body is not acceptable: over `limit` bytes (413); with a
/// Transfer-Encoding if bodies are not `streamed` (411); with one other than `chunked` if they are (400).
void refuse_body(Head& head, bool streamed, std::size_t limit);

}  // namespace tunewright::server::http
