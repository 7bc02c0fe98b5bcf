#include "api/contract/result/identified_model.h"

#include <algorithm>
#include <cmath>

#include "api/contract/plant/plant.h"
#include "api/contract/relay.h"
#include "api/contract/result/evaluation.h"
#include "engine/identification/model_grade.h"
#include "engine/number_text.h"
#include "engine/plant/linear/linear_plant.h"

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
        d.field("samples", &PreTest::samples, count(), "Number of them.")
            .field("duration", &PreTest::duration, size(), "Time from the first to the last of them.", {.unit = "time"})
            .field("drift", &PreTest::drift, size(), "Slope of y there.", {.unit = "y/time"})
            .field("at_rest", &PreTest::at_rest, truth(), "True if y moves no more than its noise explains.");
        return d;
    }();
    return description;
}

const Description<MissingPart>& missing_contract() {
    static const auto description = [] {
        Description<MissingPart> d("MissingPart", "Gaps in the record.");
        d.field("count", &MissingPart::count, count(), "Number of them.")
            .field("longest", &MissingPart::longest, size(), "The longest time from one sample to the next.",
                   {.unit = "time"})
            .field("at", &MissingPart::at, size(), "When it begins.", {.unit = "time"});
        return d;
    }();
    return description;
}

const Description<Saturation>& saturation_contract() {
    static const auto description = [] {
        Description<Saturation> d("Saturation", "A level at which y is cut off.");
        d.field("level", &Saturation::level, size(), "The level at which y is cut off.", {.unit = "y"})
            .field("fraction", &Saturation::fraction, size(), "Fraction of the samples at this level, 0 to 1.");
        return d;
    }();
    return description;
}

const Description<FalseReadings>& outliers_contract() {
    static const auto description = [] {
        Description<FalseReadings> d("Outliers", "Readings of y that are sensor errors; they were left out.");
        d.field("count", &FalseReadings::count, count(), "Number of them.")
            .field("rows", &FalseReadings::rows, list_of(count()),
                   "The first 20: lines of the csv, or indices from 0 into the arrays.");
        return d;
    }();
    return description;
}

const Description<ClosedLoop>& closed_loop_contract() {
    static const auto description = [] {
        Description<ClosedLoop> d("ClosedLoop", "Feedback from y to u; left out if there is none.");
        d.field("evidence", &ClosedLoop::evidence, sentence(), "Evidence, with its figures.")
            .field("used", &ClosedLoop::used,
                   only_answered(choice<LoopExcitation>({{"set_point", LoopExcitation::set_point},
                                                         {"switched_on", LoopExcitation::switched_on},
                                                         {"outside_moves", LoopExcitation::outside_moves},
                                                         {"none", LoopExcitation::none}})),
                   "Excitation of the model: moves of the set point (r), switching the controller on (or the set "
                   "point's move before the first row), moves of u that y does not explain, or none of these.")
            .field("share", &ClosedLoop::share, size(), "Share of u's variance that these moves explain, 0 to 1.")
            .field("set_point_moves", &ClosedLoop::set_point_moves, maybe(count()),
                   "Number of moves of the recorded set point; a ramp counts once.");
        return d;
    }();
    return description;
}

/// The kind of test in words, with the signal that moved: "one step of the set point, in automatic".
std::string test_words(const DataQuality& quality) {
    const auto steps = [](int count, const std::string& signal) {
        return count == 1 ? "one step of " + signal : std::to_string(count) + " steps of " + signal;
    };
    if (const auto& loop = quality.closed_loop) {
        const bool by_set_point = loop->used == LoopExcitation::set_point && loop->set_point_moves;
        return by_set_point ? steps(*loop->set_point_moves, "the set point") + ", in automatic"
                            : "a record in automatic";
    }
    if (quality.kind == RecordKind::relay) return "a relay test";
    return quality.kind == RecordKind::general ? "any moves of u" : steps(quality.steps, "u");
}

