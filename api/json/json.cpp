#include "api/json/json.h"

#include <rapidjson/error/error.h>
#include <rapidjson/reader.h>
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <vector>

#include "api/json/utf8.h"
#include "api/json/writer.h"

namespace tunewright::api {
namespace {

void write_canonical(const Json& value, Writer& out) {
    if (value.is_object()) {
        std::vector<std::pair<std::string_view, const Json*>> members;
        for (const auto& [name, member] : value.items()) members.emplace_back(name, &member);
        std::sort(members.begin(), members.end());
        out.begin_object();
        for (const auto& [name, member] : members) {
            out.key(name);
            write_canonical(*member, out);
        }
        out.end_object();
    } else if (value.is_array()) {
        out.begin_array();
        for (const Json& element : value) write_canonical(element, out);
        out.end_array();
    } else if (value.is_number()) {
        out.number(value.get<double>());
    } else if (value.is_string()) {
        out.text(value.get_ref<const std::string&>());
    } else if (value.is_boolean()) {
        out.boolean(value.get<bool>());
    } else {
        out.null();
    }
}

}  // namespace

Problem not_json(std::string detail) { return {400, "not-json", "The body is not JSON", std::move(detail), {}, {}}; }

namespace {

constexpr bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }
constexpr bool opens(char c) { return c == '{' || c == '['; }
constexpr bool closes(char c) { return c == '}' || c == ']'; }
constexpr auto kEndsWord = [] {
    std::array<bool, 256> ends{};
    for (const unsigned char c : std::string_view("{}[],:\" \t\n\r")) ends[c] = true;
    return ends;
}();
constexpr bool ends_word(char c) { return kEndsWord[static_cast<unsigned char>(c)]; }

/// Bytes that a character outside of strings adds to a tree: measured sizes of an element, a member (without its name),
/// a container and a string of nlohmann::ordered_json, including spare capacity and the overhead of the system's
/// allocator.
constexpr auto kTreeBytes = [] {
    std::array<std::uint8_t, 256> bytes{};
    bytes[','] = bytes[':'] = 32;
    bytes['{'] = bytes['['] = bytes['"'] = 64;
    return bytes;
}();
constexpr std::size_t kMaxTreeBytes = std::ranges::max(kTreeBytes);

/// The end of the token that begins at `at`; undefined, but within the text, if it is not JSON.
std::size_t after_token(std::string_view json, std::size_t at) {
    if (json[at] == '"') {
        for (bool escaped = true; escaped;) {
            at = json.find('"', at + 1);
            if (at == json.npos) return json.size();
            escaped = (at - 1 - json.find_last_not_of('\\', at - 1)) % 2 == 1;
        }
        return at + 1;
    }
    if (ends_word(json[at])) return at + 1;
    while (at < json.size() && !ends_word(json[at])) ++at;
    return at;
}

std::size_t after_value(std::string_view json, std::size_t at) {
    int depth = 0;
    while (at < json.size()) {
        depth += opens(json[at]) ? 1 : closes(json[at]) ? -1 : 0;
        at = after_token(json, at);
        if (depth <= 0) break;
    }
    return at;
}

/// True if the bracket at `at` encloses another one. The next bracket of any kind decides.
bool encloses(std::string_view json, std::size_t at) {
    do at = after_token(json, at);
    while (at < json.size() && !opens(json[at]) && !closes(json[at]));
    return at < json.size() && opens(json[at]);
}

}  // namespace

std::string compact(std::string_view text) {
    std::string out;
    out.reserve(text.size());
    std::size_t passed = 0;
    for (std::size_t at = 0, end = 0; at < text.size(); at = end) {
        end = after_token(text, at);
        if (!is_blank(text[at])) continue;
        out.append(text, passed, at - passed);
        passed = end;
    }
    return out.append(text, passed);
}

std::string indented(std::string_view text) {
    const std::string json = compact(text);
    std::string out;
    std::vector<bool> parted;  // for each open bracket: one line for each member
    const auto new_line = [&] { out.append("\n").append(2 * parted.size(), ' '); };
    for (std::size_t at = 0, end = 0; at < json.size(); at = end) {
        const char c = json[at];
        end = after_token(json, at);
        if (closes(c) && !parted.empty()) {
            const bool lines = parted.back();
            parted.pop_back();
            if (lines) new_line();
        }
        out.append(json, at, end - at);
        if (opens(c)) {
            parted.push_back(encloses(json, at));
            if (parted.back()) new_line();
        }
        if (c == ':') out += ' ';
        if (c == ',') parted.empty() || !parted.back() ? void(out += ' ') : new_line();
    }
    return out + "\n";
}

std::string without_members(std::string_view json, std::initializer_list<std::string_view> names) {
    std::string out;
    out.reserve(json.size());
    std::size_t passed = 0;  // the end of the part that is in `out` or left out
    for (std::size_t at = 0, end = 0; at < json.size(); at = end) {
        end = after_token(json, at);
        const bool leaves = json[at] == '"' && end < json.size() && json[end] == ':' &&
                            std::ranges::find(names, json.substr(at + 1, end - at - 2)) != names.end();
        if (!leaves) continue;
        out.append(json, passed, at - passed);
        end = after_value(json, end + 1);
        // One of the commas on both sides is left out too.
        if (end < json.size() && json[end] == ',')
            ++end;
        else if (!out.empty() && out.back() == ',')
            out.pop_back();
        passed = end;
    }
    return out.append(json, std::min(passed, json.size()));
}

