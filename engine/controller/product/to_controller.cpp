#include "engine/controller/product/to_controller.h"

#include <algorithm>
#include <cmath>

#include "engine/controller/product/needs.h"
#include "engine/controller/product/typed.h"
#include "engine/number_text.h"

namespace tunewright::product {
namespace {

constexpr double kUnbounded = std::numeric_limits<double>::infinity();

// The law that the settings define, in seconds and units of u per y, in the block's own form.
struct Law {
    Quantities own;
    double b = 1, c = 0;
    Filter filter = {};
};

Error no_twin(const Product& product, std::string_view name, const std::string& reason) {
    return {ErrorKind::not_representable, "settings/" + std::string(name), std::string(product.name) + ": " + reason};
}

/// A parameter of the law, its product, and its value.
class Reading {
public:
    Reading(const Product& product, const Settings& settings, const Context& context)
        : product_(product), settings_(settings), context_(context) {}

    /// Empty if it is neither given nor known by default.
    std::optional<double> number(const Parameter& parameter) {
        const auto value = number_of(parameter, settings_);
        if (value) note_if_default(parameter, *value);
        if (value && !missing_) missing_ = missing_for(product_, parameter, context_);
        return value;
    }
    const Option& option(const Parameter& parameter) {
        const Option& chosen = option_of(product_, parameter, settings_);
        if (&chosen == &parameter.options.front())
            note_if_default(parameter, chosen.value);
        else if (!setting_named(settings_, parameter.name))
            inferred_ += (inferred_.empty() ? "" : ", ") + std::string(parameter.name) + " = " + text_of(chosen.value);
        return chosen;
    }
    bool counts(const Parameter& parameter) const { return product::counts(product_, parameter, settings_); }
    double alpha(const Parameter& parameter) {
        const Value* given = setting_named(settings_, parameter.name);
        const Value& code = given ? *given : *parameter.standard;
        note_if_default(parameter, code);
        return decoded_alpha(code).value_or(0);
    }
    const std::optional<Error>& missing() const { return missing_; }

    void note_defaults(std::vector<Note>& notes) const {
        std::string words;
        if (!defaults_.empty()) words = "Not given, so the maker's default: " + defaults_ + ".";
        if (!inferred_.empty())
            words += (words.empty() ? "" : " ") +
                     ("Not given, and assumed because the other settings need it: " + inferred_ + ".");
        if (!words.empty()) notes.push_back({"default", std::move(words)});
    }

private:
    void note_if_default(const Parameter& parameter, const Value& value) {
        if (setting_named(settings_, parameter.name)) return;
        defaults_ += (defaults_.empty() ? "" : ", ") + std::string(parameter.name) + " = " + text_of(value);
    }