const Description<DataQuality>& quality_contract() {
    static const auto description = [] {
        using Q = DataQuality;
        Description<Q> d("DataQuality", "Findings about the record, and their treatment.");
        d.field("kind", &Q::kind,
                only_answered(choice<RecordKind>({{"step", RecordKind::step},
                                                  {"several_steps", RecordKind::several_steps},
                                                  {"relay", RecordKind::relay},
                                                  {"general", RecordKind::general}})),
                "Kind of test, as given or found.")
            .field(
                "test", {}, [](const Q& quality, Writer& out) { out.text(test_words(quality)); }, words().schema,
                "Kind of test in words, with the signal that moved: one step of the set point, in automatic.")
            .field("samples", &Q::samples, count(), "Samples used.")
            .field("samples_dropped", &Q::samples_dropped, count(),
                   "Rows whose y is not used: blank cells, times that go back, false readings.")
            .field("sample_time", &Q::sample_time, size(), "Median spacing.", {.unit = "time"})
            .field("irregular", &Q::irregular, truth(), "True if the spacing varies.")
            .field("noise_std", &Q::noise_std, size(), "Standard deviation of the high-frequency part of y.",
                   {.unit = "y"})
            .field("quantisation", &Q::quantisation, size(), "Resolution of y; 0: none found.", {.unit = "y"})
            .field("steps", &Q::steps, count(), "Number of moves of u; jitter below 2 % of its range does not count.")
            .field("move_times", &Q::move_times, list_of(size()), "Times of the first 20 moves of u.", {.unit = "time"})
            .field("cycles", &Q::cycles, maybe(count()), "Number of complete periods of a relay test.")
            .field("settled", &Q::settled, truth(), "True if y settled.")
            .field("u0", &Q::u0, size(), "u before its first change.", {.unit = "u"})
            .field("y0", &Q::y0, size(), "y before the first change of u: its mean there.", {.unit = "y"})
            .field("u_limits", &Q::u_limits, maybe(limits()), "Limits of u: as given, or as found in the record.",
                   {.unit = "u"})
            .field("pretest", &Q::pretest, maybe(answer(pretest_contract())), "The part before the first change of u.")
            .field("gaps", &Q::gaps, maybe(answer(missing_contract())),
                   "Number of spacings of more than five times the usual one.")
            .field("missing", &Q::missing, maybe(answer(missing_contract())), "Number of rows without a number for y.")
            .field("repeated_times", &Q::repeated_times, count(), "Number of rows with the time of the row above.")
            .field("backward_times", &Q::backward_times, count(),
                   "Number of rows out of order in time, which were left out.")
            .field("time_unit_assumed", &Q::time_unit_assumed, unless<bool>(truth(), [](bool it) { return !it; }),
                   "true: the unit of the times is not stated; seconds are assumed. Left out if it is stated.")
            .field("saturation", &Q::saturation,
                   unless<std::vector<Saturation>>(list_of(answer(saturation_contract())),
                                                   [](const auto& levels) { return levels.empty(); }),
                   "Levels at which y is cut off.")
            .field("backlash", &Q::backlash, maybe(size()),
                   "Part of a move of u after a change of direction that has no effect on y: backlash or friction, "
                   "which the model does not contain. Left out: none was found.",
                   {.unit = "u"})
            .field("outliers", &Q::outliers, maybe(answer(outliers_contract())), "Readings that were left out.")
            .field("closed_loop", &Q::closed_loop, maybe(answer(closed_loop_contract())),
                   "Feedback from y to u, and its treatment.")
            .field("notes", &Q::notes, list_of(sentence()), "Sentences.");
        return d;
    }();
    return description;
}

Codec<std::map<std::string, double>> standard_errors() { return numbers_by_name("Symbol of the parameter."); }

