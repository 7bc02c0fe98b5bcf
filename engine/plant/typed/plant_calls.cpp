#include "engine/plant/typed/plant_calls.h"

#include <algorithm>
#include <initializer_list>
#include <string>
#include <utility>

#include "engine/plant/expression/tokens.h"
#include "engine/plant/linear/factor.h"

namespace tunewright::typed {
namespace {

using Complex = std::complex<double>;

constexpr std::size_t kByName = 99;  ///< index of an argument that has no place in the order

constexpr std::string_view kContinuous =
    "the model is in discrete time, but a plant must be in continuous time; convert it first (d2c in MATLAB and "
    "Octave).";

/// Takes the arguments of a call one by one; finish() refuses what is left.
class Arguments {
public:
    Arguments(const Call& call, Cursor& cursor) : call_(call), cursor_(cursor) { take_common(); }

    /// The argument at `index` or of one of the names; null if it is not given.
    const Argument* find(std::initializer_list<const char*> names, std::size_t index = kByName) {
        const Argument* found = index < call_.inputs.size() ? &call_.inputs[index] : nullptr;
        if (found) used_ = std::max(used_, index + 1);
        for (const char* name : names) {
            const auto named = call_.named.find(lower(name));
            if (named == call_.named.end()) continue;
            taken_.push_back(named->first);
            if (found) cursor_.fail(named->second.position, quoted(name) + " is given twice.");
            found = &named->second;
        }
        return found;
    }
    const Argument& need(std::initializer_list<const char*> names, std::size_t index = kByName) {
        static const Argument none{.numbers = {{0}}};
        if (const Argument* found = find(names, index)) return *found;
        cursor_.fail(call_.end, std::string(*names.begin()) + " is missing in the call of " + call_.name + ".");
        return none;
    }
    double number(std::initializer_list<const char*> names, std::size_t index = kByName) {
        return number_of(need(names, index), cursor_);
    }
    double number_or(double other, std::initializer_list<const char*> names, std::size_t index = kByName) {
        const Argument* found = find(names, index);
        return found ? number_of(*found, cursor_) : other;
    }

    /// A row or a column of numbers.
    std::vector<Complex> list(const Argument& argument, bool may_be_empty = false) {
        const Matrix rows = argument.is_word ? Matrix{{}} : argument.numbers;
        const bool column = std::ranges::all_of(rows, [](const auto& row) { return row.size() == 1; });
        if (argument.is_word)
            cursor_.fail(argument.position, quoted(argument.word) + " has no value here; write a list such as [10 1].");
        else if (rows.size() > 1 && !column)
            cursor_.fail(argument.position,
                         "this list has several rows, of several inputs or outputs; give the plant "
                         "from one input to one output.");
        else if (rows[0].empty() && !may_be_empty)
            cursor_.fail(argument.position, "this list is empty.");
        if (cursor_.failed()) return {0};
        return column && rows.size() > 1 ? transposed(rows)[0] : rows[0];
    }
    std::vector<double> coefficients(const Argument& argument) {
        std::vector<double> out;
        for (const Complex c : list(argument)) {
            if (c.imag() != 0) cursor_.fail(argument.position, "a coefficient must be real.");
            out.push_back(c.real());
        }
        if (out.size() > kMaxOrder + 1) too_high(argument.position);
        return out;
    }
    std::vector<Complex> roots(const Argument& argument) {
        std::vector<Complex> out = list(argument, true);
        if (out.size() > kMaxOrder) too_high(argument.position);
        return out;
    }

    double delay() const { return delay_; }

