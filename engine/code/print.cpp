#include "engine/code/print.h"

#include <algorithm>
#include <cctype>
#include <cmath>

#include "engine/code/algorithm.h"
#include "engine/number_text.h"

namespace tunewright::code {
namespace {

// Operator precedence: higher binds tighter. Logical operands are always in parentheses, because languages order them
// differently.
int binding(Operation operation) {
    switch (operation) {
        case Operation::logical_or:
        case Operation::logical_and:
        case Operation::logical_not: return 0;
        case Operation::less:
        case Operation::greater:
        case Operation::greater_equal:
        case Operation::equal:
        case Operation::not_equal: return 1;
        case Operation::add:
        case Operation::subtract: return 2;
        case Operation::multiply:
        case Operation::divide: return 3;
        case Operation::negate: return 4;
        case Operation::exponential: return 5;
    }
    return 0;
}

bool is_logical(Operation operation) { return binding(operation) == 0; }

const Operated* operated(const Expr& expression) { return std::get_if<Operated>(&expression->what); }

std::string operand(const Expr& expression, Operation outer, bool right, const Dialect& dialect) {
    const std::string inside = text_of(expression, dialect);
    const auto* literal = std::get_if<Literal>(&expression->what);
    if (literal != nullptr) return literal->value < 0 ? "(" + inside + ")" : inside;
    const Operated* inner = operated(expression);
    if (inner == nullptr || inner->operation == Operation::exponential) return inside;
    const int of_inner = binding(inner->operation), of_outer = binding(outer);
    if (is_logical(outer) && !right && inner->operation == outer) return inside;  // a or b or c needs no parentheses
    const bool bare = !is_logical(outer) && inner->operation != Operation::negate &&
                      (right ? of_inner > of_outer : of_inner >= of_outer);
    return bare ? inside : "(" + inside + ")";
}

std::string literal_text(const Literal& literal, Type type, const Dialect& dialect) {
    switch (type) {
        case Type::real: return dialect.real(literal.value);
        case Type::boolean: return dialect.boolean(literal.value != 0);
        case Type::integer: return text(literal.value, 17);
    }
    return {};
}

std::string operated_text(const Operated& what, const Dialect& dialect) {
    if (what.operation == Operation::exponential) return dialect.exponential(text_of(what.operands[0], dialect));
    const std::string mark = dialect.mark(what.operation);
    if (what.operands.size() == 1) return mark + operand(what.operands[0], what.operation, true, dialect);
    return operand(what.operands[0], what.operation, false, dialect) + mark +
           operand(what.operands[1], what.operation, true, dialect);
}

class Lines {
public:
    Lines(const Dialect& dialect, int depth) : dialect_(dialect), depth_(depth) {}

    void operator()(const Assignment& what) {
        add(dialect_.assign(text_of(what.target, dialect_), text_of(what.value, dialect_)));
    }
    void operator()(const Decision& what) {
        add(dialect_.open_decision(text_of(what.condition, dialect_)));
        inside(what.then);
        if (!what.otherwise.empty()) {
            add(dialect_.otherwise());
            inside(what.otherwise);
        }
        close(dialect_.close_decision());
    }
    void operator()(const Repetition& what) {
        add(dialect_.open_repetition(text_of(what.index, dialect_), what.count));
        inside(what.body);
        close(dialect_.close_repetition());
    }
    void operator()(const Remark& what) {
        if (!out_.empty()) out_ += "\n";
        add(dialect_.remark(what.text));
    }

    std::string take() { return std::move(out_); }

private:
    void add(const std::string& line) { out_ += indentation(depth_) + line + "\n"; }
    void inside(const Block& block) { out_ += text_of(block, dialect_, depth_ + 1); }
    void close(const std::string& line) {
        if (!line.empty()) add(line);
    }

