// A request and its answer, independent of the HTTP library: the interface of the handlers.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace tunewright::server::http {

/// Compares header names without regard to case.
struct CaseInsensitive {
    using is_transparent = void;
    bool operator()(std::string_view a, std::string_view b) const;
};

/// The destination of an answer's body while it is produced.
class BodyWriter {
public:
    virtual ~BodyWriter() = default;
    /// Returns when the client or its socket has taken the piece; false if the client has disconnected, or reads
    /// nothing for too long: nothing more is sent then.
    virtual bool write(std::string_view piece) = 0;
    /// True if the client has disconnected.
    virtual bool gone() const = 0;
    /// Announces this number of bytes: they count as held for the client until the next call. Waits, if clients hold
    /// too much, until some have given way.
    virtual void hold(std::size_t bytes) = 0;
};

/// Writes a whole body; false if it stops early, which the client notices, because the body then lacks its end.
using BodyProducer = std::function<bool(BodyWriter&)>;

/// Takes the next piece of a body; false if no more is wanted.
using BodyTaker = std::function<bool(std::string_view)>;

struct Request {
    std::string method;
    std::string target;                 ///< as sent: path and query, percent-encoded
    std::vector<std::string> segments;  ///< of the path, decoded one by one: an encoded slash stays inside its segment
    std::multimap<std::string, std::string> query;
    std::multimap<std::string, std::string, CaseInsensitive> headers;
    std::string body;
    /// For a call that reads its body as it arrives (`body` is then empty): delivers piece after piece; false if the
    /// body is incomplete (too large, malformed, too slow, or the client has disconnected): the transport then answers.
    std::function<bool(const BodyTaker&)> read_body;
    /// Reduces the room that is reserved for the request to this number of bytes; it is released with the last copy of
    /// this function. May be empty.
    std::function<void(std::size_t bytes)> keep;
    std::function<bool()> left;      ///< true if the client has disconnected and nobody waits for the answer; may be
                                     ///< empty
    std::function<bool()> admitted;  ///< false if the caller's key has been removed; may be empty
    std::string remote_addr;
    std::string client;                ///< the client to which shared limits apply: the key's name, else the address
    std::optional<std::string> owner;  ///< name of the API key; empty if no keys are required: everybody sees all jobs
    bool admin = false;                ///< of an administrator, who may change everybody's jobs and the queue
    std::string request_id;            ///< identifies this request in answers and logs
    std::string traceparent;           ///< W3C trace context as received; "" if there is none or it is not valid
    std::vector<std::pair<std::string, std::string>> answer_headers;  ///< headers of every answer to this request

    /// The first header of that name; "" if there is none.
    std::string_view header(std::string_view name) const;

    bool has_header(std::string_view name) const { return headers.contains(name); }
    /// True if the head announces a body.
    bool has_body() const;

    /// The path without the query, as sent.
    std::string_view path() const;
};

/// The text without `blanks` at both ends.
std::string_view trim(std::string_view text, std::string_view blanks = " \t");

/// "/v1/jobs" -> {"v1", "jobs"}; "/" -> {}; "/v1/" -> {"v1", ""}. Percent codes are decoded in each segment separately.
std::vector<std::string> path_segments(std::string_view path);

struct Response {
    int status = 200;
    std::vector<std::pair<std::string, std::string>> headers;  ///< a header whose value has a control character is left
                                                               ///< out
    std::string body;
    BodyProducer stream;         ///< instead of `body`: sent as it is written
    bool close = false;          ///< close the connection after this answer
    std::shared_ptr<void> turn;  ///< the turn in which it is made; released when the body counts as unsent

    Response& set(std::string name, std::string value);
};

/// "Not Found" for 404 and so on.
std::string_view reason_phrase(int status);

/// 200 with a JSON body.
Response json_response(std::string body, int status = 200);

}  // namespace tunewright::server::http
