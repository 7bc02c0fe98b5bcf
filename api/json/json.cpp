#include "api/json/json.h"

#include <algorithm>
#include <vector>

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

}  // namespace tunewright::api
