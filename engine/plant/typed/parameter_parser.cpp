
#include "engine/plant/typed/parameter_parser.h"

#include <map>
#include <utility>

#include "engine/plant/expression/tokens.h"
#include "engine/plant/typed/readings.h"

namespace tunewright::typed {
namespace {

struct Name {
    const char* written;
    const char* meant;
};

constexpr Name kNames[] = {
    {"k", "K"},          {"kp", "K"},       {"gain", "K"},         {"t", "T"},        {"tau", "T"},
    {"tp", "T"},         {"lag", "T"},      {"timeconstant", "T"}, {"t1", "T1"},      {"tau1", "T1"},
    {"tp1", "T1"},       {"t2", "T2"},      {"tau2", "T2"},        {"tp2", "T2"},     {"l", "L"},
    {"theta", "L"},      {"td", "L"},       {"delay", "L"},        {"deadtime", "L"}, {"dead_time", "L"},
    {"inputdelay", "L"}, {"zeta", "zeta"},  {"damping", "zeta"},   {"xi", "zeta"},    {"w0", "w0"},
    {"wn", "w0"},        {"w_n", "w0"},     {"omega0", "w0"},      {"omega_n", "w0"}, {"omegan", "w0"},
    {"zeros", "zeros"},  {"zero", "zeros"}, {"poles", "poles"},    {"pole", "poles"}};
constexpr const char* kKnown = "K, T, T1, T2, tau, L, theta, zeta, w0, zeros, poles, gain and delay";

enum class ParameterForm { by_names, fopdt, sopdt, ipdt };

std::optional<ParameterForm> kind_of(const Word& word) {
    const std::string name = lower(word.text);
    if (name == "fopdt" || name == "foptd" || name == "foldt") return ParameterForm::fopdt;
    if (name == "sopdt" || name == "soptd") return ParameterForm::sopdt;
    if (name == "ipdt" || name == "iptd" || name == "integrating" || name == "integrator") return ParameterForm::ipdt;
    return std::nullopt;
}

/// The meaning of a name; empty: unknown. Two words may form one name: dead time, time constant.
std::string meaning(const Word& word, const Word& next, bool& both) {
    const std::string name = lower(word.text), joined = name + lower(next.text);
    both = next.kind == Word::Kind::name && (joined == "deadtime" || joined == "timeconstant");
    for (const Name& known : kNames)
        if ((both ? joined : name) == known.written) return known.meant;
    // Single letters as in matrix programs, where capitals have another meaning.
    if (word.text == "z") return "zeros";
    if (word.text == "p") return "poles";
    return "";
}

bool is_assigned(const Word& word) { return Cursor::is(word, "=") || Cursor::is(word, ":"); }

struct Value {
    double number = 0;
    int position = 1;
    std::optional<double> unit;  ///< seconds
};

class ParameterParser {
public:
    ParameterParser(Cursor& cursor, double own_time) : cursor_(cursor), own_time_(own_time) {}

    Plant read() {
        if (const auto kind = kind_of(cursor_.now())) {
            kind_ = *kind;
            cursor_.advance();
            if (opens(cursor_.now()) || cursor_.at_number() || cursor_.at("-")) read_in_order();
        }
        while (!cursor_.failed() && !cursor_.at_end()) read_pair();
        if (cursor_.failed()) return Fopdt();
        if (poles_ || zeros_) return zeros_and_poles();
        check_units();
        convert();
        return plant();
    }

private:
    void read_pair() {
        if (cursor_.skip(",") || cursor_.skip(";")) return;
        const Word word = cursor_.now();
        if (!cursor_.at_name()) return cursor_.unexpected("a name such as T");
        bool both = false;
        const std::string name = meaning(word, cursor_.peek(1), both);
        if (name.empty()) {
            return cursor_.fail(word.position, quoted(word.text) +
                                                   " is not a parameter of a plant; known "
                                                   "are " +
                                                   kKnown + ", each with a value, as in K=2 T=10 L=3.");
        }
        cursor_.advance();
        if (both) cursor_.advance();
        if (is_assigned(cursor_.now())) cursor_.advance();
        if (name == "zeros" || name == "poles") return read_list(name == "zeros" ? zeros_ : poles_, word);
        if (values_.contains(name)) return cursor_.fail(word.position, name + " is given twice; leave one value.");
        values_[name] = read_value_with_unit(name, Commas::decimal);
    }