    const Product& product_;
    const Settings& settings_;
    const Context& context_;
    std::string defaults_ = {}, inferred_ = {};
    std::optional<Error> missing_ = {};
};

// Sets one quantity from the parameter of its role, or to `absent` if that is unknown.
std::optional<double> solve(const Product& product, ParameterRole role, double Quantities::*unknown,
                            double Term::*exponent, const Quantities& own, double absent, Reading& reading) {
    const Parameter* parameter = parameter_of(product, role);
    if (!parameter || !reading.counts(*parameter)) return absent;
    const auto value = reading.number(*parameter);
    if (!value) return absent;
    if (parameter->off && *value == *parameter->off) return absent;
    return solved(parameter->term, own, unknown, parameter->term.*exponent, *value);
}

// -1 if the switch for the action is set to direct.
double sign_of(const Product& product, const Settings& settings) {
    if (product.action.kind != Action::Kind::switched) return 1;
    const Value* given = setting_named(settings, product.action.name);
    return given && *given == product.action.direct ? -1 : 1;
}

std::optional<Error> read_gain(const Product& product, const Settings& settings, Reading& reading, Quantities& own) {
    if (const Parameter* multiplier = parameter_of(product, ParameterRole::multiplier))
        own.K = reading.number(*multiplier).value_or(1);
    const Parameter& gain = *parameter_of(product, ParameterRole::gain);
    if (!setting_named(settings, gain.name))
        return Error{ErrorKind::invalid_argument, "settings/" + std::string(gain.name),
                     std::string(gain.name) + " is missing; it is the gain of " + std::string(product.name) + "."};
    own.Kp = solve(product, ParameterRole::gain, &Quantities::Kp, &Term::Kp, own, 0, reading).value_or(0);
    if (own.Kp == 0 || !std::isfinite(own.Kp))
        return no_twin(product, gain.name,
                       std::string(gain.name) +
                           " leaves no proportional part, but the ideal form's times are ratios to it. Give a gain "
                           "that is not 0.");
    if (product.action.kind != Action::Kind::signed_gain && own.Kp < 0)
        return Error{ErrorKind::invalid_argument, "settings/" + std::string(gain.name),
                     std::string(gain.name) + " is negative, which " + std::string(product.name) +
                         " does not "
                         "accept. " +
                         std::string(product.action.text)};
    return std::nullopt;
}

std::optional<Error> read_times(const Product& product, Reading& reading, Quantities& own) {
    const auto Ti = solve(product, ParameterRole::integral, &Quantities::Ti, &Term::Ti, own, kUnbounded, reading);
    own.Ti = std::abs(*Ti) == kUnbounded ? kUnbounded : *Ti;
    own.Td = *solve(product, ParameterRole::derivative, &Quantities::Td, &Term::Td, own, 0, reading);
    if (own.Ti > 0 && own.Td >= 0) return std::nullopt;
    const ParameterRole role = own.Ti > 0 ? ParameterRole::derivative : ParameterRole::integral;
    const Parameter& parameter = *parameter_of(product, role);
    return no_twin(product, parameter.name,
                   std::string(parameter.name) + " gives a " + (role == ParameterRole::integral ? "Ti" : "Td") +
                       " of " + text(role == ParameterRole::integral ? own.Ti : own.Td) +
                       " s; it must have the gain's sign, and an integral time must be above 0.");
}

IdealPid ideal_without_filter(const Product& product, const Law& law) {
    if (product.form != Form::series)
        return {.Kp = law.own.Kp, .Ti = law.own.Ti, .Td = law.own.Td, .b = law.b, .c = law.c};
    const SeriesPid series{.Kp = law.own.Kp, .Ti = law.own.Ti, .Td = law.own.Td, .b = law.b, .c = law.c};
    return *to_ideal(series);
}

double filter_by_parameter(const Product& product, const Clocks& clocks, Reading& reading, const Quantities& own) {
    const Parameter* parameter = parameter_of(product, ParameterRole::filter);
    const auto value = parameter ? reading.number(*parameter) : std::nullopt;
    if (!value || (parameter->off && *value == *parameter->off)) return 0;
    const double clock = product.algorithm.firmware_clock ? clocks.firmware : own.Ts;
    return filter_time(*parameter, own, clock, *value);
}

Filter read_filter(const Product& product, const Settings& settings, const Clocks& clocks, Reading& reading,
                   const Quantities& own) {
    Filter filter{FilterType::derivative, 0};
    switch (product.filter.kind) {
        case FilterKind::none:
        case FilterKind::unknown: break;
        case FilterKind::ratio: filter.Tf = product.filter.value * own.Td; break;
        case FilterKind::parameter: filter.Tf = filter_by_parameter(product, clocks, reading, own); break;
        case FilterKind::measurement:
            filter = {FilterType::measurement_second_order, filter_by_parameter(product, clocks, reading, own)};
            break;
        case FilterKind::chosen:
            for (const Parameter& parameter : product.parameters) {
                if (parameter.role != ParameterRole::choice) continue;
                if (const auto chosen = option_of(product, parameter, settings).filter) filter.type = *chosen;
            }
            filter.Tf = filter_by_parameter(product, clocks, reading, own);
            break;
        case FilterKind::slope:
            filter.Tf = parameter_of(product, ParameterRole::filter)
                            ? filter_by_parameter(product, clocks, reading, own)
                            : slope_filter_time(product.filter.value, own.Ts);
            break;
        case FilterKind::four_points: filter.Tf = own.Ts; break;
    }
    const bool idle = filter.type == FilterType::derivative && own.Td == 0;
    return idle || !(filter.Tf > 0) ? Filter{} : filter;
}

// Reads the weights, which no term defines: they come from options, from parameters, or are fixed by the block.
void read_weights(const Product& product, Reading& reading, Law& law) {
    law.b = product.weights.b;
    law.c = product.weights.c;
    for (const Parameter& parameter : product.parameters) {
        if (parameter.shape == Shape::option) {
            const Option& option = reading.option(parameter);
            law.b = option.b.value_or(law.b);
            law.c = option.c.value_or(law.c);
        } else if (!reading.counts(parameter)) {
            continue;
        } else if (parameter.shape == Shape::alpha_code) {
            law.b = 1 - reading.alpha(parameter);
        } else if (parameter.shape == Shape::weight) {
            double& weight = parameter.role == ParameterRole::weight_b ? law.b : law.c;
            weight = reading.number(parameter).value_or(weight);
        } else if (parameter.shape == Shape::one_minus_b) {
            if (const auto share = reading.number(parameter)) law.b = 1 - *share;
        } else if (parameter.shape == Shape::feedforward) {
            if (const auto gain = reading.number(parameter)) law.b = 1 + *gain / law.own.Kp;
        }
    }
}

void note_outsiders(const Product& product, const Settings& settings, std::vector<Note>& notes) {
    for (const Parameter& parameter : product.parameters) {
        const Value* given = setting_named(settings, parameter.name);
        if (given && !counts(product, parameter, settings))
            notes.push_back({"outside-the-twin", std::string(parameter.name) + " is " + text_of(*given) +
                                                     "; it has no effect with the other settings that are chosen."});
        if (parameter.role != ParameterRole::fixed || !given || !parameter.standard || *given == *parameter.standard)
            continue;
        notes.push_back({"outside-the-twin", std::string(parameter.name) + " is " + text_of(*given) +
                                                 "; the equivalent controller is that "
                                                 "of " +
                                                 text_of(*parameter.standard) + " and does not include its effect."});
    }
}

void note_zeros(const Product& product, const Settings& settings, std::vector<Note>& notes) {
    for (const Parameter& parameter : product.parameters) {
        const Value* given = setting_named(settings, parameter.name);
        if (given && *given == Value(0.0) && !parameter.zero_remark.empty())
            notes.push_back({"integral-off", std::string(parameter.zero_remark)});
    }
    const Parameter* integral = parameter_of(product, ParameterRole::integral);
    if (integral && !number_of(*integral, settings) && counts(product, *integral, settings))
        notes.push_back({"integral-off", std::string(integral->name) +
                                             " is not given and its default is unknown: the equivalent controller has "
                                             "no integral action."});
}

// The series form's filter covers its whole lead: weights, times and filter of its equivalent come from one conversion.
IdealPid twin(const Product& product, const Law& law) {
    if (product.form == Form::series && law.filter.type == FilterType::derivative) {
        const SeriesPid series{
            .Kp = law.own.Kp, .Ti = law.own.Ti, .Td = law.own.Td, .b = law.b, .c = law.c, .filter = law.filter};
        return *to_ideal(series);
    }
    IdealPid pid = ideal_without_filter(product, law);
    pid.filter = law.filter;
    return pid;
}

// Error of settings without an equivalent ideal form: a filter that lets nothing pass, or a series lead that is shorter
// than its own filter.
std::optional<Error> beyond(const Product& product, const IdealPid& pid) {
    const auto at = [&](ParameterRole role, const std::string& reason) {
        const Parameter* parameter = parameter_of(product, role);
        return no_twin(product, parameter ? parameter->name : product.parameters.front().name, reason);
    };
    if (!std::isfinite(pid.filter.Tf))
        return at(ParameterRole::filter,
                  "the filter's time becomes infinite and removes the derivative. Give another value, or no "
                  "derivative.");
    if (pid.Td < 0)
        return at(ParameterRole::derivative,
                  "the filter time is longer than the integral time, which makes the ideal "
                  "form's Td " +
                      text(pid.Td) + ". Use a shorter derivative time or a smaller ratio of the filter.");
    if (!std::isfinite(pid.Kp) || !std::isfinite(pid.Td) || std::isnan(pid.Ti) || !std::isfinite(pid.b))
        return at(ParameterRole::gain, "the result is out of the number range.");
    return std::nullopt;
}

}  // namespace

Expected<IdealPid> to_controller(const Product& product, const Settings& settings, const Context& context,
                                 std::vector<Note>& notes) {
    if (auto wrong = wrong_setting(product, settings)) return *wrong;
    Reading reading(product, settings, context);
    Law law;
    law.own = quantities_of(product, context);
    bool period_known = clocks_of(product, context).sample_time.has_value();
    if (const Parameter* period = parameter_of(product, ParameterRole::sample_time)) {
        if (const auto value = number_of(*period, settings)) {
            law.own.Ts = solved(period->term, law.own, &Quantities::Ts, period->term.Ts, *value);
            period_known = true;
        }
    }
    if (auto wrong = read_gain(product, settings, reading, law.own)) return *wrong;
    if (auto wrong = read_times(product, reading, law.own)) return *wrong;
    read_weights(product, reading, law);
    law.own.ideal_Td = ideal_without_filter(product, law).Td;
    if (!period_known) {
        if (auto missing = missing_for_filter(product, context)) return *missing;
    }
    law.filter = read_filter(product, settings, clocks_of(product, context), reading, law.own);
    if (reading.missing()) return *reading.missing();

    IdealPid pid = twin(product, law);
    if (auto wrong = beyond(product, pid)) return *wrong;
    const double unit = context.seconds_per_time;
    pid.Kp *= sign_of(product, settings);
    pid.Ti /= unit;
    pid.Td /= unit;
    pid.filter.Tf /= unit;
    reading.note_defaults(notes);
    note_outsiders(product, settings, notes);
    note_zeros(product, settings, notes);
    return pid;
}

SampledPid sampled_law(const Product& product, const Settings& settings, const Context& context, double Ts) {
    Context running = context;
    running.sample_time_s = running.loop_clock_s = Ts * context.seconds_per_time;
    std::vector<Note> ignored;
    const auto pid = to_controller(product, settings, running, ignored);
    SampledPid law;
    if (pid) law.gains = gains(*pid);
    law.Ts = Ts;
    law.integral = product.algorithm.integral;
    law.derivative = product.algorithm.derivative;
    law.trapezoidal_filter = law.derivative == DerivativeRule::filtered_trapezoidal;
    law.velocity = product.algorithm.velocity;
    if (product.filter.kind == FilterKind::slope) {
        const Parameter* samples = parameter_of(product, ParameterRole::filter);
        const double M = samples ? number_of(*samples, settings).value_or(1) : product.filter.value;
        law.slope_samples = whole_samples(M);
    }
    return law;
}

}  // namespace tunewright::product
