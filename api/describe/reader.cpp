#include "api/describe/reader.h"

#include <algorithm>

#include "api/json/json.h"
#include "api/json/utf8.h"

namespace tunewright::api {

void Reader::fault(std::string detail) {
    constexpr std::size_t kListed = 50;
    if (++count_ <= kListed) faults_.push_back({pointer(), std::move(detail)});
}

void Reader::fault_at(std::string_view name, std::string detail) {
    const At at(*this, name);
    fault(std::move(detail));
}

void Reader::fault_below(std::string_view where, int skipped, std::string detail) {
    const std::size_t slash = where.find('/');
    const std::string_view first = where.substr(0, slash), rest = slash == where.npos ? "" : where.substr(slash + 1);
    if (first.empty()) return fault(std::move(detail));
    if (skipped > 0) return fault_below(rest, skipped - 1, std::move(detail));
    const At at(*this, first);
    fault_below(rest, 0, std::move(detail));
}

bool Reader::clean_at(std::string_view name) const {
    const std::string place = pointer() + "/" + pointer_segment(name);
    return std::none_of(faults_.begin(), faults_.end(), [&](const FieldError& fault) {
        return fault.pointer == place || fault.pointer.starts_with(place + "/");
    });
}

std::string Reader::pointer() const {
    std::string out;
    for (const Segment& segment : path_) {
        out += '/';
        out += segment.name.empty() ? std::to_string(segment.index) : pointer_segment(segment.name);
    }
    return out;
}

std::string Reader::name() const {
    std::string indices;
    for (std::size_t i = path_.size(); i-- > 0;) {
        if (!path_[i].name.empty()) return std::string(path_[i].name) + indices;
        indices.insert(0, "[" + std::to_string(path_[i].index) + "]");
    }
    return indices.empty() ? "the request" : indices;
}

std::optional<Problem> Reader::problem() const {
    if (count_ == 0) return std::nullopt;
    Problem problem{422, "invalid-request", "The request is not valid", {}, faults_, {}};
    if (count_ == 1) {
        problem.detail = faults_.front().detail;
    } else {
        problem.detail =
            std::to_string(count_) + " values are not valid" +
            (count_ > faults_.size() ? ", the first " + std::to_string(faults_.size()) + " are listed" : "") +
            ". The first: " + faults_.front().detail;
    }
    return problem;
}

std::string shown(const Json& value) {
    constexpr std::size_t kLength = 40;
    if (value.is_structured() && value.size() > kLength) return value.is_array() ? "[...]" : "{...}";
    std::string text = value.dump(-1, ' ', false, Json::error_handler_t::replace);
    if (text.size() <= kLength) return text;
    return std::string(whole_characters(text, kLength)) + "...";
}

std::string kind_of(const Json& value) {
    switch (value.type()) {
        case Json::value_t::null: return "null";
        case Json::value_t::object: return "an object";
        case Json::value_t::array: return "an array";
        case Json::value_t::string: return "a string";
        case Json::value_t::boolean: return "a truth value";
        default: return "a number";
    }
}

}  // namespace tunewright::api
