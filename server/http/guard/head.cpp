#include "server/http/guard/head.h"

#include <strings.h>

#include <algorithm>
#include <array>
#include <charconv>

#include "server/http/message.h"

namespace tunewright::server::http {
namespace {

constexpr std::string_view kLineEnd = "\r\n";

bool equals(std::string_view a, std::string_view b) {
    return a.size() == b.size() && strncasecmp(a.data(), b.data(), a.size()) == 0;
}

bool is_token_char(char c) {
    return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') ||
           std::string_view("!#$%&'*+-.^_`|~").find(c) != std::string_view::npos;
}

bool is_token(std::string_view text) { return !text.empty() && std::ranges::all_of(text, is_token_char); }

bool has_control(std::string_view text) {
    return std::ranges::any_of(text, [](unsigned char c) { return (c < 0x20 && c != '\t') || c == 0x7f; });
}

bool has_word(std::string_view list, std::string_view word) {
    while (!list.empty()) {
        const std::size_t comma = list.find(',');
        if (equals(trim(list.substr(0, comma)), word)) return true;
        if (comma == std::string_view::npos) break;
        list.remove_prefix(comma + 1);
    }
    return false;
}

/// The fields of one request that have been read so far.
struct Fields {
    int hosts = 0;
    int lengths = 0;
    int transfers = 0;
    std::size_t count = 0;
    std::string_view host;
    bool closes = false, keeps = false;
};

bool read_length(std::string_view value, std::size_t& length) {
    if (value.empty() || value.size() > 18) return false;
    const auto [end, error] = std::from_chars(value.data(), value.data() + value.size(), length);
    return error == std::errc{} && end == value.data() + value.size();
}

/// NAME, NAME:PORT, [V6] or [V6]:PORT, as far as the port goes.
bool is_authority(std::string_view value) {
    const std::size_t end = value.starts_with('[') ? value.find(']') : 0;
    if (end == std::string_view::npos) return false;
    const std::size_t colon = value.find(':', end);
    if (colon == std::string_view::npos) return true;
    const std::string_view port = value.substr(colon + 1);
    return port.size() <= 5 && std::ranges::all_of(port, [](char c) { return c >= '0' && c <= '9'; });
}

/// True if each % of the query is followed by two hexadecimal digits.
bool is_encoded(std::string_view target) {
    const auto hex = [](char c) { return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'f') || (c >= 'A' && c <= 'F'); };
    for (std::size_t at = target.find('?'); at < target.size(); ++at)
        if (target[at] == '%' && (at + 2 >= target.size() || !hex(target[at + 1]) || !hex(target[at + 2])))
            return false;
    return true;
}

/// True for the methods that the HTTP library accepts.
bool is_known(std::string_view method) {
    constexpr std::array<std::string_view, 9> known = {"GET",     "HEAD",    "POST",  "PUT",  "DELETE",
                                                       "CONNECT", "OPTIONS", "TRACE", "PATCH"};
    return std::ranges::find(known, method) != known.end();
}

/// False after filling `head` with a refusal.
bool take_field(std::string_view name, std::string_view value, Fields& seen, Head& head) {
    if (equals(name, "Host")) {
        seen.hosts++;
        seen.host = value;
        if (!is_authority(value)) {
            head = refuse(400, "The field Host must be NAME or NAME:PORT, the port a number.");
            return false;
        }
    } else if (equals(name, "Content-Length")) {
        if (++seen.lengths > 1 || !read_length(value, head.content_length)) {
            head = refuse(400, "Content-Length must be given once, as a whole number of bytes.");
            return false;
        }
    } else if (equals(name, "Transfer-Encoding")) {
        const bool plain = ++seen.transfers == 1 && equals(value, "chunked");
        head.transfer = plain ? Head::Transfer::chunked : Head::Transfer::unknown;
    } else if (equals(name, "Content-Encoding") && !equals(value, "identity")) {
        head = refuse(415, "Compressed bodies are not accepted; send the JSON text as it is.");
        return false;
    } else if (equals(name, "Connection")) {
        seen.closes = seen.closes || has_word(value, "close");
        seen.keeps = seen.keeps || has_word(value, "keep-alive");
    } else if (equals(name, "Expect")) {
        if (!equals(value, "100-continue")) {
            head = refuse(417, "The only supported expectation is 100-continue.");
            return false;
        }
        head.expects_continue = true;
    }
    return true;
}

/// The first line after parsing.
struct RequestLine {
    std::string_view method;
    std::string_view authority;  ///< of a target in absolute form, as sent to proxies (RFC 9112, section 3.2.2)
    std::string target;          ///< path and query
};

/// Removes scheme and authority; false if the rest is not a target.
bool split_target(std::string_view target, RequestLine& read) {
    for (const std::string_view scheme : {"http://", "https://"}) {
        if (!equals(target.substr(0, scheme.size()), scheme)) continue;
        target.remove_prefix(scheme.size());
        read.authority = target.substr(0, target.find_first_of("/?"));
        target.remove_prefix(read.authority.size());
        read.target = target.starts_with('/') ? "" : "/";
        read.target += target;
        return !read.authority.empty() && is_authority(read.authority);
    }
    read.target = target;
    return target.starts_with('/') || target == "*";
}

/// False after filling `head` with a refusal.
bool read_request_line(std::string_view line, RequestLine& read, Head& head) {
    const std::size_t first = line.find(' ');
    const std::size_t last = line.rfind(' ');
    if (first == std::string_view::npos || last <= first || !is_token(line.substr(0, first))) {
        head = refuse(400, "The first line must be METHOD TARGET HTTP/1.1.");
        return false;
    }
    const std::string_view target = line.substr(first + 1, last - first - 1);
    const std::string_view version = line.substr(last + 1);
    if (version != "HTTP/1.1" && version != "HTTP/1.0") {
        const bool is_http = version.substr(0, 5) == "HTTP/";
        head = is_http ? refuse(505, "This service supports HTTP/1.1 and HTTP/1.0.")
                       : refuse(400, "The first line must be METHOD TARGET HTTP/1.1.");
        return false;
    }
    const bool plain = std::ranges::all_of(target, [](unsigned char c) { return c > 0x20 && c < 0x7f; });
    if (!plain || !split_target(target, read)) {
        head = refuse(400, "The target must be an absolute path, or an http address, of printable ASCII characters.");
        return false;
    }
    if (!is_encoded(target)) {
        head = refuse(400, "The query has a % that is not followed by two hexadecimal digits; a plain % is %25.");
        return false;
    }
    read.method = line.substr(0, first);
    if (!is_known(read.method)) {
        head = refuse(501, "There is no such method here; /openapi.json lists all calls.");
        return false;
    }
    head.http_1_0 = version == "HTTP/1.0";
    return true;
}

/// The next line without its CRLF; false (and a refusal) if it has a control character.
bool next_line(std::string_view& rest, std::string_view& line, Head& head) {
    line = rest.substr(0, rest.find(kLineEnd));
    rest.remove_prefix(line.size() + kLineEnd.size());
    if (!has_control(line)) return true;
    head = refuse(400, "The head contains a control character.");
    return false;
}

/// False after filling `head` with a refusal.
bool read_fields(std::string_view rest, Fields& seen, Head& head) {
    for (std::string_view line; next_line(rest, line, head) && !line.empty();) {
        if (++seen.count > kMaxHeaders || line.size() > kMaxLineBytes) {
            head = refuse(431, "At most 100 header fields of at most 8,000 bytes each are accepted.");
            return false;
        }
        const std::size_t colon = line.find(':');
        if (colon == std::string_view::npos || !is_token(line.substr(0, colon))) {
            head = refuse(400, "A header field must be NAME: VALUE on one line, without a space before the colon.");
            return false;
        }
        const std::string_view name = line.substr(0, colon), value = trim(line.substr(colon + 1));
        if (!take_field(name, value, seen, head)) return false;
        head.fields.emplace_back(name, value);
    }
    return head.state != Head::State::refused;
}

}  // namespace

