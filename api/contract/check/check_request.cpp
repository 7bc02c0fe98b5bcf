#include "api/contract/check/check_request.h"

#include <utility>

#include "api/contract/controller.h"
#include "api/contract/request.h"
#include "api/csv/time_stamp.h"
#include "engine/number_text.h"

namespace tunewright::api {
namespace {

constexpr std::size_t kMaxTagLength = 200, kMaxStartLength = 60, kMaxNoteLength = 2000, kMaxNotes = 100;

Codec<std::array<double, 2>> low_and_high() {
    return {[](const Json& value, std::array<double, 2>& target, Reader& reader) {
                std::vector<double> ends;
                numbers(2, 2).read(value, ends, reader);
                if (ends.size() != 2) return;
                if (!(ends[0] < ends[1]))
                    return reader.fault(reader.name() + " is " + shown(value) +
                                        "; it must be [low, high] with low < high, such as [0, 100].");
                target = {ends[0], ends[1]};
            },
            [](const std::array<double, 2>& value, Writer& out) {
                out.begin_array();
                for (const double end : value) out.number(end);
                out.end_array();
            },
            numbers(2, 2).schema};
}

const Description<LoopRanges>& ranges_contract() {
    static const auto description = [] {
        Description<LoopRanges> d("LoopRanges", "Ranges of the transmitter and of the output, [low, high].");
        d.field("pv", &LoopRanges::pv, maybe(low_and_high()), "Of the measurement: at its ends it shows nothing.",
                {.unit = "y"})
            .field("op", &LoopRanges::op, maybe(low_and_high()), "Of the output; 0 to 100 if not given.",
                   {.unit = "u"});
        return d;
    }();
    return description;
}

void check_loop_members(const Json&, GivenLoop& loop, Reader& reader) {
    if (loop.record && loop.csv) reader.fault_at("csv", "csv and record are both given; give one of them.");
    if (!loop.record && !loop.csv)
        reader.fault_at("record",
                        "record is missing; a loop has a record (t or dt, u, y and r as arrays, or csv) or csv text.");
    for (const auto& [name, given] :
         {std::pair{"columns", loop.columns.has_value()}, {"time_unit", loop.time_unit.has_value()}})
        if (given && !loop.csv)
            reader.fault_at(name, std::string(name) + " belongs to csv, which is missing; give it in record instead.");
    if (!loop.start) return;
    const auto stamp = read_time_stamp(*loop.start);
    if (stamp && stamp->has_date && stamp->has_clock)
        loop.epoch = stamp->seconds;
    else
        reader.fault_at("start", "start is " + Json(*loop.start).dump() +
                                     "; it must be the date and time of t = 0, such as 2026-05-04T06:00:00Z.");
}

/// The members of what is known of a loop. `Owner` is LoopFacts or has it as its base.
template <class Owner>
void add_facts_members(Description<Owner>& d) {
    using F = LoopFacts;
    using enum check::LoopKind;
    d.field("kind", &F::kind,
            choice<check::LoopKind>({{"unknown", unknown},
                                     {"flow", flow},
                                     {"pressure", pressure},
                                     {"level", level},
                                     {"temperature", temperature},
                                     {"composition", composition}}),
            "What it measures. The Harris range of a level is judged only with averaging false, and its plant "
            "may integrate (cure.valve); the other kinds are shown and filtered by, and change no conclusion.")
        .field("averaging", &F::averaging, maybe(boolean()),
               "true: a level that is there to smooth flows. Its variance and its slowness are its purpose and are not "
               "judged. false: a level that must be held.")
        .field("range", &F::range, object(ranges_contract()), "Ranges of measurement and output.", {.no_default = true})
        .field("controller", &F::controller, maybe(one_of(controller_contract())),
               "Today's settings, if known. Their gain and Ti are used instead of those that the record shows, unless "
               "it clearly shows others (remark controller-differs).")
        .field("weight", &F::weight, maybe(number({.minimum = 0})),
               "Money that a mean error of one unit of y costs in an hour: the work list is then ordered by money.");
}

const Description<GivenLoop>& loop_contract() {
    static const auto description = [] {
        using L = GivenLoop;
        Description<L> d("CheckLoop", "A loop: its record in operation, and what is known of it.");
        d.field("tag", &L::tag, maybe(text(kMaxTagLength)), "Its name in the answer, such as FIC101.");
        add_facts_members(d);
        d.field("record", &L::record, maybe(object(record_contract())),
                "Its record: measurement y, output u and, if known, set point r and mode; instead of csv.")
            .field("csv", &L::csv, maybe(text(kMaxCsvLength)), "The record as CSV text; instead of record.")
            .field("columns", &L::columns, maybe(object(columns_contract())), "Columns of csv.")
            .field("time_unit", &L::time_unit, maybe(file_time_unit()), "Unit of the times in csv, if it states none.")
            .field("start", &L::start, maybe(text(kMaxStartLength)),
                   "Date and time of t = 0, ISO 8601: loops with a start are compared on one clock.")
            .field(
                "notes", &L::notes, list_of(text(kMaxNoteLength), 0, kMaxNotes),
                "Sentences about how the record was made, such as \"12 values of bad quality count as missing.\" The "
                "answer has them among the remarks on the record.")
            .check(check_loop_members);
        return d;
    }();
    return description;
}

/// The reason in a fault's own words, with its place.
std::string reason_of(const Problem& problem) {
    return problem.errors.empty() ? problem.detail : problem.errors.front().detail;
}

}  // namespace

const Description<LoopFacts>& loop_facts_contract() {
    static const auto description = [] {
        Description<LoopFacts> d("LoopFacts", "What is known of a loop apart from its record.");
        add_facts_members(d);
        return d;
    }();
    return description;
}

void add_facts(const LoopFacts& facts, check::LoopQuestion& question) {
    if (facts.kind != check::LoopKind::unknown) question.kind = facts.kind;
    question.averaging = facts.averaging;
    question.y_range = facts.range.pv;
    question.u_range = facts.range.op;
    if (facts.controller) question.controller = gains(*facts.controller);
    question.weight = facts.weight;
}

const Description<CheckRequest>& check_request_contract() {
    static const auto description = [] {
        using R = CheckRequest;
        Description<R> d("CheckRequest",
                         "Loops in operation: what is wrong with each, why, and what to do first. Each needs a record "
                         "of its measurement and output over many periods, such as a day.");
        add_labels(d);
        d.field("loops", &R::loops, list_of(object(loop_contract()), 1, kMaxCheckedLoops),
                "The loops; many large ones are sent as a batch.", {.required = true})
            .field("cluster", &R::cluster, boolean(), "Look for loops that oscillate together, and for the source.")
            .field("settings", &R::settings, boolean(),
                   "Where tuning is the cause: look for new settings too, or say which test is missing. Where a valve "
                   "sticks: look for settings that stop its cycle until it is repaired. Some seconds a loop.");
        add_terms(d);
        d.refuse("record", "A check takes a record for each loop: loops [{\"tag\": \"FIC101\", \"record\": {...}}].")
            .refuse("tune", "A check designs nothing; its answer says for which loops tuning helps.")
            .example({{"loops", Json::array({Json{{"tag", "FIC101"},
                                                  {"kind", "flow"},
                                                  {"csv", "t,sp,pv,op,mode\n0,50,49.8,31.2,AUTO\n..."}}})}});
        return d;
    }();
    return description;
}

bool is_check_request(const Json& request) { return request.is_object() && request.contains("loops"); }

std::string tag_of(const GivenLoop& loop, std::size_t index) {
    return loop.tag && !loop.tag->empty() ? *loop.tag : "loop " + std::to_string(index + 1);
}

check::LoopQuestion question_of(GivenLoop loop, const Units& units, std::size_t index) {
    check::LoopQuestion out;
    out.tag = tag_of(loop, index);
    add_facts(loop, out);
    out.start = loop.epoch;
    out.units = {units.time_or_default(), units.y.value_or(""), units.u.value_or("")};
    out.seconds = seconds_per(units.time_or_default());
    GivenRecord given = loop.record ? std::move(*loop.record) : GivenRecord{};
    if (loop.csv) {
        given.csv = std::move(loop.csv);
        given.columns = std::move(loop.columns);
        given.time_unit = std::move(loop.time_unit);
    }
    Reader reader;
    ReadRecord read = resolve(std::move(given), units, reader);
    if (const auto problem = reader.problem()) {
        out.unreadable = reason_of(*problem);
        return out;
    }
    out.notes = std::move(loop.notes);
    for (std::string& sentence : reading_faults(read)) out.notes.push_back(std::move(sentence));
    out.readings = std::move(read.notes);
    out.record = std::move(read.record);
    return out;
}

}  // namespace tunewright::api