    void finish() {
        if (call_.inputs.size() > used_) {
            const Argument& extra = call_.inputs[used_];
            const bool zero = !extra.is_word && extra.numbers == Matrix{{0}};
            if (!zero && used_ > 0)
                cursor_.fail(extra.position, "another argument would be a sample time: " + std::string(kContinuous));
            else if (!zero)
                cursor_.fail(extra.position, "name the arguments of " + call_.name + ", as in k=2.");
        }
        for (const auto& [name, argument] : call_.named)
            if (std::ranges::find(taken_, name) == taken_.end())
                cursor_.fail(argument.position,
                             quoted(argument.name) + " is unknown in " + call_.name +
                                 "; of the pairs of names and values only InputDelay, OutputDelay and IODelay are "
                                 "read. Leave it out.");
    }

private:
    // Delays add up. Names and initial values do not change the plant.
    void take_common() {
        for (const auto& [name, argument] : call_.named) {
            if (name == "inputdelay" || name == "outputdelay" || name == "iodelay" || name == "delay" ||
                name == "delaytime")
                delay_ += number_of(argument, cursor_);
            else if (name == "ts" || name == "dt" || name == "sampletime" || name == "z" || name == "q")
                check_continuous(argument);
            else if (name == "timeunit")
                check_seconds(argument);
            else if (name != "name" && name != "inputname" && name != "outputname" && name != "inittype" &&
                     name != "y_start" && name != "x_start")
                continue;
            taken_.push_back(name);
        }
    }
    void check_continuous(const Argument& argument) {
        const std::string word = lower(argument.word);
        const bool none = argument.is_word && (word == "none" || word == "nothing" || word == "false");
        if (none || (!argument.is_word && argument.numbers == Matrix{{0}})) return;
        cursor_.fail(argument.position, std::string(kContinuous));
    }
    void check_seconds(const Argument& argument) {
        if (lower(argument.word) != "seconds")
            cursor_.fail(argument.position,
                         "TimeUnit is not read; leave it out and give the unit of the times as units.time.");
    }
    void too_high(int position) { cursor_.fail(position, "the order is above " + std::to_string(kMaxOrder) + "."); }

