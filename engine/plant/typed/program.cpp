#include "engine/plant/typed/program.h"

#include <algorithm>
#include <map>
#include <optional>
#include <utility>

#include "engine/plant/expression/tokens.h"
#include "engine/plant/typed/formula_parser.h"
#include "engine/plant/typed/lists.h"
#include "engine/plant/typed/parameter_parser.h"
#include "engine/plant/typed/plant_calls.h"

namespace tunewright::typed {
namespace {

Word end_word(int position) {
    Word word;
    word.position = position;
    return word;
}

/// True if the line is one that loads a package, or the head of a model.
bool is_head(const Statement& line) {
    constexpr const char* kHeads[] = {"import", "from", "using", "pkg", "clear", "close", "clc", "model", "end"};
    if (line.size() < 2 || line[0].kind != Word::Kind::name || Cursor::is(line[1], "=")) return false;
    return std::ranges::any_of(kHeads, [&](const char* head) { return is_name(line[0], head); });
}

/// The number of words before the value, "G =" or "P(s) ="; 0 if the words from `at` do not assign a name.
std::size_t length_of_assignment(const std::vector<Word>& words, std::size_t at) {
    const auto word = [&](std::size_t i) -> const Word& { return words[std::min(at + i, words.size() - 1)]; };
    if (word(0).kind != Word::Kind::name) return 0;
    const bool of_s = Cursor::is(word(1), "(") && is_name(word(2), "s") && Cursor::is(word(3), ")");
    const std::size_t length = of_s ? 4 : 1;
    return Cursor::is(word(length), "=") ? length + 1 : 0;
}

/// True for a class and the name of its instance; not for two factors of a formula.
bool is_declaration(const std::vector<Word>& words, std::size_t at) {
    if (at + 2 >= words.size() || words[at].kind != Word::Kind::name) return false;
    const std::string name = lower(words[at].text);
    const bool block = !words[at].prefix.empty() || is_formula_function(name) || is_state_space_function(name);
    return block && words[at + 1].kind == Word::Kind::name && words[at + 1].text != "exp" &&
           Cursor::is(words[at + 2], "(");
}

/// True if a line that begins at `at` is a statement of its own.
bool begins_statement(const std::vector<Word>& words, std::size_t at) {
    return length_of_assignment(words, at) > 0 || is_declaration(words, at) || is_name(words[at], "equation") ||
           is_name(words[at], "connect") || is_head({words.begin() + static_cast<std::ptrdiff_t>(at), words.end()});
}

/// True if an expression continues over the line break between the words.
bool continues(const Word& before, const Word& after) {
    constexpr const char* kOperators[] = {"+", "-", "*", "/", "^", ",", "="};
    const auto is_operator = [&](const Word& word) {
        return std::ranges::any_of(kOperators, [&](const char* sign) { return Cursor::is(word, sign); });
    };
    return is_operator(before) || is_operator(after);
}

class Program {
public:
    explicit Program(double own_time) : own_time_(own_time) {}

    void run(const Statement& statement) {
        if (fault_) return;
        if (is_name(statement[0], "equation")) return run({statement.begin() + 1, statement.end()});
        if (statement.size() < 2) return;
        if (unused_) return fail(*unused_, "this value is not used; assign it to a name, or leave it out.");
        if (is_name(statement[0], "connect")) return connect(statement);
        if (is_declaration(statement, 0)) return declare(statement);
        const std::size_t length = length_of_assignment(statement, 0);
        if (length > 0 && !statement[0].prefix.empty()) return set_property(statement);
        NamedValue value = read({statement.begin() + static_cast<std::ptrdiff_t>(length), statement.end()});
        last_position_ = statement[0].position;
        if (length == 0) unused_ = statement[0];
        if (fault_ || length == 0) return void(last_ = std::move(value));
        assign(statement[0], std::move(value));
    }

    Expected<Names> names() {
        if (fault_) return *fault_;
        return std::move(names_);
    }