    void read_list(std::optional<std::vector<std::complex<double>>>& list, const Word& word) {
        if (list) return cursor_.fail(word.position, "these roots are given twice; leave one list.");
        if (cursor_.at_name() && (cursor_.now().text == "none" || cursor_.now().text == "no")) {
            cursor_.advance();
            list.emplace();
        } else {
            list = read_roots(cursor_);
        }
    }

    Value read_value_with_unit(const std::string& name, Commas commas) {
        Value value{.number = 0, .position = cursor_.now().position, .unit = {}};
        value.number = read_value(cursor_, commas);
        const bool slope = name == "K" && cursor_.at("/");
        const Word& word = cursor_.peek(slope ? 1 : 0);
        bool both = false;
        const Word& behind = cursor_.peek(slope ? 2 : 1);
        // A word before = is the next name, known or not.
        if (word.kind != Word::Kind::name || is_assigned(behind) || (!slope && !meaning(word, behind, both).empty()))
            return value;
        value.unit = word.text == "s" ? 1.0 : seconds_of_unit(word.text);
        if (!value.unit) {
            cursor_.fail(word.position, quoted(word.text) +
                                            " is neither a parameter nor a unit of time (ms, s, min, h, "
                                            "d); units of K belong to units.u and units.y.");
        } else if ((name == "K" && !slope) || name == "zeta" || name == "w0") {
            cursor_.fail(word.position, "a unit of time is only allowed after a time, not after " + name + ".");
        }
        if (slope) cursor_.advance();
        cursor_.advance();
        return value;
    }

    // fopdt(2, 10, 3), FOPDT 2 10 3
    void read_in_order() {
        static const std::map<ParameterForm, std::vector<std::string>> orders = {
            {ParameterForm::fopdt, {"K", "T", "L"}},
            {ParameterForm::sopdt, {"K", "T1", "T2", "L"}},
            {ParameterForm::ipdt, {"K", "L", "T"}}};
        const Word opened = cursor_.now();
        const bool bracket = opens(opened);
        if (bracket) cursor_.open(opened), cursor_.advance();
        for (const std::string& name : orders.at(kind_)) {
            if (!cursor_.at_number() && !cursor_.at("-")) break;
            values_[name] = read_value_with_unit(name, bracket ? Commas::separate : Commas::decimal);
            if (cursor_.at(",") && !(cursor_.peek(1).kind == Word::Kind::name)) cursor_.advance();
        }
        if (cursor_.failed() || !bracket) return;
        if (!cursor_.at(closing(opened))) return cursor_.unexpected(std::string("\"") + closing(opened) + "\"");
        cursor_.close();
        cursor_.advance();
    }

    Plant zeros_and_poles() {
        for (const auto& [name, value] : values_)
            if (name != "K" && name != "L") {
                cursor_.fail(value.position, name + " is not allowed with zeros and poles; only gain and delay are.");
                return Fopdt();
            }
        for (const auto& [name, value] : values_)
            if (value.unit && name == "L" && zeros_.value_or(Roots()).size() + poles_.value_or(Roots()).size() > 0) {
                cursor_.fail(value.position,
                             "zeros and poles have no unit here; write the delay in the same unit of time, without the "
                             "unit.");
                return Fopdt();
            }
        return Zpk{.K = values_.contains("K") ? values_.at("K").number : 1,
                   .zeros = zeros_.value_or(Roots()),
                   .poles = poles_.value_or(Roots()),
                   .L = values_.contains("L") ? values_.at("L").number : 0};
    }

    bool is_time(const std::string& name) const { return name[0] == 'T' || name == "L"; }

    // A single unit at the end may have been meant for all times: the error asks for it.
    void check_units() {
        const std::string *with = nullptr, *without = nullptr;
        for (const auto& [name, value] : values_) {
            const bool slope = name == "K" && integrating();
            if (value.unit) with = &name;
            if (!value.unit && value.number != 0 && (is_time(name) || slope || name == "w0")) without = &name;
            if (value.unit && name == "K" && !slope)
                return cursor_.fail(value.position, "only an integrating process has a gain per unit of time.");
        }
        if (with && without) {
            return cursor_.fail(values_.at(*without).position,
                                *with + " has a unit of time and " + *without + " has none; give both or neither" +
                                    (*without == "K" ? " (K=0.05/min is a slope)." : "."));
        }
        if (with && own_time_ <= 0)
            cursor_.fail(values_.at(*with).position,
                         "units.time is not a known unit of time; write the times without units.");
    }

