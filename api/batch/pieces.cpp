#include "api/batch/pieces.h"

#include <algorithm>
#include <utility>

#include "api/csv/text.h"

namespace tunewright::api {
namespace {

constexpr std::string_view kLittle = "\xFF\xFE", kBig = "\xFE\xFF", kUtf8 = "\xEF\xBB\xBF";

}  // namespace

Problem too_long(std::size_t bytes, std::size_t max) {
    Problem problem{413, "too-large", "The request is too large", {}, {}, {}};
    problem.detail =
        "It has " + std::to_string(bytes) + " bytes; at most " + std::to_string(max) + " are accepted of one request.";
    return problem;
}

Problem not_valid(std::string pointer, std::string detail) {
    Problem problem{422, "invalid-request", "The batch is not valid", detail, {}, {}};
    problem.errors.push_back({std::move(pointer), std::move(detail)});
    return problem;
}

bool Lines::feed(std::string_view bytes, const Take& take) {
    if (code_ != Code::unknown) return feed_known(bytes, take);
    const std::size_t wanted = kUtf8.size() - std::min(kUtf8.size(), head_.size());
    head_ += bytes.substr(0, wanted);
    if (head_.size() < kUtf8.size()) return true;
    const std::string_view rest = bytes.substr(std::min(wanted, bytes.size()));
    std::string_view head = head_;
    code_ = head.starts_with(kLittle) ? Code::utf16_little : head.starts_with(kBig) ? Code::utf16_big : Code::bytes;
    head.remove_prefix(code_ != Code::bytes ? kLittle.size() : head == kUtf8 ? kUtf8.size() : 0);
    return feed_known(head, take) && feed_known(rest, take);
}

bool Lines::feed_known(std::string_view bytes, const Take& take) {
    if (code_ == Code::bytes) return feed_bytes(bytes, take);
    std::string joined;
    if (!half_.empty() || bytes.size() % 2 == 1) {
        joined = half_ + std::string(bytes);
        half_ = joined.size() % 2 == 1 ? joined.substr(joined.size() - 1) : "";
        joined.resize(joined.size() - half_.size());
        bytes = joined;
    }
    constexpr std::size_t kUnit = 2;
    const std::size_t low = code_ == Code::utf16_big ? 1 : 0;
    // The ASCII character of the unit at i; for any other one a code that ends no line.
    const auto character = [&](std::size_t i) { return bytes[i + 1 - low] == '\0' ? bytes[i + low] : '\x7F'; };
    std::size_t start = 0;
    for (std::size_t i = 0; i < bytes.size(); i += kUnit) {
        const char c = character(i);
        if (c != '\n' && (c != '\r' || ends_ == Ends::newline)) {
            after_return_ = false;
            continue;
        }
        const bool second = c == '\n' && after_return_;
        after_return_ = c == '\r';
        if (!second) {
            keep(bytes.substr(start, i - start));
            if (!end_line(take)) return false;
        }
        start = i + kUnit;
    }
    keep(bytes.substr(start));
    return true;
}

bool Lines::feed_bytes(std::string_view bytes, const Take& take) {
    while (!bytes.empty()) {
        if (std::exchange(after_return_, false) && bytes.front() == '\n') {
            bytes.remove_prefix(1);
            continue;
        }
        std::size_t end = std::min(bytes.find('\n'), bytes.size());
        if (ends_ == Ends::any) end = std::min(bytes.substr(0, end).find('\r'), end);
        keep(bytes.substr(0, end));
        if (end == bytes.size()) return true;
        after_return_ = bytes[end] == '\r';
        if (!end_line(take)) return false;
        bytes.remove_prefix(end + 1);
    }
    return true;
}

void Lines::keep(std::string_view bytes) {
    bytes_ += bytes.size();
    if (bytes_ <= longest_) line_ += bytes;
}

bool Lines::end_line(const Take& take) {
    std::string storage;
    std::string_view text = line_;
    if (bytes_ > longest_) {
        text = {};
    } else if (code_ != Code::bytes) {
        line_.insert(0, code_ == Code::utf16_little ? kLittle : kBig);
        text = utf8_text(line_, storage);
    } else if (ends_ == Ends::any) {
        text = utf8_text(line_, storage);
    }
    const bool more = take(number_++, text, bytes_);
    line_.clear();
    bytes_ = 0;
    return more;
}

bool Lines::finish(const Take& take) {
    if (code_ == Code::unknown) {
        code_ = Code::bytes;
        if (!feed_known(head_, take)) return false;
    }
    return bytes_ == 0 || end_line(take);
}

}  // namespace tunewright::api