    Expected<std::variant<Formula, StateSpace>> result() {
        if (!fault_ && !blocks_.empty()) join_blocks();
        if (fault_) return *fault_;
        if (dynamic_ && last_.formula && last_.formula->is_number())
            return fault_at(last_position_, "the last statement is a number; end with the plant.");
        if (last_.formula) return std::variant<Formula, StateSpace>(*std::move(last_.formula));
        if (last_.states) return std::variant<Formula, StateSpace>(*std::move(last_.states));
        return fault_at(last_position_, "the last statement is a list; end with the plant, such as G = tf(num, den).");
    }

private:
    void fail(const Cursor& cursor) {
        if (cursor.failed() && !fault_) fault_ = cursor.fault();
    }
    void fail(const Word& word, const std::string& what) {
        if (!fault_) fault_ = fault_at(word.position, what);
    }

    void assign(const Word& name, NamedValue value) {
        if (name.text == "s") {
            const bool laplace = value.formula && value.formula->gain == 1 && value.formula->den.empty() &&
                                 value.formula->num == std::vector<Polynomial>{{1, 0}} && value.formula->L == 0;
            if (!laplace) fail(name, "s is the variable of the plant here; give this value another name.");
            return;
        }
        if (name.text == "e" || name.text == "exp")
            return fail(name, quoted(name.text) + " is the exponential function; give this value another name.");
        dynamic_ |= value.states || (value.formula && !value.formula->is_number());
        last_ = value;
        names_.insert_or_assign(name.text, std::move(value));
    }

    NamedValue read(const Statement& words) {
        if (has_state_space(words)) return read_states(words);
        Cursor cursor(words);
        NamedValue value;
        if (is_list(words)) {
            value.matrix = read_matrix(cursor, names_);
            if (!cursor.failed() && !cursor.at_end()) cursor.unexpected("the end of the statement");
        } else {
            value.formula = read_formula(cursor, names_, own_time_);
        }
        fail(cursor);
        return value;
    }

    /// True for a list over the whole statement; brackets around a formula of s are not one.
    bool is_list(const Statement& words) const {
        if (!at_list(Cursor(words), names_)) return false;
        const bool of_s = std::ranges::any_of(words, [](const Word& word) { return is_name(word, "s"); });
        const Word& last = words[words.size() - 2];
        return !of_s && (closes(last) || Cursor::is(last, "'") || words.size() == 2);
    }

    bool is_state_space(const Word& word) const {
        const auto named = word.kind == Word::Kind::name ? names_.find(word.text) : names_.end();
        if (named != names_.end()) return named->second.states.has_value();
        return word.kind == Word::Kind::name && is_state_space_function(lower(word.text));
    }
    bool has_state_space(const Statement& words) const {
        return std::ranges::any_of(words, [&](const Word& word) { return is_state_space(word); });
    }

    /// The factors between the signs * outside brackets.
    static std::vector<Statement> factors_of(const Statement& words) {
        std::vector<Statement> factors(1);
        int depth = 0;
        for (const Word& word : words) {
            depth += opens(word) ? 1 : closes(word) ? -1 : 0;
            const bool times = depth == 0 && Cursor::is(word, "*");
            if (!times) factors.back().push_back(word);
            if (!times && word.kind != Word::Kind::end) continue;
            if (times) {
                factors.back().push_back(end_word(word.position));
                factors.emplace_back();
            }
        }
        return factors;
    }

    NamedValue read_states(const Statement& words) {
        NamedValue value;
        Formula scale;
        for (const Statement& factor : factors_of(words)) {
            Cursor cursor(factor);
            if (!is_state_space(factor[0])) {
                scale = product(std::move(scale), read_formula(cursor, names_, own_time_));
                if (!cursor.failed() && (!scale.num.empty() || !scale.den.empty()))
                    cursor.fail(factor[0].position,
                                "a state space can only be multiplied by numbers and dead times here; add this factor "
                                "to its matrices.");
            } else if (value.states) {
                cursor.fail(factor[0].position, "only one state space can be read; join both in one.");
            } else {
                value.states = one_state_space(cursor);
            }
            fail(cursor);
            if (fault_) return {};
        }
        if (!value.states) {
            fail(words[0], "a state space can only be multiplied by numbers and dead times here.");
            return {};
        }
        for (double& c : value.states->C) c *= scale.gain;
        value.states->D *= scale.gain;
        value.states->L += scale.L;
        return value;
    }

