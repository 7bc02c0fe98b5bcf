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

class BodySource;
class BodyStream;

/// Compares header names without regard to case.
struct CaseInsensitive {
    using is_transparent = void;
    bool operator()(std::string_view a, std::string_view b) const;
};

struct Request {
    std::string method;
    std::string target;                 ///< as sent: path and query, percent-encoded
    std::vector<std::string> segments;  ///< of the path, decoded one by one: an encoded slash stays inside its segment
    std::multimap<std::string, std::string> query;
    std::multimap<std::string, std::string, CaseInsensitive> headers;
    std::string body;
    std::shared_ptr<BodySource> source;  ///< of a call that reads its body as it arrives; `body` is then empty
    std::string remote_addr;
    std::string client;  ///< whom it counts for where clients share something: the key's name, else the address
    std::optional<std::string> owner;  ///< name of the API key; nothing where none is asked for: everybody sees all
    std::string request_id;            ///< names this request in answers and logs
    std::vector<std::pair<std::string, std::string>> answer_headers;  ///< every answer to this request carries them

    /// The first header of that name; "" if there is none.
    std::string_view header(std::string_view name) const;

    bool has_header(std::string_view name) const { return headers.contains(name); }

    /// The path without the query, as sent.
    std::string_view path() const;
};

struct Response {
    int status = 200;
    std::vector<std::pair<std::string, std::string>> headers;  ///< one whose value has a control character is left out
    std::string body;
    std::shared_ptr<BodyStream> stream;  ///< instead of `body`: sent as it is written
    bool close = false;                  ///< close the connection after this answer
    bool body_omitted = false;           ///< answer to HEAD: Content-Length is sent, the body is not

    Response& set(std::string name, std::string value);
};

/// Gives the answer to one request, once, from any thread, now or later. Calling it again, or after the client has
/// gone, does nothing.
using Reply = std::function<void(Response)>;

/// Takes a complete request. Runs on the thread of the event loop: whatever takes longer than some tens of
/// microseconds goes elsewhere and replies from there.
using Handler = std::function<void(Request, Reply)>;

/// "Not Found" for 404 and so on.
std::string_view reason_phrase(int status);

/// How the client learns where a body ends.
enum class Framing { length, chunked, until_close };

/// Status line, headers and the blank line of a response, ready to be sent.
std::string render_head(const Response& response, bool keep_alive, Framing framing = Framing::length);

/// 200 with a JSON body.
Response json_response(std::string body, int status = 200);

}  // namespace tunewright::server::http
