// gzip for answers. Level 1: for the tables of numbers in answers, level 6 takes three times as long and saves a
// further tenth. Constant texts are compressed once, at the start.
#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "server/http/message.h"

namespace tunewright::server::http {

/// A smaller body fits into a packet or two anyway.
inline constexpr std::size_t kWorthCompressing = 1024;

/// True if Accept-Encoding names gzip (or *) with a quality above 0 and not below that of identity.
bool accepts_gzip(const Request& request);

/// True for text: JSON, NDJSON, CSV, scripts, styles, SVG. False for event streams, which are never compressed: each
/// event must arrive by itself, and sizes must not reveal secrets next to text that a caller chooses.
bool is_compressible(std::string_view media_type);

std::string gzip(std::string_view text, int level = 1);

/// Compresses a text in pieces; the output of each piece can be read at once.
class GzipStream {
public:
    GzipStream();
    ~GzipStream();
    GzipStream(const GzipStream&) = delete;
    GzipStream& operator=(const GzipStream&) = delete;

    std::string piece(std::string_view text);
    std::string end();

private:
    struct State;
    std::string run(std::string_view text, int flush);
    std::unique_ptr<State> state_;
};

/// Compresses the answer if its type and size make that worthwhile and the client accepts gzip; sets Vary if another
/// client could get the other form. An entity tag becomes a weak one, since it is the same for both forms;
/// If-None-Match compares weakly, so the tag of either form gives 304.
void compress(Response& response, bool client_takes_gzip);

/// A constant text, in both forms.
class ConstantBody {
public:
    ConstantBody(std::string text, std::string media_type);

    /// 200 with the form that the client accepts, or 304.
    Response respond(const Request& request) const;

private:
    std::string text_;
    std::string packed_;  ///< "": not worthwhile
    std::string media_type_;
    std::string tag_;
};

}  // namespace tunewright::server::http