Head refuse(int status, std::string detail) {
    Head head;
    head.state = Head::State::refused;
    head.status = status;
    head.detail = std::move(detail);
    return head;
}

namespace {

bool has_bare_line_feed(std::string_view text, std::size_t from = 0) {
    for (std::size_t at = text.find('\n', from); at != std::string_view::npos; at = text.find('\n', at + 1))
        if (at == 0 || text[at - 1] != '\r') return true;
    return false;
}

Head read_strictly(std::string_view input) {
    // Some clients send an empty line after a body, beyond its length (RFC 9112, section 2.2).
    const std::size_t skipped = input.starts_with(kLineEnd) ? kLineEnd.size() : 0;
    input.remove_prefix(skipped);
    if (input.starts_with(kLineEnd)) return refuse(400, "The first line must be METHOD TARGET HTTP/1.1.");
    // Each of these limits applies at the same byte however the input is cut.
    if (std::min(input.find('\n'), input.size()) > kMaxLineBytes + 1)
        return refuse(414, "The request line may have at most 8,000 bytes.");
    const std::size_t end = input.find("\r\n\r\n");
    if (has_bare_line_feed(input.substr(0, end))) return refuse(400, "Each line of the head must end with CR LF.");
    if (end == std::string_view::npos || end + 4 > kMaxHeadBytes) {
        if (input.size() >= kMaxHeadBytes) return refuse(431, "The head of a request may have at most 16 KiB.");
        return {};
    }

    Head head;
    Fields seen;
    std::string_view rest = input.substr(0, end + 4);
    std::string_view line;
    if (!next_line(rest, line, head)) return head;
    if (line.size() > kMaxLineBytes) return refuse(414, "The request line may have at most 8,000 bytes.");
    RequestLine read;
    if (!read_request_line(line, read, head)) return head;
    head.clean.assign(read.method).append(" ").append(read.target).append(" HTTP/1.1\r\n");
    if (!read_fields(rest, seen, head)) return head;
    if (head.content_length > 0)
        head.clean.append("Content-Length: ").append(std::to_string(head.content_length)).append("\r\n");
    head.clean.append("\r\n");

    if (seen.hosts > 1 || (seen.hosts == 0 && !head.http_1_0)) return refuse(400, "Exactly one Host field is needed.");
    if (seen.hosts == 0 && !read.authority.empty()) head.fields.emplace_back("Host", read.authority);
    if (seen.hosts > 0 && !read.authority.empty() && !equals(read.authority, seen.host))
        return refuse(400, "The target names another host than the field Host.");
    if (seen.transfers > 0 && (seen.lengths > 0 || head.http_1_0))
        return refuse(400, "Transfer-Encoding is not possible with HTTP/1.0, or together with a Content-Length.");
    head.size = skipped + end + 4;
    head.keep_alive = !seen.closes && (!head.http_1_0 || seen.keeps);
    head.state = Head::State::complete;
    return head;
}

/// Reads the fields that the answer to a refused head needs, if they are readable.
void keep_names(std::string_view input, Head& head) {
    head.fields.clear();
    input = input.substr(0, std::min(input.find("\r\n\r\n"), kMaxHeadBytes));
    for (std::size_t end = input.find("\r\n"); end != std::string_view::npos; end = input.find("\r\n")) {
        input.remove_prefix(end + 2);
        const std::string_view line = input.substr(0, input.find("\r\n"));
        const std::size_t colon = std::min(line.find(':'), line.size());
        const std::string_view name = line.substr(0, colon);
        if (colon == line.size() || has_control(line) || (!equals(name, "Origin") && !equals(name, "X-Request-Id")))
            continue;
        head.fields.emplace_back(name, trim(line.substr(colon + 1)));
    }
}

}  // namespace

bool may_be_read(std::string_view input, std::size_t from) {
    return input.size() > kMaxLineBytes || input.find("\r\n\r\n", from) != std::string_view::npos ||
           has_bare_line_feed(input, from);
}

Head read_head(std::string_view input) {
    Head head = read_strictly(input);
    if (head.state == Head::State::refused) keep_names(input, head);
    return head;
}

void refuse_body(Head& head, bool streamed, std::size_t limit) {
    Head refused;
    if (head.transfer != Head::Transfer::length && !streamed)
        refused = refuse(411, "Transfer-Encoding is not accepted here; send the body with a Content-Length.");
    else if (head.transfer == Head::Transfer::unknown)
        refused = refuse(400, "The only accepted Transfer-Encoding is chunked, once.");
    else if (head.content_length > limit)
        refused = refuse(413, "The body has " + std::to_string(head.content_length) + " bytes; at most " +
                                  std::to_string(limit) + " are accepted.");
    else
        return;
    refused.content_length = head.content_length;
    refused.size = head.size;
    head = std::move(refused);
}

}  // namespace tunewright::server::http