/// The standard errors of a model that is sent back.
Codec<std::map<std::string, double>> given_errors() {
    auto codec = standard_errors();
    codec.read = [](const Json& value, std::map<std::string, double>& target, Reader& reader) {
        if (!value.is_object()) return reader.fault(wrong_kind(value, "an object such as {\"K\": 0.1}", reader));
        for (const auto& [name, error] : value.items()) {
            const Reader::At at(reader, name);
            if (const auto read = read_number(error, {.minimum = 0}, reader)) target[name] = *read;
        }
    };
    return codec;
}

const Description<Candidate>& candidate_contract() {
    static const auto description = [] {
        Description<Candidate> d("Candidate", "A structure that was tried.");
        d.field("plant", &Candidate::plant, only_answered(one_of(plant_contract())), "The model.")
            .field("fit_percent", &Candidate::fit_percent, only_answered(number()),
                   "100 (1 - |y - yhat|/|y - mean(y)|), free run.")
            .field("criterion", &Candidate::criterion, only_answered(number()),
                   "Information criterion; smaller is better.")
            .field("standard_errors", &Candidate::standard_errors, standard_errors(), "By parameter.")
            .field(
                "undetermined", &Candidate::undetermined,
                unless<std::vector<std::string>>(list_of(sentence()), [](const auto& names) { return names.empty(); }),
                "Time constants and dead times that the record does not determine: their standard errors are longer "
                "than the record. Left out where there are none.")
            .field("much_worse", &Candidate::much_worse, unless<bool>(truth(), [](bool it) { return !it; }),
                   "true: its fit lies more than 3 points below the best candidate's. Left out otherwise.")
            .field("y_model", &Candidate::y_model,
                   unless<std::vector<double>>(trace(), [](const auto& y_model) { return y_model.empty(); }),
                   "Simulated output at the times of the model's fit; with identify.traces.", {.unit = "y"});
        return d;
    }();
    return description;
}

/// Checks for one row and one column per name and for symmetry; asymmetry within rounding is removed.
void check_matrix(ParameterCovariance& covariance, Reader& reader) {
    constexpr double kMaxRelativeAsymmetry = 1e-9;  // of the product of the two standard errors
    const std::size_t size = covariance.names.size();
    auto& rows = covariance.matrix;
    const bool square =
        rows.size() == size && std::ranges::all_of(rows, [&](const auto& row) { return row.size() == size; });
    bool symmetric = square;
    for (std::size_t i = 0; symmetric && i < size; ++i)
        for (std::size_t j = 0; j < i; ++j) {
            const double scale = std::sqrt(std::abs(rows[i][i] * rows[j][j]));
            symmetric = symmetric && std::abs(rows[i][j] - rows[j][i]) <= kMaxRelativeAsymmetry * scale;
            rows[i][j] = rows[j][i] = 0.5 * (rows[i][j] + rows[j][i]);
        }
    if (!symmetric)
        reader.fault_at("matrix", "matrix must be symmetric, with a row and a column for each of the " +
                                      std::to_string(size) + " names. Send it as in the answer.");
}

const Description<ParameterCovariance>& covariance_contract() {
    static const auto description = [] {
        Description<ParameterCovariance> d("Covariance", "Covariance of the model's parameters.");
        constexpr std::size_t kMaxName = 10, kMaxParameters = 8, kMaxEnds = 1000;
        d.field("names", &ParameterCovariance::names, list_of(text(kMaxName), 1, kMaxParameters),
                "Order of rows and columns.", {.required = true})
            .field("matrix", &ParameterCovariance::matrix, list_of(numbers(1, kMaxParameters), 1, kMaxParameters),
                   "Symmetric.", {.required = true})
            .field("reach", &ParameterCovariance::reach,
                   unless<std::vector<double>>(numbers(1, kMaxEnds), [](const auto& reach) { return reach.empty(); }),
                   "Fraction of the 95 % ellipsoid in each direction, 0 to 1, up to which the record does not exclude "
                   "its plants; left out if nothing is excluded.")
            .check(
                [](const Json&, ParameterCovariance& covariance, Reader& reader) { check_matrix(covariance, reader); });
        return d;
    }();
    return description;
}