    const Call& call_;
    Cursor& cursor_;
    double delay_ = 0;
    std::size_t used_ = 0;
    std::vector<std::string> taken_;
};

Formula laplace(const Call& call, Cursor& cursor) {
    const Argument& variable = call.inputs[0];
    if (variable.word != "s")
        cursor.fail(variable.position,
                    variable.word == "z" || variable.word == "q"
                        ? std::string(kContinuous)
                        : quoted(variable.word) + " is not a variable of a plant; write " + call.name + "('s').");
    return {.gain = 1, .num = {{1, 0}}};
}

Formula of_coefficients(const Call& call, Arguments& given, Cursor& cursor) {
    // Modelica's block has the default 1 for both lists.
    const bool block = call.inputs.empty() && (call.named.contains("a") || call.named.contains("b"));
    static const Argument one{.numbers = {{1}}};
    const Argument* found = block ? given.find({"b"}) : &given.need({"num", "numerator"}, 0);
    std::vector<double> num = given.coefficients(found ? *found : one);
    if (cursor.failed()) return {};
    found = block ? given.find({"a"}) : &given.need({"den", "denominator"}, 1);
    const Argument& below = found ? *found : one;
    const Formula den = of_polynomial(given.coefficients(below));
    if (!cursor.failed() && den.gain == 0) cursor.fail(below.position, "the denominator is 0.");
    return cursor.failed() ? Formula() : quotient(of_polynomial(std::move(num)), den);
}

Formula of_roots(Arguments& given, Cursor& cursor, int position) {
    Zpk plant;
    plant.zeros = given.roots(given.need({"z", "zeros"}, 0));
    plant.poles = given.roots(given.need({"p", "poles"}, 1));
    plant.K = given.number({"k", "gain"}, 2);
    if (cursor.failed()) return {};
    const std::vector<Error> faults = plant_faults(plant);
    if (!faults.empty()) cursor.fail(position, faults.front().message);
    return cursor.failed() ? Formula() : *formula_of(plant);
}

Formula second_order_block(Arguments& given, Cursor& cursor) {
    const double k = given.number_or(1, {"k"}), D = given.number({"D"});
    const Argument& w = given.need({"w"});
    const double w0 = number_of(w, cursor);
    if (!cursor.failed() && w0 == 0) cursor.fail(w.position, "w must not be 0.");
    if (cursor.failed()) return {};
    return quotient({.gain = k}, of_polynomial({1 / (w0 * w0), 2 * D / w0, 1}));
}

Formula of_function(const std::string& name, const Call& call, Arguments& given, Cursor& cursor) {
    if (name == "tf" || name == "transferfunction") return of_coefficients(call, given, cursor);
    if (name == "zpk" || name == "zerospolesgain") return of_roots(given, cursor, call.position);
    if (name == "firstorder")
        return quotient({.gain = given.number_or(1, {"k"})}, of_polynomial({given.number({"T"}), 1}));
    if (name == "secondorder") return second_order_block(given, cursor);
    if (name == "integrator") return quotient({.gain = given.number_or(1, {"k"})}, of_polynomial({1, 0}));
    if (name == "gain") return {.gain = given.number({"k"})};
    if (name == "fixeddelay") {
        if (!call.named.contains("delaytime")) given.need({"delayTime"});
        return {};
    }
    return {.gain = 1, .L = given.number({"tau"}, 0)};  // delay of Julia
}

}  // namespace

bool is_formula_function(std::string_view name) {
    constexpr std::string_view kKnown[] = {"tf",    "transferfunction", "zpk",         "zerospolesgain",
                                           "delay", "firstorder",       "secondorder", "integrator",
                                           "gain",  "fixeddelay"};
    return std::ranges::find(kKnown, name) != std::end(kKnown);
}

bool is_state_space_function(std::string_view name) { return name == "ss" || name == "statespace"; }

Formula formula_of_call(const Call& call, Cursor& cursor) {
    if (cursor.failed()) return {};
    Arguments given(call, cursor);
    const std::string name = lower(call.name);
    const bool variable = (name == "tf" || name == "zpk" || name == "transferfunction") && call.inputs.size() == 1 &&
                          call.inputs[0].is_word && call.named.empty();
    if (variable || cursor.failed()) return variable ? laplace(call, cursor) : Formula();
    Formula out = of_function(name, call, given, cursor);
    out.L += given.delay();
    given.finish();
    return cursor.failed() ? Formula() : out;
}

StateSpace state_space_of_call(const Call& call, Cursor& cursor) {
    if (cursor.failed()) return {};
    Arguments given(call, cursor);
    StateSpace plant;
    const Argument& A = given.need({"A"}, 0);
    if (A.is_word) given.coefficients(A);
    for (const auto& row : A.numbers) plant.A.push_back(given.coefficients({.position = A.position, .numbers = {row}}));
    plant.B = given.coefficients(given.need({"B"}, 1));
    plant.C = given.coefficients(given.need({"C"}, 2));
    plant.D = given.number_or(0, {"D"}, 3);
    plant.L = given.delay();
    given.finish();
    if (cursor.failed()) return {};
    const std::vector<Error> faults = plant_faults(plant);
    if (!faults.empty()) cursor.fail(call.position, faults.front().message);
    return plant;
}

void refuse_call(const Word& name, Cursor& cursor) {
    const std::string function = lower(name.text);
    if (function == "pade" || function == "padedelay")
        return cursor.fail(
            name.position,
            "an approximated dead time is not needed, because a dead time is exact here; write exp(-3*s) "
            "instead.");
    if (function == "pid" || function == "pidstd" || function == "pid2" || function == "pidstd2" ||
        function == "limpid")
        return cursor.fail(name.position,
                           quoted(name.text) + " is a controller; give it as baseline, and here the plant.");
    if (function == "c2d" || function == "filt" || function == "dlti")
        return cursor.fail(name.position, std::string(kContinuous));
    cursor.fail(name.position, quoted(name.text) +
                                   " is not read here; read are tf, zpk, ss, exp(-3*s), delay(3), and the blocks "
                                   "FirstOrder, SecondOrder, TransferFunction, Integrator, Gain and FixedDelay.");
}

}  // namespace tunewright::typed