std::string canonical(const Json& value) {
    Writer out;
    write_canonical(value, out);
    return out.take();
}

std::string pointer_segment(std::string_view name) {
    std::string out;
    for (const char c : name) {
        if (c == '~')
            out += "~0";
        else if (c == '/')
            out += "~1";
        else
            out += c;
    }
    return out;
}

namespace {

Problem refused(std::string pointer, std::string detail) {
    Problem problem{422, "invalid-request", "The request is not valid", detail, {}, {}};
    problem.errors.push_back({std::move(pointer), std::move(detail)});
    return problem;
}

template <class Integer>
std::optional<Integer> whole_number(std::string_view token) {
    Integer value{};
    const auto [end, fault] = std::from_chars(token.data(), token.data() + token.size(), value);
    if (fault != std::errc{} || end != token.data() + token.size()) return std::nullopt;
    return value;
}

// Infinity for a number beyond double; one that is too small is 0, or the nearest double.
double nearest_double(std::string_view token) {
    double value = 0;
    const auto [end, fault] = std::from_chars(token.data(), token.data() + token.size(), value);
    if (fault == std::errc{}) return value;
    // from_chars does not report on which side a number leaves the range.
    return std::strtod(std::string(token).c_str(), nullptr);
}

std::string place(std::string_view text, std::size_t position) {
    const std::string_view before = text.substr(0, position);
    const auto line = 1 + std::count(before.begin(), before.end(), '\n');
    const std::size_t start = before.rfind('\n') == before.npos ? 0 : before.rfind('\n') + 1;
    return "line " + std::to_string(line) + ", column " + std::to_string(before.size() - start + 1);
}

// Builds the tree from the reader's events. The reader determines the names of the functions.
class TreeBuilder : public rapidjson::BaseReaderHandler<rapidjson::UTF8<>, TreeBuilder> {
public:
    explicit TreeBuilder(std::string_view text) : text_(text) {}

    bool Null() { return add(nullptr); }
    bool Bool(bool value) { return add(value); }
    bool String(const char* text, rapidjson::SizeType length, bool) {
        std::string value(text, length);
        return is_paired(value) && add(std::move(value));
    }
    bool StartObject() { return open(Json::object()); }
    bool StartArray() { return open(Json::array()); }
    bool EndObject(rapidjson::SizeType) { return close(); }
    bool EndArray(rapidjson::SizeType) { return close(); }

    bool RawNumber(const char* text, rapidjson::SizeType length, bool) {
        const std::string_view token(text, length);
        const auto real = [](char c) { return c == '.' || c == 'e' || c == 'E'; };
        if (std::none_of(token.begin(), token.end(), real)) {
            if (const auto whole = whole_number<std::uint64_t>(token)) return add(*whole);
            if (const auto whole = whole_number<std::int64_t>(token)) return add(*whole);
        }
        const double value = nearest_double(token);
        return std::isinf(value) ? too_large(token) : add(value);
    }

    bool Key(const char* text, rapidjson::SizeType length, bool) {
        const std::string name(text, length);
        if (!is_paired(name)) return false;
        Json& object = *stack_.back();
        if (object.contains(name)) {
            problem_ = refused(pointer() + "/" + pointer_segment(name),
                               name + " is given twice in the same object. Remove one.");
            return false;
        }
        if (object.size() >= kMaxMembers) {
            problem_ = refused(pointer(), "The object has more than " + std::to_string(kMaxMembers) +
                                              " members, more than any object of the contract needs.");
            return false;
        }
        names_.back() = name;
        return true;
    }

    void fault(rapidjson::ParseErrorCode code, std::size_t position) {
        if (code == rapidjson::kParseErrorTermination) return;  // the builder's own error, already reported
        if (code == rapidjson::kParseErrorNumberTooBig) {
            too_large(text_.substr(position, text_.find_first_of(" \t\r\n,]}", position) - position));
        } else if (code == rapidjson::kParseErrorDocumentEmpty && position == text_.size()) {
            problem_ = not_json(
                "The body is empty; send a JSON object such as {\"plant\": {\"type\": \"fopdt\", \"K\": 2, \"T\": 10, "
                "\"L\": 3}}.");
        } else {
            problem_ = not_json("The body is not JSON: the text at " + place(text_, position) + " cannot be read" +
                                hint(position) + ".");
        }
    }

    Json take() { return std::move(root_); }
    const std::optional<Problem>& problem() const { return problem_; }

private:
    bool too_large(std::string_view number) {
        problem_ = refused(pointer_of_next(), "The number " + std::string(number.substr(0, 40)) +
                                                  " is too large; it must fit a double (up to 1.8e308).");
        return false;
    }

