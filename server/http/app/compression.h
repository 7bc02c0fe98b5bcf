// gzip for answers. Level 1: on the tables of numbers that answers are made of, level 6 takes three times as long and
// saves a tenth more. What does not change is compressed once, at the start.
#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "server/http/message.h"

namespace tunewright::server::http {

/// Below this a body fits into a packet or two anyway.
inline constexpr std::size_t kWorthCompressing = 1024;

/// True where Accept-Encoding names gzip (or *) with a quality above 0 and not below that of identity.
bool accepts_gzip(const Request& request);

/// True for text: JSON, NDJSON, CSV, scripts, styles, SVG. False for event streams, which are never compressed: each
/// event has to arrive by itself, and secrets beside chosen text must not be guessed from sizes.
bool is_compressible(std::string_view media_type);

std::string gzip(std::string_view text, int level = 1);

/// Makes gzip of pieces, each of which can be read as soon as it has come.
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

/// Compresses the answer where its type and size are worth it and the client takes gzip; sets Vary wherever another
/// client could get another form. An entity tag becomes a weak one, as it stands for both forms; If-None-Match compares
/// weakly, so either form's tag gives 304.
void compress(Response& response, bool client_takes_gzip);

/// A text that never changes, in both forms.
class ConstantBody {
public:
    ConstantBody(std::string text, std::string media_type);

    /// 200 with the form that the client takes, or 304.
    Response respond(const Request& request) const;

private:
    std::string text_;
    std::string packed_;  ///< "": not worth it
    std::string media_type_;
    std::string tag_;
};

}  // namespace tunewright::server::http