    const Dialect& dialect_;
    int depth_;
    std::string out_;
};

}  // namespace

std::string Dialect::mark(Operation operation) const {
    switch (operation) {
        case Operation::add: return " + ";
        case Operation::subtract: return " - ";
        case Operation::multiply: return " * ";
        case Operation::divide: return " / ";
        case Operation::less: return " < ";
        case Operation::greater: return " > ";
        case Operation::greater_equal: return " >= ";
        case Operation::equal: return words_.equal;
        case Operation::not_equal: return words_.not_equal;
        case Operation::logical_and: return words_.logical_and;
        case Operation::logical_or: return words_.logical_or;
        case Operation::negate: return "-";
        case Operation::logical_not: return words_.logical_not;
        case Operation::exponential: break;
    }
    return {};
}

std::string text_of(const Expr& expression, const Dialect& dialect) {
    struct Visit {
        Type type;
        const Dialect& dialect;
        std::string operator()(const Literal& what) const { return literal_text(what, type, dialect); }
        std::string operator()(const VariableReference& what) const {
            const std::string name = dialect.variable(what);
            return what.index.empty() ? name : name + "[" + text_of(what.index[0], dialect) + "]";
        }
        std::string operator()(const Operated& what) const { return operated_text(what, dialect); }
    };
    return std::visit(Visit{expression->type, dialect}, expression->what);
}

std::string text_of(const Block& block, const Dialect& dialect, int depth) {
    Lines lines(dialect, depth);
    for (const Statement& statement : block) std::visit(lines, statement.what);
    return lines.take();
}

std::string real_literal(double value, char exponent) {
    const std::string shortest = exact_text(value);
    const std::size_t e = shortest.find('e');
    std::string out = shortest.substr(0, e);
    if (out.find('.') == out.npos) out += ".0";
    if (e == shortest.npos) return out;
    // "e-05", "e+30": a positive exponent needs no sign, and leading zeros are removed.
    std::string power = shortest.substr(e + 1);
    const bool negative = power.front() == '-';
    power.erase(0, power.find_first_not_of("+-0"));
    return out + exponent + (negative ? "-" : "") + power;
}

std::string indentation(int depth) { return std::string(static_cast<std::size_t>(4 * depth), ' '); }

std::string example_setting(const Program& program) {
    const auto settings = of_role(program, VariableRole::parameter);
    for (const char* name : {"Kp", "u_max"})
        if (std::ranges::find(settings, name, &Declaration::name) != settings.end()) return name;
    const auto gain = std::ranges::find_if(
        settings, [](const Declaration& setting) { return setting.name.find("Kp") != std::string::npos; });
    return gain == settings.end() ? "u_max" : gain->name;
}

static std::string capitalised(std::string text) {
    text.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(text.front())));
    return text;
}

std::string type_name(const Program& program) { return "Tunewright" + capitalised(program.name); }

std::string output_names(const Program& program) {
    std::string out;
    for (const Declaration& output : of_role(program, VariableRole::output))
        out += (out.empty() ? "" : ", ") + output.name;
    return out;
}

std::string row_headings(const Program& program) {
    std::string out;
    for (const auto& [state, heading] : program.row) out += (out.empty() ? "" : ",") + heading;
    return out;
}

std::string example_arguments(const Program& program, const std::function<std::string(const Declaration&)>& argument) {
    std::string out;
    for (const Declaration& input : of_role(program, VariableRole::input))
        out += (out.empty() ? "" : ", ") + argument(input);
    return out;
}

std::string print(const Program& program, Language language, const Provenance& provenance) {
    switch (language) {
        case Language::structured_text: return print_structured_text(program, provenance);
        case Language::c: return print_c(program, provenance);
        case Language::python: return print_python(program, provenance);
        case Language::arduino: return print_arduino(program, provenance);
    }
    return {};
}

namespace {

constexpr std::size_t kWidth = 96;          // characters of a line, without comment marks
constexpr std::size_t kLongestValue = 300;  // characters of a text that the user has written

// Replaces each character by one printable ASCII character; signs that occur in units are spelled out.
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

// Removes pairs of characters that open or close a comment, or that are trigraphs of old C.
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

// Wraps the words of `text` into lines; from the second line on they begin with `hanging` blanks.
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
    for (const Declaration& setting : of_role(program, VariableRole::parameter)) {
        if (setting.type == Type::real && std::abs(setting.initial) < kNoLimit)
            out += (out.empty() ? "" : ", ") + setting.name + " " + text(setting.initial, 6);
    }
    return out;
}

}  // namespace

std::vector<std::string> head_lines(const Program& program, const Provenance& provenance,
                                    const std::vector<std::string>& call) {
    std::vector<std::string> lines{capitalised(program.title) + ", written by Tunewright " TUNEWRIGHT_VERSION "."};
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
        wrap(safe(note), 0, lines);  // the note of a schedule has the user's words for its variable and unit
    }
    if (!program.codes.empty()) {
        lines.emplace_back();
        lines.push_back("Values of " + program.coded_output + ":");
        for (const auto& [value, sentence] : program.codes)
            wrap("  " + std::to_string(value) + " " + sentence, 5, lines);
    }
    lines.emplace_back();
    lines.insert(lines.end(), call.begin(), call.end());
    return lines;
}

}  // namespace tunewright::code
