// The parts of a multipart/form-data body (RFC 7578) that arrives in pieces: files with their names.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include "api/json/problem.h"

namespace tunewright::api {

/// The receiver of the parts. Each function may return a problem, and nothing follows then.
struct PartReceiver {
    /// `file`: the name of the file without folders; "" if none is given.
    std::function<std::optional<Problem>(const std::string& name, const std::string& file)> begin;
    std::function<std::optional<Problem>(std::string_view bytes)> bytes;
    std::function<std::optional<Problem>()> end;
};

class Multipart {
public:
    Multipart(std::string_view boundary, PartReceiver receiver);

    /// Reads the next bytes, cut anywhere. 400 if they are not of such a body.
    std::optional<Problem> feed(std::string_view bytes);
    /// 400 if the last boundary is missing.
    std::optional<Problem> finish();

private:
    enum class Place { before, headers, content, after };

    /// Reads what the buffer holds; true: more bytes are needed.
    bool step(std::optional<Problem>& problem);
    bool read_headers(std::optional<Problem>& problem);
    bool read_content(std::optional<Problem>& problem);

    std::string mark_;  ///< in front of each boundary and with it
    PartReceiver receiver_;
    std::string buffer_ = "\r\n";  // the first boundary may begin the body
    Place place_ = Place::before;
};

/// The boundary that a Content-Type names; "" if it names none.
std::string boundary_of(std::string_view content_type);

}  // namespace tunewright::api
