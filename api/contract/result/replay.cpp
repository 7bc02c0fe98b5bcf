#include "api/contract/result/replay.h"

#include "api/describe/answers.h"

namespace tunewright::api {
namespace {

using enum ReplayRefusal;

Codec<std::vector<double>> thinned(Codec<std::vector<double>> columns) {
    return unless<std::vector<double>>(std::move(columns), [](const auto& values) { return values.empty(); });
}

// Code and sentence of a refusal; left out if there is none.
template <class Replay>
void add_refusal(Description<Replay>& d, const Json& codes, const char* sentence) {
    d.field(
        "refused", {},
        [](const Replay& replay, Writer& out) {
            out.begin_object();
            out.key("code");
            out.text(name_of(*replay.refused));
            out.key("text");
            out.text(reason_of(*replay.refused));
            out.end_object();
        },
        [codes](SchemaBook&) {
            return Json{
                {"type", "object"},
                {"properties", {{"code", {{"type", "string"}, {"enum", codes}}}, {"text", {{"type", "string"}}}}},
                {"required", {"code", "text"}}};
        },
        sentence, {}, [](const Replay& replay) { return !replay.refused; });
}

Json codes_of(std::initializer_list<ReplayRefusal> refusals) {
    Json list = Json::array();
    for (const ReplayRefusal refusal : refusals) list.push_back(name_of(refusal));
    return list;
}

const Description<ReplayFigures>& figures_contract() {
    static const auto description = [] {
        using F = ReplayFigures;
        Description<F> d("ReplayFigures", "Figures of a loop over the recorded time.");
        d.field("IAE", &F::IAE, only_answered(number()), "Integral of |r - y|, noise included.", {.unit = "y time"})
            .field("largest_error", &F::largest_error, only_answered(number()), "Largest |r - y|.", {.unit = "y"})
            .field("travel", &F::travel, only_answered(number()), "Sum of the moves of u.", {.unit = "u"})
            .field("reversals", &F::reversals, only_answered(integer(0, 1 << 30)),
                   "Changes of direction of u; moves back within its grid or 0.2 % of its range do not count.");
        return d;
    }();
    return description;
}

// Left out of a refused replay.
template <class Replay>
void add_figures(Description<Replay>& d) {
    d.field(
        "figures", {}, [](const Replay& replay, Writer& out) { figures_contract().write(replay.figures, out); },
        [](SchemaBook& book) { return figures_contract().schema(book); }, "IAE, largest error, travel and reversals.",
        {}, [](const Replay& replay) { return replay.refused.has_value(); });
}

template <class Replay>
void add_number(Description<Replay>& d, const char* name, double Replay::*member, const char* sentence,
                FieldOptions options = {}) {
    d.field(
        name, {}, [member](const Replay& replay, Writer& out) { out.number(replay.*member); }, number().schema,
        sentence, options, [](const Replay& replay) { return replay.refused.has_value(); });
}

template <class Replay>
void add_trace(Description<Replay>& d, std::vector<double> ReplayTrace::*member, const char* name, const char* unit,
               const char* sentence) {
    d.field(
        name, {}, [member](const Replay& replay, Writer& out) { trace().write(replay.trace.*member, out); },
        trace().schema, sentence, {.unit = unit},
        [member](const Replay& replay) { return (replay.trace.*member).empty(); });
}

}  // namespace

const Description<ReplayedRecord>& replayed_record_contract() {
    static const auto description = [] {
        using R = ReplayedRecord;
        Description<R> d(
            "ReplayedRecord",
            "The record as it was, with which the replays of the entries are compared. Traces have as many "
            "points as `evaluate.points`.");
        add_refusal(d, codes_of({manual, feedback, no_set_point, doubtful_model, unknown_region, no_error}),
                    "Reason why no entry is replayed, and the cure.");
        add_number(d, "from", &R::from, "Time of the first row.", {.unit = "time"});
        add_number(d, "to", &R::to, "Time of the last row.", {.unit = "time"});
        add_figures(d);
        d.field("t", &R::t, thinned(times_trace()), "Time, also of the entries' traces.", {.unit = "time"})
            .field("r", &R::r, thinned(trace()), "Set point.", {.unit = "y"});
        add_trace(d, &ReplayTrace::y, "y", "y", "Measurement, as recorded.");
        add_trace(d, &ReplayTrace::u, "u", "u", "Controller output, as recorded.");
        return d;
    }();
    return description;
}

const Description<ReplayedEntry>& replayed_entry_contract() {
    static const auto description = [] {
        using E = ReplayedEntry;
        Description<E> d("ReplayedEntry",
                         "The recorded time with this controller: the same set points and disturbances, on the model, "
                         "within the limits of u. Figures are left out if it is refused.");
        add_refusal(d, codes_of({no_law, unstable, wide_band}), "Reason why it is unknown.");
        add_figures(d);
        add_number(d, "IAE_ratio", &E::IAE_ratio, "IAE, divided by that of the record.");
        add_number(d, "IAE_ratio_low", &E::IAE_ratio_low,
                   "The least IAE_ratio on the plants that fit the record, less 3 %.");
        add_number(d, "IAE_ratio_high", &E::IAE_ratio_high, "The largest IAE_ratio on them, plus 3 %.");
        d.field("travel_ratio", &E::travel_ratio, maybe(only_answered(number())),
                "Travel of u, divided by that of the record.");
        add_trace(d, &ReplayTrace::y, "y", "y", "Measurement at `replay.t` of the answer.");
        add_trace(d, &ReplayTrace::u, "u", "u", "Controller output at the same times.");
        return d;
    }();
    return description;
}

}  // namespace tunewright::api