    void convert() {
        for (auto& [name, value] : values_) {
            if (!value.unit || own_time_ <= 0) continue;
            value.number = name == "K" ? value.number / in_own_time(1, *value.unit, own_time_)
                                       : in_own_time(value.number, *value.unit, own_time_);
        }
    }

    bool integrating() const { return kind_ == ParameterForm::ipdt; }

    bool given(const char* name) const { return values_.contains(name); }
    double number(const char* name) const { return given(name) ? values_.at(name).number : 0; }

    Plant missing(const std::string& what) {
        cursor_.fail(cursor_.now().position, what);
        return Fopdt();
    }

    Plant plant() {
        if (!given("K"))
            return missing("K is missing, the steady-state change of y per unit of u, as in K=2 T=10 L=3.");
        const double K = number("K"), L = number("L");
        if (given("zeta") || given("w0")) return oscillatory(K, L);
        if (given("T1") || given("T2")) {
            if (given("T") || integrating())
                return missing("T1 and T2 define a second order; T is not allowed with them.");
            return Sopdt{.K = K, .T1 = number("T1"), .T2 = number("T2"), .L = L};
        }
        if (integrating()) return Ipdt{.K = K, .L = L, .T = number("T")};
        if (!given("T"))
            return missing(
                "T is missing, the time constant; T=0 is a pure dead time, and an integrating process is "
                "written ipdt K=0.05 L=3.");
        return Fopdt{.K = K, .T = number("T"), .L = L};
    }

    Plant oscillatory(double K, double L) {
        if (!given("zeta")) return missing("zeta is missing, the damping that goes with w0.");
        if (given("T") == given("w0")) return missing("zeta needs either T or w0 = 1/T, not both.");
        if (given("w0") && number("w0") == 0) return missing("w0 must not be 0.");
        if (given("T1") || given("T2")) return missing("zeta is allowed with T, not with T1 and T2.");
        return OscillatorySopdt{
            .K = K, .T = given("T") ? number("T") : 1 / number("w0"), .zeta = number("zeta"), .L = L};
    }

    using Roots = std::vector<std::complex<double>>;

    Cursor& cursor_;
    double own_time_;
    ParameterForm kind_ = ParameterForm::by_names;
    std::map<std::string, Value> values_;
    std::optional<Roots> zeros_, poles_;
};

}  // namespace

namespace {

/// True if a formula follows "K =" at the cursor, as in K = 3/(10s+1): a bracket, or a number with a bracket after it.
bool names_a_formula(const Cursor& cursor) {
    constexpr std::size_t kLongestSymbol = 2;  // "poles = (-1+2i)" is a list
    if (cursor.now().text.size() > kLongestSymbol || !is_assigned(cursor.peek(1))) return false;
    std::size_t at = Cursor::is(cursor.peek(2), "-") ? 3 : 2;
    if (cursor.peek(at).kind == Word::Kind::number) {
        ++at;
        if (Cursor::is(cursor.peek(at), "/") || Cursor::is(cursor.peek(at), "*")) ++at;
        const std::string& word = cursor.peek(at).text;
        if ((word == "e" || word == "exp") &&
            (Cursor::is(cursor.peek(at + 1), "^") || Cursor::is(cursor.peek(at + 1), "(")))
            return true;
    }
    return Cursor::is(cursor.peek(at), "(");
}

/// True for Modelica's Integrator(k=2) and Gain(k=2).
bool is_block(const Cursor& cursor) {
    const std::size_t at = cursor.peek(1).kind == Word::Kind::name ? 2 : 1;
    return !cursor.now().prefix.empty() || (Cursor::is(cursor.peek(at), "(") && is_name(cursor.peek(at + 1), "k") &&
                                            Cursor::is(cursor.peek(at + 2), "="));
}

}  // namespace

bool is_parameter_text(const Cursor& cursor) {
    if (!cursor.at_name() || names_a_formula(cursor) || is_block(cursor)) return false;
    if (kind_of(cursor.now())) return true;
    bool both = false;
    const std::string name = meaning(cursor.now(), cursor.peek(1), both);
    if (name.empty()) return false;
    const Word& next = cursor.peek(both ? 2 : 1);
    return is_assigned(next) || next.kind == Word::Kind::number || Cursor::is(next, "-") || Cursor::is(next, "[") ||
           Cursor::is(next, "+-") || next.text == "none";
}

Plant read_parameters(Cursor& cursor, double own_time) { return ParameterParser(cursor, own_time).read(); }

}  // namespace tunewright::typed
