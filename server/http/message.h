// A request and its answer, free of any library's types: what the handlers see.
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

/// Where an answer's body goes while it is made.
class BodyWriter {
public:
    virtual ~BodyWriter() = default;
    /// Returns when the client or its socket has taken the piece; false where the client has gone, or takes nothing for
    /// too long: nothing more is sent then.
    virtual bool write(std::string_view piece) = 0;
    /// True where the client has gone.
    virtual bool gone() const = 0;
    /// So many bytes are about to be written: they count as held for the client until the next call. Waits where
    /// clients hold too much, until some have given way.
    virtual void hold(std::size_t bytes) = 0;
};

/// Writes a whole body; false where it is broken off, which the client sees, as the body then lacks its end.
using BodyProducer = std::function<bool(BodyWriter&)>;

/// Takes the next piece of a body; false where no more is wanted.
using BodyTaker = std::function<bool(std::string_view)>;

struct Request {
    std::string method;
    std::string target;                 ///< as sent: path and query, percent-encoded
    std::vector<std::string> segments;  ///< of the path, decoded one by one: an encoded slash stays inside its segment
    std::multimap<std::string, std::string> query;
    std::multimap<std::string, std::string, CaseInsensitive> headers;
    std::string body;
    /// Of a call that reads its body as it arrives (`body` is then empty): gives piece after piece; false where the
    /// body does not come to its end (too large, malformed, too slow, or the client has gone): the answer is then the
    /// transport's.
    std::function<bool(const BodyTaker&)> read_body;
    /// Of the room that is kept for the request so many bytes are still needed; it goes with the last copy of this. May
    /// be empty.
    std::function<void(std::size_t bytes)> keep;
    std::function<bool()> left;      ///< true where the client has gone and nobody waits for the answer; may be empty
    std::function<bool()> admitted;  ///< false where the caller's key is known no longer; may be empty
    std::string remote_addr;
    std::string client;  ///< whom it counts for where clients share something: the key's name, else the address
    std::optional<std::string> owner;  ///< name of the API key; nothing where none is asked for: everybody sees all
    bool admin = false;                ///< of whoever runs the service: acts on everybody's jobs and on the queue
    std::string request_id;            ///< names this request in answers and logs
    std::string traceparent;           ///< W3C trace context as it came; "" if none, or not well formed
    std::vector<std::pair<std::string, std::string>> answer_headers;  ///< every answer to this request carries them

    /// The first header of that name; "" if there is none.
    std::string_view header(std::string_view name) const;

    bool has_header(std::string_view name) const { return headers.contains(name); }
    /// True where the head announces a body.
    bool has_body() const;

    /// The path without the query, as sent.
    std::string_view path() const;
};

/// Without `blanks` at both ends.
std::string_view trim(std::string_view text, std::string_view blanks = " \t");

/// "/v1/jobs" -> {"v1", "jobs"}; "/" -> {}; "/v1/" -> {"v1", ""}. Percent codes are decoded in each segment by itself.
std::vector<std::string> path_segments(std::string_view path);

struct Response {
    int status = 200;
    std::vector<std::pair<std::string, std::string>> headers;  ///< one whose value has a control character is left out
    std::string body;
    BodyProducer stream;         ///< instead of `body`: sent as it is written
    bool close = false;          ///< close the connection after this answer
    std::shared_ptr<void> turn;  ///< to make it; goes when the body counts among those that clients have not taken

    Response& set(std::string name, std::string value);
};

/// "Not Found" for 404 and so on.
std::string_view reason_phrase(int status);

/// 200 with a JSON body.
Response json_response(std::string body, int status = 200);

}  // namespace tunewright::server::http
