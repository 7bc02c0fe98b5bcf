#include "api/contract/data_quality.h"

namespace tunewright::api {
namespace {

Codec<int> count() { return only_answered(integer(0, 1 << 30)); }
Codec<double> size() { return only_answered(number()); }
Codec<std::string> sentence() {
    return {{},
            [](const std::string& value, Writer& out) { out.text(value); },
            [](SchemaBook&) {
                return Json{{"type", "string"}};
            }};
}
Codec<std::array<double, 2>> limits() {
    return {{},
            [](const std::array<double, 2>& ends, Writer& out) { out.numbers(ends); },
            [](SchemaBook&) {
                return Json{{"type", "array"}, {"items", {{"type", "number"}}}, {"minItems", 2}, {"maxItems", 2}};
            }};
}
Codec<bool> truth() { return only_answered(boolean()); }

const Description<PreTest>& pretest_contract() {
    static const auto description = [] {
        Description<PreTest> d("PreTest", "The samples before the first change of u.");
        d.field("samples", &PreTest::samples, count(), "How many.")
            .field("duration", &PreTest::duration, size(), "From the first to the last of them.", {.unit = "time"})
            .field("drift", &PreTest::drift, size(), "Slope of y there.", {.unit = "y/time"})
            .field("at_rest", &PreTest::at_rest, truth(), "Whether y moves no more than its noise explains.");
        return d;
    }();
    return description;
}

const Description<MissingPart>& missing_contract() {
    static const auto description = [] {
        Description<MissingPart> d("MissingPart", "Where the record holds nothing.");
        d.field("count", &MissingPart::count, count(), "How many.")
            .field("longest", &MissingPart::longest, size(), "The longest time from one sample to the next.",
                   {.unit = "time"})
            .field("at", &MissingPart::at, size(), "When it begins.", {.unit = "time"});
        return d;
    }();
    return description;
}

const Description<Saturation>& saturation_contract() {
    static const auto description = [] {
        Description<Saturation> d("Saturation", "A level at which y is cut off flat.");
        d.field("level", &Saturation::level, size(), "The level at which y is cut off.", {.unit = "y"})
            .field("fraction", &Saturation::fraction, size(), "Fraction of the samples at this level, 0 to 1.");
        return d;
    }();
    return description;
}

const Description<FalseReadings>& outliers_contract() {
    static const auto description = [] {
        Description<FalseReadings> d("Outliers", "Readings of y that no process makes; they were left out.");
        d.field("count", &FalseReadings::count, count(), "How many.")
            .field("rows", &FalseReadings::rows, list_of(count()),
                   "The first 20: lines of the csv, or indices from 0 into the arrays.");
        return d;
    }();
    return description;
}

const Description<ClosedLoop>& closed_loop_contract() {
    static const auto description = [] {
        Description<ClosedLoop> d("ClosedLoop", "A controller moved u in answer to y; there only where it did.");
        d.field("evidence", &ClosedLoop::evidence, sentence(), "What shows it, with its figures.")
            .field(
                "used", &ClosedLoop::used,
                only_answered(choice<LoopExcitation>({{"set_point", LoopExcitation::set_point},
                                                      {"outside_moves", LoopExcitation::outside_moves},
                                                      {"none", LoopExcitation::none}})),
                "What the model rests on: moves of the set point (r), moves of u that y does not explain, or neither.")
            .field("share", &ClosedLoop::share, size(), "Of u's variance that these moves explain, 0 to 1.");
        return d;
    }();
    return description;
}

}  // namespace

const Description<DataQuality>& quality_contract() {
    static const auto description = [] {
        using Q = DataQuality;
        Description<Q> d("DataQuality", "What was found in the record and what was done about it.");
        d.field("kind", &Q::kind,
                only_answered(choice<RecordKind>({{"step", RecordKind::step},
                                                  {"several_steps", RecordKind::several_steps},
                                                  {"relay", RecordKind::relay},
                                                  {"general", RecordKind::general}})),
                "What the test was, as given or found.")
            .field("samples", &Q::samples, count(), "Samples used.")
            .field("samples_dropped", &Q::samples_dropped, count(),
                   "Rows of which no y is used: blank cells, backward times, false readings.")
            .field("sample_time", &Q::sample_time, size(), "Median spacing.", {.unit = "time"})
            .field("irregular", &Q::irregular, truth(), "Whether the spacing varies.")
            .field("noise_std", &Q::noise_std, size(), "High-frequency part of y, standard deviation.", {.unit = "y"})
            .field("quantisation", &Q::quantisation, size(), "Step of y's grid; 0: none found.", {.unit = "y"})
            .field("steps", &Q::steps, count(), "Moves of u; jitter below 2 % of its range is none.")
            .field("cycles", &Q::cycles, maybe(count()), "Complete periods of a relay test.")
            .field("settled", &Q::settled, truth(), "Whether y came to rest.")
            .field("u0", &Q::u0, size(), "u before its first change.", {.unit = "u"})
            .field("y0", &Q::y0, size(), "y before the first change of u: its mean there.", {.unit = "y"})
            .field("u_limits", &Q::u_limits, maybe(limits()),
                   "The ends to which u was cut: as given, or as the record shows them.", {.unit = "u"})
            .field("pretest", &Q::pretest, maybe(answer(pretest_contract())), "The part before the first change of u.")
            .field("gaps", &Q::gaps, maybe(answer(missing_contract())),
                   "Spacings of more than five times the usual one.")
            .field("missing", &Q::missing, maybe(answer(missing_contract())), "Rows without a number for y.")
            .field("repeated_times", &Q::repeated_times, count(), "Rows with the time of the row above.")
            .field("backward_times", &Q::backward_times, count(), "Rows out of order in time; left out.")
            .field("saturation", &Q::saturation,
                   unless<std::vector<Saturation>>(list_of(answer(saturation_contract())),
                                                   [](const auto& levels) { return levels.empty(); }),
                   "Levels at which y is cut off flat.")
            .field("outliers", &Q::outliers, maybe(answer(outliers_contract())), "Readings that were left out.")
            .field("closed_loop", &Q::closed_loop, maybe(answer(closed_loop_contract())),
                   "Whether a controller moved u in answer to y, and what was done about it.")
            .field("notes", &Q::notes, list_of(sentence()), "Sentences.");
        return d;
    }();
    return description;
}

}  // namespace tunewright::api
