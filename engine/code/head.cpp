#include <algorithm>
#include <cmath>

#include "engine/code/algorithm.h"
#include "engine/code/print.h"
#include "engine/number_text.h"

namespace tunewright::code {
namespace {

constexpr std::size_t kWidth = 96;          // of a line, marks of comments not counted
constexpr std::size_t kLongestValue = 300;  // characters of what the user has written

// One printable ASCII character for each; signs that units have are spelled.
std::string ascii(const std::string& text) {
    std::string out;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const auto c = static_cast<unsigned char>(text[i]);
        if (text.compare(i, 2, "\xC2\xB0") == 0) {
            out += "deg ";
        } else if (text.compare(i, 2, "\xC2\xB5") == 0 || text.compare(i, 2, "\xCE\xBC") == 0) {
            out += 'u';
        } else if (c >= 0xC0) {
            out += '_';
        } else if (c < 0x80) {
            out += c < ' ' || c == 0x7F ? ' ' : c == '\\' ? '/' : text[i];
        }
    }
    return out;
}

// No pair of characters that opens or ends a comment, or is one character in old C.
std::string safe(const std::string& text) {
    static constexpr const char* kPairs[] = {"*/", "/*", "(*", "*)", "??", "//"};
    std::string out;
    for (const char c : ascii(text)) {
        const bool pair = !out.empty() && std::any_of(std::begin(kPairs), std::end(kPairs), [&](const char* two) {
            return out.back() == two[0] && c == two[1];
        });
        if (pair) out += ' ';
        out += c;
    }
    return out;
}

// Words of `text`, in lines that begin with so many blanks from the second on.
void wrap(const std::string& text, std::size_t hanging, std::vector<std::string>& lines) {
    std::string line;
    std::size_t start = 0;
    while (start < text.size()) {
        const std::size_t end = std::min(text.find(' ', start), text.size());
        const std::string word = text.substr(start, end - start);
        if (!line.empty() && line.size() + 1 + word.size() > kWidth) {
            lines.push_back(line);
            line = std::string(hanging, ' ') + word;
        } else {
            line += (start == 0 ? "" : " ") + word;
        }
        start = end + 1;
    }
    lines.push_back(line);
}

std::string settings_line(const Program& program) {
    std::string out;
    for (const Declaration& setting : of_role(program, Role::parameter)) {
        if (setting.type == Type::real && std::abs(setting.initial) < kNoLimit)
            out += (out.empty() ? "" : ", ") + setting.name + " " + text(setting.initial, 6);
    }
    return out;
}

}  // namespace

std::vector<std::string> head_lines(const Program& program, const Provenance& provenance,
                                    const std::vector<std::string>& call) {
    std::vector<std::string> lines{"PID controller, written by Tunewright " TUNEWRIGHT_VERSION "."};
    lines.emplace_back();
    constexpr std::size_t kColumn = 14;
    for (const auto& [name, value] : provenance) {
        std::string label = safe(name);
        label.resize(std::max(kColumn, label.size() + 1), ' ');
        wrap(label + safe(value).substr(0, kLongestValue), kColumn, lines);
    }
    wrap("Settings      " + settings_line(program), kColumn, lines);
    for (const std::string& note : program.notes) {
        lines.emplace_back();
        wrap(safe(note), 0, lines);  // that of a schedule has its variable and unit in the user's words
    }
    lines.emplace_back();
    lines.insert(lines.end(), call.begin(), call.end());
    return lines;
}

}  // namespace tunewright::code