    StateSpace one_state_space(Cursor& cursor) {
        StateSpace states;
        if (const auto named = names_.find(cursor.now().text); named != names_.end()) {
            states = *named->second.states;
            cursor.advance();
        } else if (!at_call(cursor)) {
            cursor.unexpected("ss(A,B,C,D)");
        } else {
            const Call call = read_call(cursor, names_);
            states = state_space_of_call(call, cursor);
        }
        if (!cursor.failed() && !cursor.at_end())
            cursor.fail(cursor.now().position, "a state space can only be multiplied by numbers and dead times here.");
        return states;
    }

    // G.InputDelay = 3
    void set_property(const Statement& statement) {
        const std::string property = lower(statement[0].text);
        const auto named = names_.find(statement[0].prefix);
        if (named == names_.end() || named->second.matrix)
            return fail(statement[0], quoted(statement[0].prefix) + " is not a plant that a statement before defines.");
        if (property != "inputdelay" && property != "outputdelay" && property != "iodelay")
            return fail(statement[0], quoted(statement[0].text) +
                                          " is not read; only InputDelay, OutputDelay and IODelay change the plant. "
                                          "Leave this statement out.");
        Cursor cursor({statement.begin() + 2, statement.end()});
        const Argument value{.position = cursor.now().position, .numbers = read_matrix(cursor, names_)};
        const double delay = number_of(value, cursor);
        if (!cursor.failed() && !cursor.at_end()) cursor.unexpected("the end of the statement");
        fail(cursor);
        if (fault_) return;
        (named->second.formula ? named->second.formula->L : named->second.states->L) += delay;
        last_ = named->second;
    }

    // Modelica.Blocks.Continuous.FirstOrder heater(k=2, T=10)
    void declare(const Statement& statement) {
        Cursor cursor(statement);
        if (!is_formula_function(lower(statement[0].text)) && !is_state_space(statement[0]))
            return refuse_call(statement[0], cursor), fail(cursor);
        const Call call = read_call(cursor, names_);
        NamedValue value;
        if (is_state_space_function(lower(call.name)))
            value.states = state_space_of_call(call, cursor);
        else
            value.formula = formula_of_call(call, cursor);
        if (!cursor.failed() && !cursor.at_end()) cursor.unexpected("\";\"");
        fail(cursor);
        if (fault_) return;
        if (!blocks_.emplace(statement[1].text, std::move(value)).second)
            fail(statement[1], quoted(statement[1].text) + " is declared twice.");
        last_position_ = statement[0].position;
    }

    // connect(a.y, b.u)
    void connect(const Statement& statement) {
        const bool complete = statement.size() == 7 && Cursor::is(statement[1], "(") && Cursor::is(statement[3], ",") &&
                              Cursor::is(statement[5], ")");
        const Word& from = statement[complete ? 2 : 0];
        const Word& to = statement[complete ? 4 : 0];
        if (!complete || !is_name(from, "y") || !is_name(to, "u"))
            return fail(statement[0], "write connect(a.y, b.u): the output of one block to the input of another.");
        for (const Word* end : {&from, &to})
            if (!blocks_.contains(end->prefix))
                return fail(*end, quoted(end->prefix) + " is not a block that a statement before declares.");
        const bool branch = std::ranges::any_of(
            lines_, [&](const auto& line) { return line.second == to.prefix || line.first == from.prefix; });
        if (branch) return fail(from, "only blocks in series are read; a block has one connection at each end.");
        lines_.emplace(from.prefix, to.prefix);
    }