    // The text is valid UTF-8: an invalid surrogate can only come from an escape. The reader refuses a high surrogate
    // alone and accepts a low one.
    bool is_paired(std::string_view value) {
        if (is_utf8(value)) return true;
        problem_ = not_json("The body is not JSON: a text has \\udc00 to \\udfff without the first half of the pair.");
        return false;
    }

    // A hint for spellings of other languages that JSON does not have.
    std::string hint(std::size_t position) const {
        const std::size_t from = position > 12 ? position - 12 : 0;
        const std::string_view around = text_.substr(from, 24);
        for (const char* word : {"NaN", "Infinity", "nan", "inf"}) {
            if (around.find(word) != around.npos)
                return " (JSON has no NaN or Infinity: leave the field out or write a number)";
        }
        if (around.find('\'') != around.npos) return " (a text must be in double quotes)";
        if (position >= text_.size()) return " (it ends too early: a bracket or quote is not closed)";
        if (around.find(",}") != around.npos || around.find(",]") != around.npos)
            return " (no comma after the last element)";
        return "";
    }

    template <class Value>
    Json* place_value(Value&& value) {
        if (stack_.empty()) {
            root_ = std::forward<Value>(value);
            return &root_;
        }
        Json& parent = *stack_.back();
        if (parent.is_array()) return &parent.get_ref<Json::array_t&>().emplace_back(std::forward<Value>(value));
        auto& members = parent.get_ref<Json::object_t&>();
        if (members.size() == members.capacity()) grow(members);
        // The name is known to be new: appending avoids the library's search.
        members.Container::emplace_back(names_.back(), std::forward<Value>(value));
        return &members.back().second;
    }

    // By itself the library copies all members: pairs with a constant name cannot be moved.
    static void grow(Json::object_t& members) {
        Json::object_t larger;
        larger.reserve(2 * members.size() + 1);
        for (auto& [name, member] : members) larger.Container::emplace_back(name, std::move(member));
        members.swap(larger);
    }

    template <class Value>
    bool add(Value&& value) {
        place_value(std::forward<Value>(value));
        return true;
    }

    bool open(Json container) {
        if (stack_.size() >= kMaxDepth) {
            problem_ = refused(pointer(), "Objects and arrays are nested more than " + std::to_string(kMaxDepth) +
                                              " deep; the contract needs 6.");
            return false;
        }
        stack_.push_back(place_value(std::move(container)));
        names_.emplace_back();
        return true;
    }

    bool close() {
        stack_.pop_back();
        names_.pop_back();
        return true;
    }

    std::string pointer() const {
        std::string path;
        for (std::size_t i = 0; i + 1 < stack_.size(); ++i) path += "/" + segment(i, 1);
        return path;
    }

    std::string pointer_of_next() const {
        return stack_.empty() ? "" : pointer() + "/" + segment(stack_.size() - 1, 0);
    }

    // `placed` 1: the element that is open is already the last of the array.
    std::string segment(std::size_t level, std::size_t placed) const {
        if (stack_[level]->is_array()) return std::to_string(stack_[level]->size() - placed);
        return pointer_segment(names_[level]);
    }

    std::string_view text_;
    Json root_;
    std::vector<Json*> stack_;
    std::vector<std::string> names_;
    std::optional<Problem> problem_;
};

}  // namespace

std::size_t tree_size(std::string_view text) {
    std::size_t size = 0;
    for (std::size_t at = 0, end = 0; at < text.size(); at = end) {
        end = text[at] == '"' ? after_token(text, at) : at + 1;
        size += kTreeBytes[static_cast<unsigned char>(text[at])] + (end - at - 1);
    }
    return size;
}

std::variant<Json, Problem> parse(std::string_view text) {
    constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
    if (text.starts_with(kByteOrderMark)) text.remove_prefix(kByteOrderMark.size());
    if (text.size() > kMaxTree / kMaxTreeBytes && tree_size(text) > kMaxTree)
        return Problem{413,
                       "too-large",
                       "The request is too large",
                       "The JSON has more values than one request may have (about two million numbers, or three "
                       "hundred thousand small objects). Send a record as CSV, or thin it out.",
                       {},
                       {}};
    TreeBuilder builder(text);
    // The reader's own check reads beyond the end of a text that ends within a character.
    if (const std::size_t valid = valid_utf8(text); valid < text.size()) {
        builder.fault(rapidjson::kParseErrorStringInvalidEncoding, valid);
        return *builder.problem();
    }
    // The reader takes a zero byte as the end of its text, and writes unescaped strings into the same memory.
    std::string copy(text);
    rapidjson::InsituStringStream stream(copy.data());
    rapidjson::Reader reader;
    constexpr unsigned kFlags = rapidjson::kParseInsituFlag | rapidjson::kParseNumbersAsStringsFlag;
    const rapidjson::ParseResult result = reader.Parse<kFlags>(stream, builder);
    if (result.IsError())
        builder.fault(result.Code(), result.Offset());
    else if (stream.Tell() < text.size())
        builder.fault(rapidjson::kParseErrorDocumentRootNotSingular, stream.Tell());
    if (builder.problem()) return *builder.problem();
    return builder.take();
}

}  // namespace tunewright::api
