#include "api/batch/jobs_array.h"

#include <algorithm>

#include "api/contract/terms.h"
#include "api/json/json.h"

namespace tunewright::api {
namespace {

constexpr std::size_t kDeepest = 1000;  // nested brackets that are distinguished; a request may have 32
constexpr std::size_t kMaxQuoteLength = 6 * kMaxNameLength;  // each character as a six-byte escape
constexpr std::string_view kCure = "Send {\"jobs\": [request, request, ...]}.";

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }

std::string shown_byte(char c) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte > 0x20 && byte < 0x7F) return std::string(1, c);
    static const char* kHex = "0123456789ABCDEF";
    return std::string("the byte 0x") + kHex[byte >> 4] + kHex[byte & 15];
}

/// Decodes the inside of a JSON string; empty if it is not valid.
std::optional<std::string> spelled(const std::string& inside) {
    const Json value = Json::parse("\"" + inside + "\"", nullptr, false);
    if (!value.is_string()) return std::nullopt;
    return value.get<std::string>();
}

}  // namespace

std::string JobsArray::place() const { return "line " + std::to_string(line_) + ", column " + std::to_string(column_); }

std::optional<Problem> JobsArray::unexpected(char c, const std::string& wanted) const {
    return not_json("The body is not JSON: " + shown_byte(c) + " stands at " + place() + " where " + wanted +
                    " should be.");
}

std::optional<Problem> JobsArray::feed(std::string_view bytes, std::vector<RawEntry>& entries) {
    static constexpr std::string_view kMark = "\xEF\xBB\xBF";
    for (std::size_t i = 0; i < bytes.size();) {
        const char c = bytes[i];
        if (bytes_ < kMark.size() && c == kMark[bytes_]) {
            ++bytes_, ++i;
            continue;
        }
        bytes_ = kMark.size();
        if (const std::size_t run = inside(bytes.substr(i)); run > 0) {
            i += run;
            continue;
        }
        ++column_;
        if (auto problem = step(c, entries)) return problem;
        if (c == '\n') {
            ++line_;
            column_ = 0;
        }
        ++i;
    }
    return std::nullopt;
}

// Keeps bytes inside a request that do not affect its structure in one piece. Returns their number.
std::size_t JobsArray::inside(std::string_view bytes) {
    if ((at_ != At::structure && at_ != At::quoted) || escaped_) return 0;
    const std::string_view structural = at_ == At::quoted ? "\"\\\n" : "{}[]\"\n";
    std::size_t run = 0;
    while (run < bytes.size() && structural.find(bytes[run]) == std::string_view::npos) ++run;
    keep(bytes.substr(0, run));
    column_ += static_cast<long>(run);
    return run;
}

void JobsArray::keep(std::string_view bytes) {
    entry_bytes_ += bytes.size();
    if (entry_bytes_ <= longest_) entry_.text += bytes;
}

