// A controller as its maker builds it, described by data: its form, its parameters and what it does with them. A new
// one is an entry of a table (catalogue/) with its example; conversions and search read nothing but this description.
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

/// What a parameter holds: a number, a word (also a code that is typed as text) or a switch.
using Value = std::variant<double, std::string, bool>;

struct Setting {
    std::string name;  ///< Parameter::name
    Value value;

    bool operator==(const Setting&) const = default;
};
using Settings = std::vector<Setting>;

/// The law whose gain and times the formulas of the parameters speak of.
enum class Form {
    ideal,     ///< Kp (e + (1/Ti) int e + Td d/dt ...)
    parallel,  ///< the same law, whose parameters are gains
    series,    ///< Kc (1 + 1/(ti s)) (1 + td s)/(1 + alpha td s), D on the measurement
    p_only,    ///< Kp alone
};

enum class ParameterRole {
    gain,
    multiplier,  ///< of all three parts; read before the gain
    integral,
    derivative,
    filter,
    weight_b,
    weight_c,
    choice,       ///< of weights or filter, by `options`
    sample_time,  ///< the block's own period as it is typed
    fixed,        ///< not part of the twin, which is that of its `standard`
    limit,        ///< of output, integral or tracking: no part of the linear law
};

/// How a parameter depends on the law. A `power` is factor * K^.. * Kp^.. * ... of `Term`; the others say how theirs
/// differs.
enum class Shape {
    power,
    one_minus_b,     ///< 1 - b
    weight,          ///< b or c itself, by role
    feedforward,     ///< (b - 1) Kp; at least 0
    alpha_code,      ///< text "100".."199" for 1 - b = 0.00..0.99; "000" is read as 0.65
    plus_clock,      ///< Tf + dt, dt the clock of the firmware
    lag_per_sample,  ///< Tf/(Tf + dt)
    slope_samples,   ///< M = 1 + 2 Tf/Ts, a slope over M periods of the same delay
    option,          ///< one of `options`
    constant,        ///< `standard`
};

/// Exponents over gain and times of the block's own form, in seconds and units of u per y.
struct Term {
    double factor = 1;
    double Kp = 0, Ti = 0, Td = 0, Tf = 0;
    double ideal_Td = 0;    ///< of the ideal form, where the own one is the series form
    double Sy = 0, Su = 0;  ///< spans of measurement and output
    double Ts = 0;          ///< sample time
    double K = 0;           ///< the multiplier's value
};

/// One of a parameter's choices and what it makes of the law.
struct Option {
    Value value;
    std::optional<double> b = {}, c = {};
    std::optional<FilterType> filter = {};
    /// b and c are those of the parameters weight_b and weight_c, which count with such an option alone.
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
    /// What the models whose manuals were read take at most: more gets a note, for others may take it.
    double usual_max = std::numeric_limits<double>::infinity();
    double resolution = 0;  ///< step of what can be typed; 0: a floating-point number
    /// The maker's default, where it is known; of a filter also what stands where the law leaves it open.
    std::optional<Value> standard = {};
    std::optional<double> off = {};     ///< means: no such part
    std::string_view zero_remark = "";  ///< what 0 does where it does not mean: no such part
    std::vector<Option> options = {};   ///< the first is the maker's default
    bool compiled_in = false;           ///< changed by building the firmware anew alone: a design keeps `standard`
    /// Decided elsewhere than by a design (mode, variant of the block): of choices a design takes the first, others it
    /// leaves out.
    bool elsewhere = false;
    std::string_view remark = "";
};

enum class FilterKind {
    none,
    parameter,    ///< of the derivative, by the parameter of that role
    ratio,        ///< Tf = `value` * td of the own form, fixed
    measurement,  ///< of the second order over the whole measurement, by the parameter
    chosen,       ///< by a parameter which of the two, `parameter` or `measurement`
    slope,        ///< of the derivative over `value` samples, or as many as the parameter says
    four_points,  ///< (3, 1, -1, -3)/(10 Ts), which delays like Tf = Ts
    unknown,      ///< there is one, or may be, but nobody could read it: the twin has none
};

struct FilterRule {
    FilterKind kind = FilterKind::none;
    double value = 0;
    std::string_view text = "";
};

/// Weights where no parameter sets them; of the series form b is of its own gain.
struct Weights {
    double b = 1;
    double c = 0;
    std::string_view text = "";
};

/// How the sign of Kp is typed.
struct Action {
    enum class Kind { signed_gain, switched, reverse_only };
    Kind kind = Kind::signed_gain;
    std::string_view name = "";  ///< the switch, written for direct action alone
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
    bool firmware_clock = false;               ///< that default is fixed, and formulas use it
    std::string_view sample_time_text = "";
};

enum class EvidenceLevel { read, partly, unverified };

struct Evidence {
    EvidenceLevel level = EvidenceLevel::unverified;
    std::vector<std::string_view> read = {};
    std::vector<std::string_view> unverified = {};
    std::vector<std::string_view> sources = {};
};

/// A design of the ideal form with a filter of the derivative, and what is to be typed for it: six digits as published.
struct Example {
    IdealPid design = {};
    double y_span = 200, u_span = 100, sample_time_s = 0.25;
    Settings settings = {};
};

/// What comes with a product for a table of settings, where its maker's text was read.
struct GainScheduling {
    std::size_t sets = 0;                  ///< most rows that it holds; 0: as many as wished
    std::optional<Interpolation> between;  ///< none: a way of its own, told in `text`
    std::string_view text = "";            ///< its name, what it is led by, and how it goes from one set to the next
    std::string_view source = "";
};

struct Product {
    std::string_view id = "", maker = "", name = "";
    Form form = Form::ideal;
    std::string_view law = "";  ///< formula over the parameters' names
    std::string_view gain_basis = "";
    std::vector<Parameter> parameters = {};
    /// The gain's output is in percent and no parameter scales it: u has to be in percent too.
    bool in_percent = false;
    double series_alpha = 0;  ///< of a series form, where no parameter's setting is given
    FilterRule filter = {};
    Weights weights = {};
    Action action = {};
    Algorithm algorithm = {};
    std::vector<std::string_view> traps = {};
    Evidence evidence = {};
    Example example = {};
    std::optional<GainScheduling> scheduling = {};  ///< none: none is known
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

/// The parameter's formula from its term, e.g. "60 Kp Sy/(Ti Su)"; of a choice what each of its values means.
std::string formula_text(const Product& product, const Parameter& parameter);

}  // namespace tunewright::product
