#include "engine/controller/product/settings.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "engine/controller/product/needs.h"
#include "engine/controller/product/notes.h"
#include "engine/controller/product/series.h"
#include "engine/controller/product/to_controller.h"
#include "engine/controller/product/typed.h"
#include "engine/number_text.h"

namespace tunewright::product {
namespace {

/// A conversion in progress: always to the nearest settings, with a note for each thing that the block cannot do.
struct Work {
    const Product& product;
    const IdealPid& pid;  ///< in the caller's unit of time
    const Context& context;
    Quantities own = {};
    Settings choices = {};  ///< the chosen options, before the other parameters are set
    Settings settings = {};
    std::vector<Note> notes = {};
    std::vector<std::string> refusals = {};
    std::string_view beyond = "";  ///< name of a parameter whose value is out of the number range
};

double alpha_of(const Product& product) {
    return product.filter.kind == FilterKind::ratio ? product.filter.value : product.series_alpha;
}

void refuse_complex_zeros(const RatioSeries& series, Work& work) {
    const double unit = work.context.seconds_per_time;
    work.refusals.push_back(
        "Its form is a series, whose zeros are real: Ti = " + text(work.pid.Ti) + " is below " +
        text(series.deviation->min_Ti / unit) + ", 4 Td/(1 - alpha) with alpha = " + text(alpha_of(work.product)) +
        ". The nearest settings: both times sqrt(Ti Td) = " + text(series.ti / unit) + " and a gain of " +
        text(series.Kc / work.own.Kp) + " Kp. They keep the integral gain; the proportional gain becomes " +
        text(series.deviation->proportional) + " times and the derivative gain " + text(series.deviation->derivative) +
        " times the design's. A tuning for this block, under that limit, is better.");
}

void set_sign(Work& work) {
    const Action& action = work.product.action;
    if (work.pid.Kp > 0 || action.kind == Action::Kind::signed_gain) return;
    work.own.Kp = -work.own.Kp;
    if (action.kind == Action::Kind::reverse_only) {
        work.refusals.push_back(
            "Its gain cannot be negative and it has no switch for the direction, but Kp = " + text(work.pid.Kp) +
            ". The nearest setting is the same gain with the opposite sign, for an inverted actuator. " +
            std::string(action.text));
    }
}

void set_own_form(Work& work) {
    const double unit = work.context.seconds_per_time;
    const IdealPid& pid = work.pid;
    Quantities& own = work.own;
    own.Kp = pid.Kp;
    set_sign(work);
    own.Ti = pid.Ti * unit;
    own.Td = own.ideal_Td = pid.Td * unit;
    own.Tf = pid.filter.type == FilterType::none ? 0 : pid.filter.Tf * unit;
    if (work.product.form == Form::p_only && (pid.has_integral() || pid.Td != 0)) {
        work.notes.push_back({"proportional-only",
                              "The block has no integral and no derivative action: it has only the proportional part "
                              "of the design, which gives another loop."});
    }
    if (work.product.form != Form::series) return;
    const double alpha = alpha_of(work.product);
    const RatioSeries series = ratio_series(own.Kp, own.Ti, own.Td, alpha);
    if (series.deviation) refuse_complex_zeros(series, work);
    own.Kp = series.Kc;
    own.Ti = series.ti;
    own.Td = series.td;
    if (series.deviation) own.ideal_Td = to_ideal(SeriesPid{.Kp = own.Kp, .Ti = own.Ti, .Td = own.Td})->Td;
    if (alpha > 0) own.Tf = alpha * series.td;
}

// If one option sets both weights, c decides only among options with the same b. Free weights cost less than any
// difference that matters, so they are chosen unless fixed weights equal the design's.
constexpr double kLessThanB = 1e-6, kFreeWeights = 1e-12;
constexpr double kActionMismatchCost = 10;  ///< cost of an action too many or missing: more than weights can differ

bool law_role(ParameterRole role) {
    return role == ParameterRole::gain || role == ParameterRole::multiplier || role == ParameterRole::integral ||
           role == ParameterRole::derivative || role == ParameterRole::sample_time;
}

constexpr double kMaxIntegralTime = 1e6;  // s, largest integral time that is entered for no integral action

// The value for a law without integral action, or the nearest one.
std::optional<double> without_integral(const Parameter& parameter, Work& work) {
    if (parameter.off) return *parameter.off;
    Quantities slow = work.own;
    slow.Ti = kMaxIntegralTime;
    const double longest = rounded(parameter, value_of(parameter.term, slow));
    slow.Ti = solved(parameter.term, work.own, &Quantities::Ti, parameter.term.Ti, longest);
    work.refusals.push_back(std::string(parameter.name) +
                            " has no known value that switches integral action off, and the design has no integral "
                            "action. The nearest setting: " +
                            std::string(parameter.name) + " = " + text(longest, 6) + ", an integral time of " +
                            text(slow.Ti / work.context.seconds_per_time, 3) +
                            ". On a plant with times as long as that the loop differs: evaluate it with the realised "
                            "controller.");
    return longest;
}

// Limits a value that the law determines to the parameter's range.
double within_range(const Parameter& parameter, double value, Work& work) {
    const double typed = rounded(parameter, value);
    if (typed > parameter.usual_max)
        work.notes.push_back({"range", std::string(parameter.name) + " is " + text(typed, 6) +
                                           ", and not every model accepts it. " + std::string(parameter.remark)});
    const bool inside = value >= parameter.range.low - parameter.resolution / 2 &&
                        value <= parameter.range.high + parameter.resolution / 2;
    if (inside || (parameter.off && value == *parameter.off)) return value;
    if (law_role(parameter.role)) {
        work.refusals.push_back(std::string(parameter.name) + " would be " + text(value, 6) + ", but it accepts " +
                                range_text(parameter) + ". The nearest: " + std::string(parameter.name) + " = " +
                                text(typed, 6) + ".");
    } else if (parameter.role == ParameterRole::filter) {
        work.notes.push_back({"range", std::string(parameter.name) + " would be " + text(value, 6) +
                                           ", but it "
                                           "accepts " +
                                           range_text(parameter) + ": it is " + text(typed, 6) + "."});
    }
    return typed;
}

/// The tracking time of back-calculation, sqrt(Ti Td), is Ti without a derivative.
Term term_of(const Parameter& parameter, const Quantities& own) {
    Term term = parameter.term;
    if (parameter.role == ParameterRole::limit && own.Td == 0) term.Ti += std::exchange(term.Td, 0);
    return term;
}

std::optional<double> number_for(const Parameter& parameter, Work& work) {
    if (parameter.role == ParameterRole::integral && !work.pid.has_integral() && work.own.Ti > 0) {
        const double value = value_of(parameter.term, work.own);
        if (std::isinf(value)) return without_integral(parameter, work);
        if (!parameter.zero_remark.empty()) work.notes.push_back({"integral-off", std::string(parameter.zero_remark)});
    }
    const Clocks clocks = clocks_of(work.product, work.context);
    const double clock = work.product.algorithm.firmware_clock ? clocks.firmware : work.own.Ts;
    const double value = parameter.role == ParameterRole::filter ? filter_value(parameter, work.own, clock)
                                                                 : value_of(term_of(parameter, work.own), work.own);
    if (std::isfinite(value) && !(parameter.role == ParameterRole::filter && work.own.Td == 0 &&
                                  work.product.filter.kind == FilterKind::parameter && parameter.standard))
        return within_range(parameter, value, work);
    if (law_role(parameter.role)) work.beyond = parameter.name;
    // The law does not determine this parameter, because it has no derivative or no filter.
    if (parameter.off && work.own.Tf == 0) return parameter.off;
    return number_of(parameter, {});
}

const Option& nearest_option(const Parameter& parameter, const IdealPid& pid) {
    const auto distance = [&](const Option& option) {
        double sum = option.free_weights ? kFreeWeights : 0;
        if (option.integral.value_or(true) != pid.has_integral()) sum += kActionMismatchCost;
        if (option.derivative.value_or(true) != (pid.Td != 0)) sum += kActionMismatchCost;
        if (option.b) sum += std::abs(*option.b - pid.b);
        if (option.c && pid.Td != 0) sum += kLessThanB * std::abs(*option.c - pid.c);
        const bool measured = pid.filter.type == FilterType::measurement_first_order ||
                              pid.filter.type == FilterType::measurement_second_order;
        if (option.filter) sum += (*option.filter == FilterType::measurement_second_order) != measured;
        return sum;
    };
    // If two options are equally near, the one with the smaller set-point weight is chosen.
    const Option* best = &parameter.options.front();
    for (const Option& option : parameter.options) {
        const double difference = distance(option) - distance(*best);
        if (difference < 0 || (difference == 0 && option.b.value_or(0) < best->b.value_or(0))) best = &option;
    }
    return *best;
}

void add(const Parameter& parameter, Value value, Work& work) {
    work.settings.push_back({std::string(parameter.name), std::move(value)});
}

void add_setting(const Parameter& parameter, Work& work) {
    const IdealPid& pid = work.pid;
    switch (parameter.shape) {
        case Shape::option: return add(parameter, *setting_named(work.choices, parameter.name), work);
        case Shape::constant: return add(parameter, parameter.standard.value_or(0.0), work);
        case Shape::alpha_code: return add(parameter, encoded_alpha(1 - pid.b), work);
        case Shape::one_minus_b: return add(parameter, within_range(parameter, 1 - pid.b, work), work);
        case Shape::weight:
            return add(parameter,
                       within_range(parameter, parameter.role == ParameterRole::weight_b ? pid.b : pid.c, work), work);
        case Shape::feedforward: return add(parameter, within_range(parameter, (pid.b - 1) * work.own.Kp, work), work);
        default: break;
    }
    const auto value = number_for(parameter, work);
    if (parameter.role == ParameterRole::multiplier && value) work.own.K = *value;
    if (parameter.compiled_in && value && parameter.standard && Value(*value) != *parameter.standard)
        work.notes.push_back({"compiled-in", std::string(parameter.name) + " is " + text(*value, 4) + " here and " +
                                                 text_of(*parameter.standard) +
                                                 " in the published firmware; unless you build the firmware with "
                                                 "another value, the loop differs. A tuning for this product keeps the "
                                                 "published value."});
    if (value) add(parameter, *value, work);
}

void choose(Work& work) {
    for (const Parameter& parameter : work.product.parameters) {
        if (parameter.shape != Shape::option) continue;
        const Option& option = parameter.elsewhere ? parameter.options.front() : nearest_option(parameter, work.pid);
        work.choices.push_back({std::string(parameter.name), option.value});
    }
}

std::optional<Error> add_settings(Work& work) {
    choose(work);
    for (const Parameter& parameter : work.product.parameters) {
        if (parameter.elsewhere && parameter.shape != Shape::option) continue;
        if (!counts(work.product, parameter, work.choices)) continue;
        if (auto missing = missing_for(work.product, parameter, work.context)) {
            if (parameter.role != ParameterRole::limit) return missing;
            work.notes.push_back({"limit", std::string(parameter.name) + " is not computed: it is " +
                                               formula_text(work.product, parameter) + ", which needs u_span. " +
                                               std::string(parameter.remark)});
            continue;
        }
        add_setting(parameter, work);
    }
    const Action& action = work.product.action;
    if (action.kind == Action::Kind::switched && work.pid.Kp < 0) {
        work.settings.push_back({std::string(action.name), action.direct});
        work.notes.push_back(
            {"action", "Kp is negative: the gain is entered without its sign, and the direction is set by " +
                           std::string(action.name) + ". " + std::string(action.text)});
    }
    // A switch that keeps its initial value, 0 or false, would act in the wrong direction.
    const bool initial = action.reverse == Value(0.0) || action.reverse == Value(false);
    if (action.kind == Action::Kind::switched && work.pid.Kp > 0 && !initial &&
        !std::holds_alternative<std::string>(action.reverse))
        work.notes.push_back({"action", "Kp is positive, so " + std::string(action.name) + " must be " +
                                            text_of(action.reverse) + ". " + std::string(action.text)});
    return std::nullopt;
}

std::optional<Error> unusable(const Product& product, const IdealPid& pid) {
    if (pid.Kp == 0 || !std::isfinite(pid.Kp))
        return Error{ErrorKind::not_representable, "controller/Kp",
                     std::string(product.name) + ": Kp is " + text(pid.Kp) +
                         "; without a proportional part there is no ideal form to convert. The nearest controller has "
                         "a small Kp with Ti = Kp/Ki."};
    if (!(pid.Ti > 0) || !(pid.Td >= 0) || !std::isfinite(pid.Td) || !std::isfinite(pid.b) || !std::isfinite(pid.c))
        return Error{ErrorKind::invalid_argument, "controller",
                     "Ti must be above 0, Td at least 0, and b and c numbers."};
    return std::nullopt;
}

Error refusal(const Work& work) {
    std::string message = std::string(work.product.name) + " cannot represent this controller.";
    for (const std::string& sentence : work.refusals) message += " " + sentence;
    return {ErrorKind::not_representable, "controller", std::move(message)};
}

}  // namespace

Expected<Converted> to_settings(const Product& product, const IdealPid& pid, const Context& context, bool nearest) {
    if (auto error = unusable(product, pid)) return *error;
    if (auto missing = missing_for_filter(product, context)) return *missing;
    Work work{.product = product, .pid = pid, .context = context};
    work.own = quantities_of(product, context);
    set_own_form(work);
    if (auto missing = add_settings(work)) return *missing;
    if (!work.beyond.empty())
        return Error{ErrorKind::invalid_argument, "controller",
                     std::string(work.beyond) +
                         " would be out of the number range. Check the controller and the "
                         "spans."};
    if (!work.refusals.empty() && !nearest) return refusal(work);

    const Settings typed = as_typed(product, work.settings);
    std::vector<Note> ignored;
    auto realised = to_controller(product, typed, context, ignored);
    if (!realised) return realised.error();
    Converted converted{.settings = std::move(work.settings), .realised = *realised};
    for (std::string& sentence : work.refusals) converted.notes.push_back({"nearest", std::move(sentence)});
    for (Note& note : work.notes) converted.notes.push_back(std::move(note));
    add_notes({product, pid, converted.realised, context, converted.settings, typed}, converted.notes);
    return converted;
}

std::optional<double> default_sample_time_s(const Product& product) { return product.algorithm.sample_time_s; }

std::optional<double> compiled_filter_time(const Product& product, const Context& context) {
    const Parameter* parameter = parameter_of(product, ParameterRole::filter);
    if (parameter == nullptr || !parameter->compiled_in) return std::nullopt;
    const double* published = std::get_if<double>(&*parameter->standard);
    const Quantities quantities = quantities_of(product, context);
    return filter_time(*parameter, quantities, clocks_of(product, context).firmware, *published);
}

std::vector<Tunable> tunable_parameters(const Product& product) {
    std::vector<Tunable> tunable;
    for (const Parameter& parameter : product.parameters) {
        const ParameterRole role = parameter.role;
        const bool law =
            role == ParameterRole::gain || role == ParameterRole::integral || role == ParameterRole::derivative;
        if (!law && role != ParameterRole::filter) continue;
        tunable.push_back({std::string(parameter.name), role, parameter.range, parameter.resolution});
    }
    return tunable;
}

namespace {

void note_scheduling(const Product& product, const Schedule& schedule, std::vector<Note>& notes) {
    if (!product.scheduling) {
        notes.push_back(
            {"no-gain-scheduling",
             "No gain scheduling of this product is known here. Another program can write the settings of the rows; "
             "make sure that a change does not make the output jump."});
        return;
    }
    const GainScheduling& own = *product.scheduling;
    if (own.sets > 0 && schedule.rows.size() > own.sets)
        notes.push_back({"too-many-rows", "The schedule has " + std::to_string(schedule.rows.size()) +
                                              " rows, but the product has at most " + std::to_string(own.sets) +
                                              " sets. Design it with rows = " + std::to_string(own.sets) + "."});
    if (schedule.rows.size() < 2 || own.between == schedule.interpolation) return;
    std::string detail = "The schedule is designed for " + std::string(to_string(schedule.interpolation)) +
                         "; the product interpolates differently between its rows: " + std::string(own.text);
    if (own.between)
        detail += " Design it with interpolation = " + std::string(to_string(*own.between)) + ".";
    else
        detail += " At the rows themselves the settings are exact.";
    notes.push_back({"interpolation", std::move(detail)});
}

bool is_switched(const Product& product, const std::string& name) {
    const Parameter* parameter = parameter_named(product, name);
    if (parameter == nullptr) return true;
    using enum ParameterRole;
    return parameter->role == gain || parameter->role == integral || parameter->role == derivative;
}

/// The gain scheduling of the known products switches only gain and times.
void note_held(const Product& product, ConvertedSchedule& answer) {
    if (!product.scheduling) return;
    std::vector<std::string> held;
    for (const RowSettings& row : answer.rows)
        for (const Setting& setting : row.converted.settings) {
            const bool differs = std::ranges::any_of(answer.rows, [&](const RowSettings& other) {
                return std::ranges::any_of(other.converted.settings, [&](const Setting& its) {
                    return its.name == setting.name && its.value != setting.value;
                });
            });
            if (differs && !is_switched(product, setting.name) && std::ranges::find(held, setting.name) == held.end())
                held.push_back(setting.name);
        }
    if (held.empty()) return;
    std::string names;
    for (const std::string& name : held) names += (names.empty() ? "" : ", ") + name;
    answer.notes.push_back({"held-between-rows",
                            "The rows differ in " + names + ", which the product's gain scheduling does not switch: " +
                                std::string(product.scheduling->text) +
                                " Give all rows the same filter and set-point weight, or write these values with your "
                                "own program."});
}

bool holds(const std::vector<Note>& notes, const Note& note) { return std::ranges::find(notes, note) != notes.end(); }

/// A note that every row has is stated once.
void lift_common_notes(ConvertedSchedule& answer) {
    std::vector<RowSettings>& rows = answer.rows;
    std::vector<Note> common;
    for (const Note& note : rows.front().converted.notes)
        if (std::all_of(rows.begin(), rows.end(),
                        [&](const RowSettings& row) { return holds(row.converted.notes, note); }))
            common.push_back(note);
    for (RowSettings& row : rows)
        std::erase_if(row.converted.notes, [&](const Note& note) { return holds(common, note); });
    answer.notes.insert(answer.notes.end(), common.begin(), common.end());
}

}  // namespace

Expected<ConvertedSchedule> to_settings(const Product& product, const Schedule& schedule, const Context& context,
                                        bool nearest) {
    ConvertedSchedule answer;
    note_scheduling(product, schedule, answer.notes);
    for (const ScheduleRow& row : schedule.rows) {
        auto converted = to_settings(product, controller_of(row), context, nearest);
        if (!converted) {
            Error error = converted.error();
            if (error.kind == ErrorKind::not_representable) error.where = "rows/" + std::to_string(answer.rows.size());
            return error;
        }
        answer.rows.push_back({row.at, *std::move(converted)});
    }
    lift_common_notes(answer);
    note_held(product, answer);
    return answer;
}

}  // namespace tunewright::product
