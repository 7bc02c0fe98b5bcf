#include "api/json/json.h"

#include <algorithm>
#include <vector>

#include "api/json/writer.h"

namespace tunewright::api {
namespace {

Problem refused(std::string pointer, std::string detail) {
    Problem problem{422, "invalid-request", "The request is not valid", detail, {}, {}};
    problem.errors.push_back({std::move(pointer), std::move(detail)});
    return problem;
}

std::string place(std::string_view text, std::size_t position) {
    const std::string_view before = text.substr(0, std::min(position > 0 ? position - 1 : 0, text.size()));
    const auto line = 1 + std::count(before.begin(), before.end(), '\n');
    const std::size_t start = before.rfind('\n') == before.npos ? 0 : before.rfind('\n') + 1;
    return "line " + std::to_string(line) + ", column " + std::to_string(before.size() - start + 1);
}

// Builds the tree from the parser's events: the library's own builder keeps the last of two equal members silently.
class TreeBuilder : public nlohmann::json_sax<Json> {
public:
    explicit TreeBuilder(std::string_view text) : text_(text) {}

    bool null() override { return add(nullptr); }
    bool boolean(bool value) override { return add(value); }
    bool number_integer(number_integer_t value) override { return add(value); }
    bool number_unsigned(number_unsigned_t value) override { return add(value); }
    bool number_float(number_float_t value, const string_t&) override { return add(value); }
    bool string(string_t& value) override { return add(std::move(value)); }
    bool binary(binary_t&) override { return false; }
    bool start_object(std::size_t) override { return open(Json::object()); }
    bool start_array(std::size_t) override { return open(Json::array()); }
    bool end_object() override { return close(); }
    bool end_array() override { return close(); }

    bool key(string_t& name) override {
        Json& object = *stack_.back();
        if (object.contains(name)) {
            problem_ = refused(pointer() + "/" + pointer_segment(name),
                               name + " is given twice in the same object; only one value can hold. Remove one.");
            return false;
        }
        if (object.size() >= kMaxMembers) {
            problem_ = refused(pointer(), "The object has more than " + std::to_string(kMaxMembers) +
                                              " members; none of the contract needs so many.");
            return false;
        }
        names_.back() = name;
        return true;
    }

    bool parse_error(std::size_t position, const std::string& token,
                     const nlohmann::detail::exception& error) override {
        constexpr int kNumberOverflow = 406;
        if (error.id == kNumberOverflow) {
            problem_ = refused(pointer_of_next(), "The number " + token.substr(0, 40) +
                                                      " is too large; it must fit a double (up to 1.8e308).");
        } else if (text_.find_first_not_of(" \t\r\n") == text_.npos) {
            problem_ = not_json(
                "The body is empty; send a JSON object such as {\"plant\": {\"type\": \"fopdt\", \"K\": 2, \"T\": 10, "
                "\"L\": 3}}.");
        } else {
            problem_ = not_json("The body is not JSON: the text at " + place(text_, position) + " cannot be read" +
                                hint(position) + ".");
        }
        return false;
    }

    Json take() { return std::move(root_); }
    const std::optional<Problem>& problem() const { return problem_; }

private:
    // The spellings that other languages write and JSON does not have.
    std::string hint(std::size_t position) const {
        const std::size_t from = position > 12 ? position - 12 : 0;
        const std::string_view around = text_.substr(from, 24);
        for (const char* word : {"NaN", "Infinity", "nan", "inf"}) {
            if (around.find(word) != around.npos)
                return " (JSON has no NaN or Infinity: leave the field out or write a number)";
        }
        if (around.find('\'') != around.npos) return " (texts stand in double quotes)";
        if (position > text_.size()) return " (it ends too early: a bracket or quote is not closed)";
        if (around.find(",}") != around.npos || around.find(",]") != around.npos)
            return " (no comma after the last element)";
        return "";
    }

    Json* place_value(Json value) {
        if (stack_.empty()) {
            root_ = std::move(value);
            return &root_;
        }
        Json& parent = *stack_.back();
        if (parent.is_array()) {
            parent.push_back(std::move(value));
            return &parent.back();
        }
        // The name is known to be new: appending spares the library's search.
        auto& members = parent.get_ref<Json::object_t&>();
        members.Container::emplace_back(names_.back(), std::move(value));
        return &members.back().second;
    }

    template <class Value>
    bool add(Value&& value) {
        place_value(Json(std::forward<Value>(value)));
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

    // `placed` 1: the element that is open now is already the array's last.
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

std::variant<Json, Problem> parse(std::string_view text) {
    TreeBuilder builder(text);
    if (Json::sax_parse(text.begin(), text.end(), &builder)) return builder.take();
    return builder.problem().value_or(not_json("The body cannot be read as JSON."));
}

std::string compact(std::string_view text) {
    std::string out;
    out.reserve(text.size());
    bool inside = false;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const char c = text[i];
        if (inside) {
            out += c;
            if (c == '\\') out += text[++i];
            if (c == '"') inside = false;
        } else if (c != ' ' && c != '\t' && c != '\n' && c != '\r') {
            out += c;
            inside = c == '"';
        }
    }
    return out;
}

namespace {

/// The end of the string that begins at `at`.
std::size_t after_string(std::string_view json, std::size_t at) {
    for (++at; json[at] != '"'; ++at)
        if (json[at] == '\\') ++at;
    return at + 1;
}

/// Whether the bracket at `at` encloses another one. The next of any kind tells.
bool encloses(std::string_view json, std::size_t at) {
    for (++at; at < json.size();) {
        const char c = json[at];
        if (c == '"') {
            at = after_string(json, at);
            continue;
        }
        if (c == '{' || c == '[') return true;
        if (c == '}' || c == ']') return false;
        ++at;
    }
    return false;
}

}  // namespace

std::string indented(std::string_view text) {
    const std::string json = compact(text);
    std::string out;
    std::vector<bool> parted;  // of each open bracket: one line for each member
    const auto new_line = [&] { out.append("\n").append(2 * parted.size(), ' '); };
    for (std::size_t at = 0; at < json.size();) {
        const char c = json[at];
        if (c == '"') {
            const std::size_t end = after_string(json, at);
            out.append(json, at, end - at);
            at = end;
            continue;
        }
        const bool closes = c == '}' || c == ']';
        if (closes && !parted.empty()) {
            const bool lines = parted.back();
            parted.pop_back();
            if (lines) new_line();
        }
        out += c;
        if (c == '{' || c == '[') {
            parted.push_back(encloses(json, at));
            if (parted.back()) new_line();
        }
        if (c == ':') out += ' ';
        if (c == ',') parted.empty() || !parted.back() ? void(out += ' ') : new_line();
        ++at;
    }
    return out + "\n";
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

std::string_view whole_characters(std::string_view text, std::size_t bytes) {
    if (text.size() <= bytes) return text;
    while (bytes > 0 && (static_cast<unsigned char>(text[bytes]) & 0xC0) == 0x80) --bytes;
    return text.substr(0, bytes);
}

}  // namespace tunewright::api
