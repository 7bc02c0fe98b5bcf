#include "engine/controller/product/notes.h"

#include <algorithm>
#include <cmath>

#include "engine/controller/product/needs.h"
#include "engine/controller/product/typed.h"
#include "engine/number_text.h"

namespace tunewright::product {
namespace {

constexpr double kEqualTolerance = 1e-9;

bool same(double a, double b) {
    return a == b || (std::isfinite(a) && std::isfinite(b) &&
                      std::abs(a - b) <= kEqualTolerance * std::max(std::abs(a), std::abs(b)));
}

std::string with_text(const std::string& sentence, std::string_view text) {
    return text.empty() ? sentence : sentence + " " + std::string(text);
}

// "1 + 72 s + 5 s^2/(1 + 2 s)": b Ti s and c Ti Td s^2/(1 + Tf s).
std::string weighted(const IdealPid& pid, double b, double c) {
    std::string text = "1";
    if (b != 0) text += " + " + tunewright::text(b * pid.Ti) + " s";
    if (c == 0 || pid.Td == 0) return text;
    text += " + " + tunewright::text(c * pid.Ti * pid.Td) + " s^2";
    if (pid.filter.type == FilterType::derivative) text += "/(1 + " + tunewright::text(pid.filter.Tf) + " s)";
    return text;
}

void note_weights(const Comparison& it, std::vector<Note>& notes) {
    const bool derivative = it.asked.Td != 0;
    if (it.asked.setpoint_lag > 0)
        notes.push_back({"setpoint-filter", "The design filters the set point, 1/(1 + " +
                                                tunewright::text(it.asked.setpoint_lag) +
                                                " s), but the block has no setting for it. Put that lag before its set "
                                                "point, or ramp the set point over about that time."});
    const bool b_differs = !same(it.asked.b, it.realised.b);
    const bool c_differs = derivative && !same(it.asked.c, it.realised.c);
    if (!b_differs && !c_differs) return;
    std::string sentence = "The block weights the set point with b = " + text(it.realised.b);
    if (derivative) sentence += ", c = " + text(it.realised.c);
    sentence += ", the design with b = " + text(it.asked.b);
    if (derivative) sentence += ", c = " + text(it.asked.c);
    sentence += "; the response to loads does not depend on the weights.";
    notes.push_back({"setpoint-weights", with_text(sentence, it.product.weights.text)});
    const std::string prefilter = setpoint_prefilter(it.asked, it.realised);
    if (prefilter.empty()) return;
    notes.push_back(
        {"prefilter", "A filter of the set point before the block restores the design's response: " + prefilter + "."});
}

std::string filter_words(const Filter& filter) {
    switch (filter.type) {
        case FilterType::none: return "no filter";
        case FilterType::derivative: return "a first-order filter of the derivative, Tf = " + text(filter.Tf);
        case FilterType::measurement_first_order:
            return "a first-order filter of the measurement, Tf = " + text(filter.Tf);
        case FilterType::measurement_second_order:
            return "a second-order filter of the measurement, Tf = " + text(filter.Tf);
    }
    return "no filter";
}

// For a series block whose filter ratio can be set: reports another ratio with which the block has the design's own
// filter.
void note_other_ratio(const Comparison& it, std::vector<Note>& notes) {
    const Parameter* ratio = parameter_of(it.product, ParameterRole::filter);
    if (it.product.form != Form::series || it.product.filter.kind != FilterKind::parameter || !ratio) return;
    if (it.asked.filter.type != FilterType::derivative || it.asked.Td == 0) return;
    const auto series = to_series(it.asked);
    if (!series || series->Td == 0) return;
    const double unit = it.context.seconds_per_time;
    Quantities own = quantities_of(it.product, it.context);
    own.Kp = std::abs(series->Kp);
    own.Ti = series->Ti * unit;
    own.Td = series->Td * unit;
    own.Tf = it.asked.filter.Tf * unit;
    const double alpha = value_of(ratio->term, own);
    if (alpha < ratio->range.low || alpha > ratio->range.high) return;
    std::string settings;
    for (const Parameter& parameter : it.product.parameters) {
        if (parameter.shape == Shape::power)
            settings += (settings.empty() ? "" : ", ") + std::string(parameter.name) + " = " +
                        text(value_of(parameter.term, own), 6);
    }
    notes.push_back({"filter-ratio", "With " + settings + " the block has the design's own filter, exactly."});
}

void note_filter(const Comparison& it, std::vector<Note>& notes) {
    const FilterKind kind = it.product.filter.kind;
    const Filter& asked = it.asked.filter;
    const Filter& realised = it.realised.filter;
    const bool derivative = it.realised.Td != 0;
    const bool idle = !derivative && asked.type != FilterType::measurement_first_order &&
                      asked.type != FilterType::measurement_second_order && realised.type == FilterType::none;
    // A slope over one sample is a plain difference.
    const bool slope = derivative && realised.type != FilterType::none &&
                       (kind == FilterKind::slope || kind == FilterKind::four_points);
    if (idle || (asked.type == realised.type && same(asked.Tf, realised.Tf) && !slope &&
                 !(derivative && kind == FilterKind::unknown)))
        return;
    std::string sentence = "The design has " + filter_words(asked) + "; the block has " + filter_words(realised) + ".";
    if (slope) sentence += " It approximates a slope over several samples with the same delay.";
    if (asked.type == FilterType::measurement_first_order || asked.type == FilterType::measurement_second_order) {
        if (realised.type != asked.type)
            sentence +=
                " To keep the design's filter, filter the measurement before the "
                "block.";
    } else if (realised.type == FilterType::none && kind != FilterKind::unknown) {
        sentence += " Filter the measurement before the block, and tune with that filter.";
    }
    notes.push_back({"filter", with_text(sentence, it.product.filter.text)});
}

void note_rounding(const Comparison& it, std::vector<Note>& notes) {
    std::string which;
    for (std::size_t i = 0; i < it.settings.size(); ++i) {
        const double* exact = std::get_if<double>(&it.settings[i].value);
        const double* typed = std::get_if<double>(&it.typed[i].value);
        if (!exact || !typed || same(*exact, *typed)) continue;
        which += (which.empty() ? "" : ", ") + it.settings[i].name + " " + typed_text(it.product, it.settings[i]) +
                 " for " + text(*exact, 6);
    }
    if (which.empty()) return;
    notes.push_back(
        {"rounding", "The block accepts only steps: " + which + ". Evaluate the loop with the realised controller."});
}

const char* rule_name(IntegralRule rule) {
    switch (rule) {
        case IntegralRule::backward: return "backward";
        case IntegralRule::forward: return "forward";
        case IntegralRule::trapezoidal: return "trapezoidal";
    }
    return "backward";
}

/// The input of the notes on a block itself.
struct BlockLaw {
    const Product& product;
    const IdealPid& realised;
    const Context& context;
};

/// A first-order lag by forward differences multiplies its state by 1 - Ts/Tf in each sample.
void note_unstable_filter(const BlockLaw& it, std::vector<Note>& notes) {
    const auto Ts = clocks_of(it.product, it.context).sample_time;
    const double unit = it.context.seconds_per_time, Tf = it.realised.filter.Tf;
    if (!Ts || it.product.algorithm.derivative != DerivativeRule::filtered_forward || it.realised.Td == 0) return;
    if (it.realised.filter.type != FilterType::derivative || !(Tf > 0) || Tf * unit > *Ts / 2) return;
    notes.push_back(
        {"unstable-filter", "The block filters its derivative by forward differences, which is unstable with Tf = " +
                                text(Tf) + " at a sample time of " + text(*Ts / unit) +
                                ": Tf must be above half of it. Use a longer Tf, or a shorter sample time."});
}

void note_algorithm(const BlockLaw& it, std::vector<Note>& notes) {
    const Algorithm& algorithm = it.product.algorithm;
    if (!algorithm.published) {
        notes.push_back({"discretisation",
                         "The block's rules for its integral and derivative are unknown; backward differences are "
                         "assumed."});
    } else if (algorithm.integral != IntegralRule::backward && it.realised.has_integral()) {
        notes.push_back({"discretisation", std::string("The block integrates by the ") + rule_name(algorithm.integral) +
                                               " rule; this changes the loop unless the sample time is small compared "
                                               "with Ti."});
    }
    note_unstable_filter(it, notes);
    if (uses_firmware_clock(it.product) && !it.context.loop_clock_s) {
        notes.push_back({"clock", "Computed with the firmware's period, " + text(*algorithm.sample_time_s) + " s. " +
                                      std::string(algorithm.sample_time_text)});
    }
}

/// For a block whose output is in percent while u is not.
void note_percent(const BlockLaw& it, std::vector<Note>& notes) {
    constexpr double kPercent = 100;
    const double span = it.context.spans.u_high - it.context.spans.u_low;
    if (!it.product.in_percent || !it.context.u_span_given || same(span, kPercent)) return;
    const Parameter& gain = *parameter_of(it.product, ParameterRole::gain);
    notes.push_back({"percent", "The output of the block is in percent, and u spans " + text(span) +
                                    " here: if 0 to 100 % of the output correspond to this span, "
                                    "enter " +
                                    std::string(gain.name) + " times " + text(kPercent / span) +
                                    ", or tune with u in percent."});
}

void note_evidence(const BlockLaw& it, std::vector<Note>& notes) {
    const Evidence& evidence = it.product.evidence;
    if (evidence.unverified.empty() && evidence.level == EvidenceLevel::read) return;
    std::string list;
    for (const std::string_view one : evidence.unverified) list += (list.empty() ? "" : "; ") + std::string(one);
    notes.push_back({"unverified", "Not verified in the maker's own text or code: " + list + "."});
}

}  // namespace

bool is_deviation(const Note& note) {
    static constexpr std::string_view kOthers[] = {"action",           "clock",     "default", "discretisation",
                                                   "outside-the-twin", "unverified"};
    return std::ranges::find(kOthers, note.code) == std::end(kOthers);
}

std::string setpoint_prefilter(const IdealPid& asked, const IdealPid& realised) {
    if (!asked.has_integral() || !same(asked.Ti, realised.Ti) || !same(asked.Kp, realised.Kp)) return "";
    // The derivatives of the set point differ by as much as the filters do.
    const bool kicks = (asked.c != 0 && asked.Td != 0) || (realised.c != 0 && realised.Td != 0);
    if (kicks && (asked.filter.type != realised.filter.type || !same(asked.filter.Tf, realised.filter.Tf))) return "";
    // Degrees of the numerators: a part of the block's set-point response must be at least as steep as the design's.
    const bool filtered = realised.filter.type == FilterType::derivative;
    const auto degree = [&](double b, double c) {
        if (c != 0 && realised.Td != 0) return filtered ? 1 : 2;
        return b != 0 ? 1 : 0;
    };
    if (degree(realised.b, realised.c) < degree(asked.b, asked.c)) return "";
    return "(" + weighted(realised, asked.b, asked.c) + ")/(" + weighted(realised, realised.b, realised.c) + ")";
}

void add_block_notes(const Product& product, const IdealPid& realised, const Context& context,
                     std::vector<Note>& notes) {
    const BlockLaw block{product, realised, context};
    note_percent(block, notes);
    note_algorithm(block, notes);
    note_evidence(block, notes);
}

void add_notes(const Comparison& comparison, std::vector<Note>& notes) {
    note_weights(comparison, notes);
    note_filter(comparison, notes);
    if (!same(comparison.asked.filter.Tf, comparison.realised.filter.Tf)) note_other_ratio(comparison, notes);
    note_rounding(comparison, notes);
    add_block_notes(comparison.product, comparison.realised, comparison.context, notes);
}

}  // namespace tunewright::product