const Description<ExcitedBand>& band_contract() {
    static const auto description = [] {
        Description<ExcitedBand> d("ExcitedBand",
                                   "Frequencies at which the response to u exceeds the noise: the record's own "
                                   "estimate of P(j omega) has a relative standard error below 100 %.");
        d.field("omega_low", &ExcitedBand::omega_low, number({.minimum = 0}), "2 pi over the record's length.",
                {.required = true, .unit = "rad/time"})
            .field("omega_high", &ExcitedBand::omega_high, number({.minimum = 0}), "Upper end.",
                   {.required = true, .unit = "rad/time"})
            .check([](const Json&, ExcitedBand& band, Reader& reader) {
                if (band.omega_low > band.omega_high)
                    reader.fault_at("omega_low", "omega_low is " + tunewright::text(band.omega_low) +
                                                     " and omega_high " + tunewright::text(band.omega_high) +
                                                     "; omega_low must not be above omega_high. Send the band as in "
                                                     "the answer, or leave it out.");
            });
        return d;
    }();
    return description;
}

const Description<FitTrace>& fit_contract() {
    static const auto description = [] {
        Description<FitTrace> d(
            "Fit",
            "The model with the record, six significant digits; times have more if they would otherwise be equal.");
        d.field("t", &FitTrace::t, times_trace(), "Time.", {.unit = "time"})
            .field("u", &FitTrace::u, trace(), "The input as recorded, held between samples.", {.unit = "u"})
            .field("y", &FitTrace::y, trace(), "Measured.", {.unit = "y"})
            .field("y_model", &FitTrace::y_model, trace(), "Simulated.", {.unit = "y"});
        return d;
    }();
    return description;
}

/// Checks the plant and the region of a model that is sent back.
void check_region(const IdentifiedModel& model, Reader& reader) {
    if (const auto plant = LinearPlant::make(model.plant); !plant)
        return reader.fault_below(plant.error().where, 0, plant.error().message);
    const auto& [names, matrix, reach] = model.covariance;
    if (names.empty()) return;
    const auto region = PlantRegion::of_covariance(model.plant, names, matrix);
    if (!region)
        return reader.fault_at("covariance", region.error().kind == ErrorKind::invalid_argument
                                                 ? region.error().message
                                                 : "covariance is not a covariance of the plant's parameters. Send it "
                                                   "as in the answer, or leave it out.");
    const bool shares = std::ranges::all_of(reach, [](double share) { return share >= 0 && share <= 1; });
    if (!reach.empty() && (reach.size() != region->ends().size() || !shares))
        reader.fault_at("covariance", "covariance has a reach of the wrong size: it must have " +
                                          std::to_string(region->ends().size()) +
                                          " numbers from 0 to 1. Send it as in the answer, or leave it out.");
}

const Description<DisturbanceModel>& disturbance_contract() {
    static const auto description = [] {
        Description<DisturbanceModel> d("Disturbance", "Effect of a measured disturbance on y.");
        d.field("name", &DisturbanceModel::name, words(), "Its heading, or the name that was given.")
            .field("plant", &DisturbanceModel::plant, only_answered(one_of(plant_contract())),
                   "A gain, a lag and a dead time of its own; with an integrator if the plant of u has one.")
            .field("standard_errors", &DisturbanceModel::standard_errors, standard_errors(),
                   "Standard errors of K, T and L.")
            .field("share", &DisturbanceModel::share, size(),
                   "Its share of the variances that u and the disturbances cause in y, 0 to 1.");
        return d;
    }();
    return description;
}

}  // namespace

