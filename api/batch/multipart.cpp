#include "api/batch/multipart.h"

#include <algorithm>
#include <utility>

#include "api/csv/cell.h"
#include "api/csv/text.h"

namespace tunewright::api {
namespace {

constexpr std::size_t kMaxHeaders = 8192;
constexpr std::string_view kLineEnd = "\r\n", kBlankLine = "\r\n\r\n";

Problem not_a_form(std::string detail) {
    return {400, "not-a-form", "The body is not multipart/form-data", std::move(detail), {}, {}};
}

/// The value of a parameter such as name="file"; "" if it is missing.
std::string parameter(std::string_view text, std::string_view name) {
    for (std::size_t at = text.find(';'); at < text.size();) {
        const std::size_t equals = text.find('=', at);
        if (equals == text.npos) return {};
        const bool found = lower_case(trimmed(text.substr(at + 1, equals - at - 1))) == name;
        std::string value;
        std::size_t i = equals + 1;
        if (text.substr(i).starts_with('"')) {
            for (++i; i < text.size() && text[i] != '"'; ++i) {
                // Browsers and curl escape a quote alone: a backslash may be part of a Windows path.
                if (text.substr(i).starts_with("\\\"")) ++i;
                value += text[i];
            }
            at = text.find(';', i);
        } else {
            at = text.find(';', i);
            value = std::string(trimmed(text.substr(i, at - i)));
        }
        if (found) return value;
    }
    return {};
}

std::string without_folders(std::string file) {
    const std::size_t slash = file.find_last_of("/\\");
    return slash == file.npos ? file : file.substr(slash + 1);
}

/// As UTF-8, in which it may become the tag of a loop.
std::string readable(const std::string& bytes) {
    std::string storage;
    return std::string(utf8_text(bytes, storage));
}

}  // namespace

std::string boundary_of(std::string_view content_type) { return parameter(content_type, "boundary"); }

Multipart::Multipart(std::string_view boundary, PartReceiver receiver)
    : mark_("\r\n--" + std::string(boundary)), receiver_(std::move(receiver)) {}

std::optional<Problem> Multipart::feed(std::string_view bytes) {
    std::optional<Problem> problem;
    if (place_ == Place::after) return problem;
    buffer_.append(bytes);
    while (!problem && place_ != Place::after && !step(problem)) continue;
    return problem;
}

std::optional<Problem> Multipart::finish() {
    if (place_ == Place::after) return std::nullopt;
    return not_a_form("The body does not end with its boundary; it is incomplete.");
}

bool Multipart::step(std::optional<Problem>& problem) {
    return place_ == Place::headers ? read_headers(problem) : read_content(problem);
}

bool Multipart::read_headers(std::optional<Problem>& problem) {
    // Behind the boundary: "--" at the end of the body, else the end of the line and the headers of the next part.
    if (buffer_.size() < 2) return true;
    if (buffer_.starts_with("--")) {
        place_ = Place::after;
        return false;
    }
    const std::size_t end = buffer_.find(kBlankLine);
    if (end == buffer_.npos || end > kMaxHeaders) {
        if (buffer_.size() > kMaxHeaders) problem = not_a_form("The headers of a part have more than 8192 bytes.");
        return true;
    }
    std::string name, file;
    for (std::size_t at = 0; at < end;) {
        const std::size_t stop = std::min(buffer_.find(kLineEnd, at), end);
        const std::string_view line = std::string_view(buffer_).substr(at, stop - at);
        if (lower_case(line.substr(0, line.find(':'))) == "content-disposition") {
            name = parameter(line, "name");
            file = without_folders(parameter(line, "filename"));
        }
        at = stop + kLineEnd.size();
    }
    buffer_.erase(0, end + kBlankLine.size());
    if (name.empty())
        problem = not_a_form("A part has no name (Content-Disposition: form-data; name=\"file\").");
    else
        problem = receiver_.begin(readable(name), readable(file));
    place_ = Place::content;
    return false;
}

bool Multipart::read_content(std::optional<Problem>& problem) {
    const std::size_t end = buffer_.find(mark_);
    const bool found = end != buffer_.npos;
    const std::size_t known = found ? end : buffer_.size() - std::min(buffer_.size(), mark_.size() - 1);
    if (place_ == Place::content && known > 0) problem = receiver_.bytes(std::string_view(buffer_).substr(0, known));
    if (!found) {
        buffer_.erase(0, known);
        return true;
    }
    buffer_.erase(0, end + mark_.size());
    if (place_ == Place::content && !problem) problem = receiver_.end();
    place_ = Place::headers;
    return false;
}

}  // namespace tunewright::api