std::optional<Problem> JobsArray::step(char c, std::vector<RawEntry>& entries) {
    const bool in_text = at_ == At::quoted || at_ == At::member_name || at_ == At::name_text;
    if (in_text && c == '\n')
        return not_json("The body is not JSON: line " + std::to_string(line_) +
                        " ends inside a text. A quote is missing, or a line break is not written as \\n.");
    if (at_ == At::word && (c == ',' || c == ']' || c == '}' || is_blank(c))) end_element(entries);
    const bool blank = !in_text && at_ != At::structure && is_blank(c);
    if (blank) return std::nullopt;

    switch (at_) {
        case At::start:
            if (c == '{') return at_ = At::first_member, std::nullopt;
            if (c == '[')
                return not_valid("", "The body is an array; the requests of a batch must be in the member jobs.  " +
                                         std::string(kCure));
            return unexpected(c, "{");
        case At::first_member:
        case At::member:
            if (c == '"') return text_.clear(), at_ = At::member_name, std::nullopt;
            if (c == '}' && at_ == At::first_member) return at_ = At::end, std::nullopt;
            return unexpected(c, "the quote of a member's name");
        case At::member_name: return c == '"' && !escaped_ ? end_member_name() : collect(c);
        case At::colon:
            if (c != ':') return unexpected(c, "a colon");
            at_ = text_ == "jobs" ? At::array : text_ == "name" ? At::name_value : At::notify_value;
            return std::nullopt;
        case At::name_value:
            if (c == 'n') return not_valid("/name", "name is not a string; leave it out if the batch has none.");
            if (c != '"') return not_valid("/name", "name is not a string; it must be one of at most 200 characters.");
            return text_.clear(), at_ = At::name_text, std::nullopt;
        case At::name_text: return c == '"' && !escaped_ ? end_name() : collect(c);
        case At::notify_value:
            if (c != '{')
                return not_valid("/notify",
                                 R"(notify must be an object such as {"url": "https://hooks.example.com/x"}.)");
            in_notify_ = true;
            return open_element(c);
        case At::array:
            if (c != '[') return not_valid("/jobs", "jobs must be an array of requests. " + std::string(kCure));
            return at_ = At::first_element, std::nullopt;
        case At::first_element:
            if (c == ']') return at_ = At::after_member, std::nullopt;
            return open_element(c);
        case At::element: return open_element(c);
        case At::structure: return bracket(c, entries);
        case At::quoted:
            keep({&c, 1});
            if (escaped_) return escaped_ = false, std::nullopt;
            if (c == '\\') escaped_ = true;
            if (c != '"') return std::nullopt;
            if (brackets_.empty())
                end_element(entries);
            else
                at_ = At::structure;
            return std::nullopt;
        case At::word: return keep({&c, 1}), std::nullopt;
        case At::after_element:
            if (c == ',') return at_ = At::element, std::nullopt;
            if (c == ']') return at_ = At::after_member, std::nullopt;
            return unexpected(c, "a comma or ]");
        case At::after_member:
            if (c == ',') return at_ = At::member, std::nullopt;
            if (c == '}') return at_ = At::end, std::nullopt;
            return unexpected(c, "a comma or }");
        case At::end: break;
    }
    return unexpected(c, "the end of the body");
}

std::optional<Problem> JobsArray::collect(char c) {
    escaped_ = !escaped_ && c == '\\';
    text_ += c;
    if (text_.size() <= kMaxQuoteLength) return std::nullopt;
    if (at_ == At::name_text) return not_valid("/name", "name is longer than 200 characters; give a shorter one.");
    return not_valid(
        "", "A member's name at " + place() + "is longer than that of any member of a batch. " + std::string(kCure));
}

std::optional<Problem> JobsArray::end_member_name() {
    const auto name = spelled(text_);
    if (!name) return not_json("The body is not JSON: the member's name at " + place() + " cannot be read.");
    if (*name != "jobs" && *name != "name" && *name != "notify") {
        return not_valid("", (name->size() > 40 ? "A long name" : *name) +
                                 " is not a member of a batch; known are jobs, name and notify. " + std::string(kCure) +
                                 " Send one request per line with Content-Type: application/x-ndjson.");
    }
    bool& found = *name == "jobs" ? found_jobs_ : *name == "name" ? found_name_ : found_notify_;
    if (found) return not_valid("/" + *name, *name + " is given twice. Remove one.");
    found = true;
    text_ = *name;
    at_ = At::colon;
    return std::nullopt;
}

std::optional<Problem> JobsArray::end_name() {
    const auto name = spelled(text_);
    if (!name) return not_json("The body is not JSON: the text that ends at " + place() + " cannot be read.");
    if (name->size() > kMaxNameLength)
        return not_valid("/name",
                         "name has " + std::to_string(name->size()) + " characters; at most 200 are accepted.");
    name_ = *name;
    at_ = At::after_member;
    return std::nullopt;
}

std::optional<Problem> JobsArray::open_element(char c) {
    if (c == ',' || c == ']' || c == '}' || c == ':') return unexpected(c, "a request");
    entry_.line = line_;
    keep({&c, 1});
    if (c == '{' || c == '[') {
        brackets_ = c == '{' ? "}" : "]";
        at_ = At::structure;
    } else {
        at_ = c == '"' ? At::quoted : At::word;
    }
    return std::nullopt;
}

std::optional<Problem> JobsArray::bracket(char c, std::vector<RawEntry>& entries) {
    keep({&c, 1});
    if (c == '"') {
        at_ = At::quoted;
    } else if (c == '{' || c == '[') {
        if (brackets_.size() >= kDeepest)
            return not_json("The body nests objects and arrays more than 1000 deep at " + place() + ".");
        brackets_ += c == '{' ? '}' : ']';
    } else if (c == '}' || c == ']') {
        if (brackets_.back() != c)
            return unexpected(c, std::string(1, brackets_.back()) + " (of the request that begins on line " +
                                     std::to_string(entry_.line) + ")");
        brackets_.pop_back();
        if (brackets_.empty()) end_element(entries);
    }
    return std::nullopt;
}

void JobsArray::end_element(std::vector<RawEntry>& entries) {
    if (in_notify_) {
        notify_ = entry_bytes_ > longest_ ? "{}" : std::move(entry_.text);
        entry_ = {};
        entry_bytes_ = 0;
        in_notify_ = false;
        at_ = At::after_member;
        return;
    }
    if (entry_bytes_ > longest_) entry_.fault = too_long(entry_bytes_, longest_);
    if (entry_.fault) entry_.text.clear();
    entries.push_back(std::move(entry_));
    entry_ = {};
    entry_bytes_ = 0;
    at_ = At::after_element;
}

std::optional<Problem> JobsArray::finish() const {
    if (at_ == At::end) {
        if (found_jobs_) return std::nullopt;
        return not_valid("/jobs", "jobs is missing. " + std::string(kCure));
    }
    if (at_ == At::start) return not_json("The body is empty. " + std::string(kCure));
    return not_json("The body is not JSON: it ends too early at " + place() + "; a bracket or quote is not closed.");
}

}  // namespace tunewright::api