const Description<IdentifiedModel>& model_contract() {
    static const auto description = [] {
        using M = IdentifiedModel;
        Description<M> d(
            "Model",
            "The plant identified from the record. POST /v1/design and /v1/evaluate accept it instead of the record.");
        d.field("plant", &M::plant, one_of(plant_contract()), "The model.", {.required = true})
            .field("fit_percent", &M::fit_percent, number(),
                   "100 (1 - |y - yhat|/|y - mean(y)|), free run, offset estimated.", {.required = true})
            .field(
                "grade", {}, [](const M& model, Writer& out) { out.text(name_of(grade_of(model))); },
                [](SchemaBook&) {
                    return Json{{"type", "string"}, {"enum", {"good", "usable", "doubtful"}}};
                },
                "Reliability. good; usable: with care, because there are warnings; doubtful: it explains less than 70 "
                "% of the record's movement, or less than 90 % and the rest is not noise, or a warning says that the "
                "plant may be a different one.")
            .field(
                "grade_reason", {}, [](const M& model, Writer& out) { out.text(name_of(*reason_of_doubt(model))); },
                [](SchemaBook&) {
                    return Json{{"type", "string"}, {"enum", {"fit", "warning"}}};
                },
                "Reason of the grade doubtful: fit, the model explains too little of its record; warning, it explains "
                "its record but has a warning of level bad. Left out for the other grades.",
                {}, [](const M& model) { return !reason_of_doubt(model); })
            .field("standard_errors", &M::standard_errors, given_errors(), "By parameter.", {.required = true})
            .field("covariance", &M::covariance,
                   unless<ParameterCovariance>(object(covariance_contract()),
                                               [](const auto& covariance) { return covariance.names.empty(); }),
                   "Covariance of the parameters.")
            .field("alternatives", &M::alternatives, list_of(one_of(plant_contract())),
                   "Best fits of other structures that the record does not distinguish from the model: the 95 % "
                   "confidence region includes them.",
                   {.required = true})
            .field("disturbances", &M::disturbances,
                   unless<std::vector<DisturbanceModel>>(list_of(answer(disturbance_contract())),
                                                         [](const auto& models) { return models.empty(); }),
                   "Models of the measured disturbances that matter (record.d), identified together with the plant.")
            .field("limit_cycle", &M::limit_cycle, maybe(object(limit_cycle_contract())),
                   "Limit cycle of a relay test.")
            .field("frequency_points", &M::frequency_points,
                   unless<std::vector<FrequencyPoint>>(list_of(answer(frequency_point_contract())),
                                                       [](const auto& points) { return points.empty(); }),
                   "Ultimate point of the plant, from the record alone.")
            .field("ultimate_point", &M::ultimate_point, maybe(answer(ultimate_point_contract())),
                   "Ultimate point of the model; left out if no gain makes it oscillate.")
            .field("excited_band", &M::excited_band, maybe(object(band_contract())),
                   "The frequencies at which the record determines the plant's response.")
            .field("region", &M::region, maybe(answer(region_contract())),
                   "The best-ranked controller on the 95 % confidence region; each entry has its own.")
            .field("choice_reason", &M::choice_reason, words(), "Reason for this structure.")
            .field("candidates", &M::candidates, list_of(answer(candidate_contract())),
                   "The structures that were tried.")
            .field("fit", &M::fit,
                   unless<FitTrace>(answer(fit_contract()), [](const auto& fit) { return fit.t.empty(); }),
                   "The model with the record; with identify.traces.")
            .field("data_quality", &M::data_quality, answer(quality_contract()), "Quality of the record.")
            .field("warnings", &M::warnings, list_of(object(warning_contract())), "Remarks.", {.required = true})
            .check([](const Json&, M& model, Reader& reader) { check_region(model, reader); });
        return d;
    }();
    return description;
}

const Description<IdentifyAnswer>& identify_answer_contract() {
    static const auto description = [] {
        Description<IdentifyAnswer> d("IdentifyAnswer", "The model identified from the record.");
        d.field("model", &IdentifyAnswer::model, answer(model_contract()), "The model.");
        return d;
    }();
    return description;
}

}  // namespace tunewright::api
