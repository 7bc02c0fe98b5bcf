// A product as data: its form, its parameters and their meaning. A new product is an entry of a table (catalogue/) with
// its example; conversions and search read only this description.
#pragma once

#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "engine/controller/pid.h"
#include "engine/controller/sampled/sampled_pid.h"
#include "engine/controller/schedule/schedule.h"

namespace tunewright::product {

/// The value of a parameter: a number, a word (also a code that is typed as text) or a switch.
using Value = std::variant<double, std::string, bool>;

struct Setting {
    std::string name;  ///< Parameter::name
    Value value;

    bool operator==(const Setting&) const = default;
};
using Settings = std::vector<Setting>;

/// The law whose gain and times appear in the formulas of the parameters.
enum class Form {
    ideal,     ///< Kp (e + (1/Ti) int e + Td d/dt ...)
    parallel,  ///< the same law, whose parameters are gains
    series,    ///< Kc (1 + 1/(ti s)) (1 + td s)/(1 + alpha td s), D on the measurement
    p_only,    ///< Kp alone
};

enum class ParameterRole {
    gain,
    multiplier,  ///< multiplies all three parts; read before the gain
    integral,
    derivative,
    filter,
    weight_b,
    weight_c,
    choice,       ///< sets weights or filter, by `options`
    sample_time,  ///< the block's own period as it is typed
    fixed,        ///< has no effect on the equivalent ideal controller, which is computed for its value `standard`
    limit,        ///< limit of output, integral or tracking: not part of the linear law
};

/// How a parameter depends on the law. A `power` is factor * K^.. * Kp^.. * ... of `Term`; the others state their
/// formula.
enum class Shape {
    power,
    one_minus_b,     ///< 1 - b
    weight,          ///< b or c itself, by role
    feedforward,     ///< (b - 1) Kp; at least 0
    alpha_code,      ///< text "100".."199" for 1 - b = 0.00..0.99; "000" is read as 0.65
    plus_clock,      ///< Tf + dt, dt the clock of the firmware
    lag_per_sample,  ///< Tf/(Tf + dt)
    slope_samples,   ///< M = 1 + 2 Tf/Ts: a slope over M periods with the same delay
    option,          ///< one of `options`
    constant,        ///< `standard`
};

/// Exponents over gain and times of the block's own form, in seconds and units of u per y.
struct Term {
    double factor = 1;
    double Kp = 0, Ti = 0, Td = 0, Tf = 0;
    double ideal_Td = 0;    ///< of the ideal form, if the own form is the series form
    double Sy = 0, Su = 0;  ///< spans of measurement and output
    double Ts = 0;          ///< sample time
    double K = 0;           ///< the multiplier's value
};

/// One of a parameter's options and its effect on the law.
struct Option {
    Value value;
    std::optional<double> b = {}, c = {};
    std::optional<FilterType> filter = {};
    /// b and c are set by the parameters weight_b and weight_c, which have an effect only with such an option.
    bool free_weights = false;
    std::optional<bool> integral = {}, derivative = {};  ///< false: that action is switched off
};

struct Range {
    double low = -std::numeric_limits<double>::infinity();
    double high = std::numeric_limits<double>::infinity();
};

struct Parameter {
    std::string_view name = "";   ///< as in `settings`
    std::string_view label = "";  ///< as in the maker's software or manual
    std::string_view unit = "";
    ParameterRole role = ParameterRole::gain;
    Shape shape = Shape::power;
    Term term = {};
    Range range = {};
    /// The largest value that models with a known manual accept: a larger one gives a note, because other models may
    /// accept it.
    double usual_max = std::numeric_limits<double>::infinity();
    double resolution = 0;  ///< step of the values that can be entered; 0: a floating-point number
    /// The maker's default, if known; also the filter's value if the law leaves it undetermined.
    std::optional<Value> standard = {};
    std::optional<double> off = {};     ///< the value that switches this part off
    std::string_view zero_remark = "";  ///< the effect of 0 if 0 does not switch the part off
    std::vector<Option> options = {};   ///< the first is the maker's default
    bool compiled_in = false;           ///< can be changed only by building the firmware: a design keeps `standard`
    /// Not set by a design (mode, variant of the block): a design uses the first option, and leaves out other such
    /// parameters.
    bool elsewhere = false;
    std::string_view remark = "";
};

enum class FilterKind {
    none,
    parameter,    ///< of the derivative, set by the parameter of that role
    ratio,        ///< Tf = `value` * td of the own form, fixed
    measurement,  ///< of the second order over the whole measurement, set by the parameter
    chosen,       ///< a parameter chooses between `parameter` and `measurement`
    slope,        ///< of the derivative over `value` samples, or the number that the parameter gives
    four_points,  ///< (3, 1, -1, -3)/(10 Ts), with the same delay as Tf = Ts
    unknown,      ///< there may be one, but no description was found: the equivalent controller has none
};

struct FilterRule {
    FilterKind kind = FilterKind::none;
    double value = 0;
    std::string_view text = "";
};

/// Weights if no parameter sets them; those of the series form refer to its own gain.
struct Weights {
    double b = 1;
    double c = 0;
    std::string_view text = "";
};

/// How the sign of Kp is entered.
struct Action {
    enum class Kind { signed_gain, switched, reverse_only };
    Kind kind = Kind::signed_gain;
    std::string_view name = "";  ///< name of the switch, written only for direct action
    Value direct = true;         ///< its value for Kp < 0
    Value reverse = false;
    std::string_view text = "";
};

struct Algorithm {
    IntegralRule integral = IntegralRule::backward;
    DerivativeRule derivative = DerivativeRule::filtered_backward;
    bool velocity = false;
    bool published = true;  ///< false: integral and derivative rule are assumed
    std::string_view text = "";
    std::string_view anti_windup = "";
    std::optional<double> sample_time_s = {};  ///< default
    bool firmware_clock = false;               ///< the sample time is fixed, and formulas use it
    std::string_view sample_time_text = "";
};

enum class EvidenceLevel { read, partly, unverified };

struct Evidence {
    EvidenceLevel level = EvidenceLevel::unverified;
    std::vector<std::string_view> read = {};
    std::vector<std::string_view> unverified = {};
    std::vector<std::string_view> sources = {};
};

/// A design of the ideal form with a filter of the derivative, and the settings for it, with six digits as published.
struct Example {
    IdealPid design = {};
    double y_span = 200, u_span = 100, sample_time_s = 0.25;
    Settings settings = {};
};

/// The gain scheduling that comes with a product, if its maker's text was read.
struct GainScheduling {
    std::size_t sets = 0;                  ///< largest number of rows; 0: no limit
    std::optional<Interpolation> between;  ///< none: it interpolates in its own way, described in `text`
    std::string_view text = "";            ///< its name, its scheduling variable, and its interpolation between sets
    std::string_view source = "";
};

/// Text to paste into a program or a configuration file. In `text`:
///   {name}            the setting as it is typed
///   {name|other}      `other` if there is no such setting
///   {name=value:A/B}  A if the setting is typed as `value`, else B
///   {sample_time_s}   the block's period, also _ms and _us; {{ stands for an opening brace
/// A line with a setting or a period that does not exist is left out.
struct Snippet {
    std::string_view name = "";  ///< language or file, and the place in it
    std::string_view text = "";
};

struct Product {
    std::string_view id = "", maker = "", name = "";
    std::vector<std::string_view> families = {};  ///< names under which users know the maker's controllers
    Form form = Form::ideal;
    std::string_view law = "";  ///< formula over the parameters' names
    std::string_view gain_basis = "";
    std::vector<Parameter> parameters = {};
    /// The gain's output is in percent and no parameter scales it: u must be in percent too.
    bool in_percent = false;
    double series_alpha = 0;  ///< alpha of a series form if no parameter sets it
    FilterRule filter = {};
    Weights weights = {};
    Action action = {};
    Algorithm algorithm = {};
    std::vector<std::string_view> traps = {};
    Evidence evidence = {};
    Example example = {};
    std::optional<GainScheduling> scheduling = {};  ///< none: unknown
    std::vector<Snippet> snippets = {};
};

/// True if a choice of the product decides whether this parameter has an effect.
bool depends_on_choice(const Product& product, const Parameter& parameter);

/// The parameter of that name; null if there is none.
const Parameter* parameter_named(const Product& product, std::string_view name);
/// The first parameter of that role; null if there is none.
const Parameter* parameter_of(const Product& product, ParameterRole role);

std::string_view to_string(Form form);
std::string_view to_string(ParameterRole role);
std::string_view to_string(EvidenceLevel level);  ///< "read", "partly", "unverified"

/// "3", "PV", "false".
std::string text_of(const Value& value);

/// The parameter's formula from its term, e.g. "60 Kp Sy/(Ti Su)"; for a choice the meaning of each value.
std::string formula_text(const Product& product, const Parameter& parameter);

}  // namespace tunewright::product