    /// The product of the blocks, which must be in one series.
    void join_blocks() {
        std::string at = blocks_.begin()->first;
        for (const auto& [name, value] : blocks_)
            if (std::ranges::none_of(lines_, [&](const auto& line) { return line.second == name; })) at = name;
        Formula whole;
        std::optional<StateSpace> states;
        std::size_t joined = 0;
        for (bool more = true; more && joined < blocks_.size(); ++joined) {
            const NamedValue& block = blocks_.at(at);
            if (block.formula) whole = product(std::move(whole), *block.formula);
            if (block.states && states) return fail_blocks("only one state space can be read; join both in one.");
            if (block.states) states = block.states;
            const auto next = lines_.find(at);
            more = next != lines_.end();
            if (more) at = next->second;
        }
        if (joined < blocks_.size() || lines_.size() + 1 != blocks_.size())
            return fail_blocks("the blocks are not in one series; join them by equations such as connect(a.y, b.u).");
        if (std::max(degree(whole.num), degree(whole.den)) > kMaxOrder)
            return fail_blocks("the order is above " + std::to_string(kMaxOrder) + ".");
        last_ = {};
        if (!states) return void(last_.formula = std::move(whole));
        if (!whole.num.empty() || !whole.den.empty())
            return fail_blocks("a state space can only be joined with gains and dead times here.");
        for (double& c : states->C) c *= whole.gain;
        states->D *= whole.gain;
        states->L += whole.L;
        last_.states = std::move(states);
    }
    void fail_blocks(const std::string& what) {
        if (!fault_) fault_ = fault_at(last_position_, what);
    }

    double own_time_;
    Names names_;
    NamedValue last_;
    int last_position_ = 1;
    std::optional<Word> unused_;  ///< a value without a name, which only the last statement may be
    bool dynamic_ = false;        ///< a plant that is more than a number was assigned
    std::map<std::string, NamedValue> blocks_;
    std::map<std::string, std::string> lines_;  ///< connections, by the block at their beginning
    std::optional<Error> fault_;
};

}  // namespace

std::vector<Statement> statements_of(const std::vector<Word>& words) {
    std::vector<Statement> statements;
    Statement current;
    const auto end_at = [&](const Word& word) {
        if (!current.empty()) current.push_back(end_word(word.position));
        if (current.size() > 1 && !is_head(current)) statements.push_back(std::move(current));
        current.clear();
    };
    int depth = 0;
    for (std::size_t i = 0; i < words.size(); ++i) {
        const Word& word = words[i];
        if (word.kind == Word::Kind::end || (depth == 0 && Cursor::is(word, ";"))) {
            end_at(word);
            continue;
        }
        const bool line_ends =
            depth == 0 && word.after_line && !current.empty() && (is_head(current) || !continues(words[i - 1], word));
        if (line_ends && (begins_statement(current, 0) || begins_statement(words, i))) end_at(word);
        depth += opens(word) ? 1 : closes(word) && depth > 0 ? -1 : 0;
        current.push_back(word);
    }
    return statements;
}

Statement value_of(const Statement& statement) {
    return {statement.begin() + static_cast<std::ptrdiff_t>(length_of_assignment(statement, 0)), statement.end()};
}

bool is_program(const std::vector<Statement>& statements) {
    bool assigned = false, function = false;
    for (const Statement& statement : statements) {
        const std::size_t length = length_of_assignment(statement, 0);
        assigned |= length > 0 && !is_parameter_text(Cursor(statement));
        assigned |= length > 0 && at_call(Cursor(value_of(statement)));
        function |= std::ranges::any_of(statement, [&](const Word& word) {
            const std::string name = lower(word.text);
            return word.kind == Word::Kind::name &&
                   (name == "s" || is_formula_function(name) || is_state_space_function(name));
        });
    }
    return assigned && function;
}

Expected<std::variant<Formula, StateSpace>> read_program(const std::vector<Statement>& statements, double own_time) {
    Program program(own_time);
    for (const Statement& statement : statements) program.run(statement);
    return program.result();
}

Expected<Names> read_names(const std::vector<Statement>& statements, double own_time) {
    Program program(own_time);
    for (const Statement& statement : statements) program.run(statement);
    return program.names();
}

}  // namespace tunewright::typed
