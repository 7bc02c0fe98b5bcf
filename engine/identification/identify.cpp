#include "engine/identification/identify.h"

#include <algorithm>
#include <cmath>

#include "engine/identification/closed_loop/closed_loop.h"
#include "engine/identification/closed_loop/cold_start.h"
#include "engine/identification/closed_loop/loop_parts.h"
#include "engine/identification/closed_loop/outside_excitation.h"
#include "engine/identification/further_inputs/further_inputs.h"
#include "engine/identification/model_grade.h"
#include "engine/identification/record/data_quality.h"
#include "engine/identification/record/record_kind.h"
#include "engine/identification/record/record_rows.h"
#include "engine/identification/record/series.h"
#include "engine/identification/relay_test/formula_answer.h"
#include "engine/identification/search/diagnosis.h"
#include "engine/identification/search/model_answer.h"
#include "engine/identification/search/model_search.h"
#include "engine/identification/search/record_repair.h"
#include "engine/identification/time_direction.h"
#include "engine/identification/two_point.h"
#include "engine/number_text.h"

namespace tunewright {
namespace {

/// A change of u in the last samples gives no information on the response.
std::optional<Error> refuse_late_step(const CleanRecord& r) {
    constexpr int kMaxTooFewSamples = 3;  // a gain, a lag and a dead time take one sample each
    const auto after = std::count_if(r.t.begin(), r.t.end(), [&](double t) { return t > r.v_time.front(); });
    if (after > kMaxTooFewSamples) return std::nullopt;
    return Error{
        ErrorKind::not_identifiable, "record",
        "u first changes at t = " + text(r.scale.t_origin + r.scale.t_scale * r.v_time.front()) + ", with " +
            std::to_string(after) +
            " sample(s) after it, so the record does not contain the response.  Record until y has settled after the "
            "step."};
}

const char* asked_name(ModelChoice model) {
    switch (model) {
        case ModelChoice::automatic: break;
        case ModelChoice::fopdt: return "fopdt";
        case ModelChoice::sopdt: return "sopdt";
        case ModelChoice::sopdt_zero: return "sopdt_zero";
        case ModelChoice::ipdt: return "ipdt";
        case ModelChoice::ipdt_lag: return "ipdt_lag";
    }
    return nullptr;
}

Error no_response(const CleanRecord& r, double percent, const char* asked) {
    if (asked != nullptr) {
        return {ErrorKind::not_identifiable, "identify/model",
                std::string("No ") + asked + " model explains y beyond noise and drift (the best reaches a fit of " +
                    text(std::max(0.0, percent), 3) + " %). Use model auto, or check whether y responds to u at all."};
    }
    constexpr double kMovesWithU = 45;  // per cent: more than a y that drifts by itself reaches by chance
    if (percent > kMovesWithU) {
        return {ErrorKind::not_identifiable, "record",
                "No linear model follows y (the best reaches a fit of " + text(percent, 3) +
                    " %). Check in the plot whether equal moves of u always move y equally. If u goes beyond the end "
                    "of a valve, give u_limits; a load moves y without u. Or give only the part of the record that "
                    "follows u (`from`, `to`)."};
    }
    return {ErrorKind::not_identifiable, "record",
            "y does not respond to u beyond what its own noise and drift explain (the best model reaches a fit of " +
                text(std::max(0.0, percent), 3) +
                " %). u first changes at t = " + text(r.scale.t_origin + r.scale.t_scale * r.v_time.front()) +
                " and the record ends at t = " + text(r.scale.t_origin + r.scale.t_scale * r.t.back()) +
                ". Make a larger step, record until y has settled, and check that u and y belong to the same loop."};
}

Expected<IdentifiedModel> by_two_points(const CleanRecord& record, const IdentifyOptions& options) {
    if (options.model != ModelChoice::automatic && options.model != ModelChoice::fopdt) {
        return Error{ErrorKind::unsupported, "identify/model",
                     "The two-point construction gives model fopdt; use method output_error for others."};
    }
    const Expected<TwoPointModel> found = two_point(record);
    if (!found) return found.error();
    IdentifiedModel model = formula_model(record, found->shape, found->K, 0);
    model.choice_reason = "fopdt through the 28.3 % and 63.2 % points of the step response.";
    return model;
}

/// Constraints of a model whose structure does not fit: the measured response at the oscillation, and the static gain
/// if the test shows it.
std::vector<FrequencyConstraint> anchors_of(const ModelSearch& search, const RecordedCycle& cycle) {
    constexpr double kHeldWithin = 3e-4;  // relative: smaller than any fit's own error, large enough for a
                                          // well-conditioned solution
    const Fit& fit = search.chosen();
    const double rms = std::sqrt(fit.sse / static_cast<double>(fit.residual.size()));
    const std::complex<double> G = cycle.harmonics.front().G;
    std::vector<FrequencyConstraint> anchors = {
        {cycle.omega(), G, rms / (kHeldWithin * std::abs(G)), cycle.harmonics.front().G_std}};
    constexpr double kMinBias = 0.01;      // of half a swing of u: with less, the ratio consists of noise
    constexpr double kMaxGainError = 0.3;  // relative error above which the structure determines the gain as well
    const double gain = cycle.static_gain(), sign = cycle.reversed ? -1 : 1;
    const bool shows_gain = cycle.biased() && std::abs(cycle.v_mean - cycle.rest.v) > kMinBias * cycle.v_half &&
                            cycle.drift == 0 && !search.disturbances.slope && !search.disturbances.load &&
                            gain * sign > std::abs(G) && cycle.static_gain_std() < kMaxGainError * std::abs(gain);
    if (shows_gain) anchors.push_back({0, gain, rms / (kHeldWithin * std::abs(gain)), cycle.static_gain_std()});
    return anchors;
}

void warn_mismatch(const RecordedCycle& cycle, bool gain_held, double left, std::vector<Warning>& warnings) {
    std::string detail = "The structure does not fit this plant: it leaves " + text(100 * left, 3) +
                         " % of y's variation beyond noise. The model is constrained to the response measured at the "
                         "oscillation";
    detail += gain_held ? " and to the static gain." : ".";
    if (!gain_held) {
        detail +=
            cycle.biased()
                ? " The static gain is not reliable: a load moves y, or the record does not show clearly where y is at "
                  "rest."
                : " The test has no bias, so the static gain is unknown.";
    }
    warnings.push_back({"structure-mismatch", detail});
}

/// At the oscillation a lag much longer than its period looks like an integrator, so the static gain depends on the
/// structure alone. If the model leaves more than noise (`left` of y's variation) or a pattern, the structure is not
/// that of the plant, and its response far from the oscillation is uncertain.
void warn_extrapolated_gain(const std::optional<double>& omega, const Fit& fit, double left,
                            std::vector<Warning>& warnings) {
    constexpr double kMinLagTimesOmega = 2;        // lag times omega above which a lag looks like an integrator
    constexpr double kMaxUnexplainedShare = 0.02;  // of y's variation, beyond noise
    constexpr double kMinCorrelationTime = 2;      // samples of correlation time: white noise has 1
    const Structure structure = fit.form.structure;
    const bool another = left > kMaxUnexplainedShare || correlation_time(fit.residual) > kMinCorrelationTime;
    if (is_integrating(structure) || structure == Structure::unstable) {
        if (!another) return;
        warnings.push_back({"gain-from-oscillation",
                            "The model leaves more than noise, so it is uncertain whether the plant integrates, is "
                            "unstable or has a static gain K: a relay's oscillation contains little information on "
                            "this. Make a step test."});
        return;
    }
    const double lag = has_quadratic(structure) ? fit.shape.a1() : fit.shape.T();
    if (omega && lag * *omega >= kMinLagTimesOmega) {
        warnings.push_back({"gain-from-oscillation",
                            "The relay's oscillation is at a frequency omega at which the lags times omega are " +
                                text(lag * *omega, 2) +
                                ", so the static gain K is extrapolated by the model's structure. The design is based "
                                "on the response measured near the oscillation; a step test shows the gain."});
    } else if (another) {
        warnings.push_back({"gain-from-oscillation",
                            "The model leaves more than noise, and a relay's oscillation shows the plant only near one "
                            "frequency: the error of the static gain K may exceed its standard error. A step test "
                            "shows it."});
    }
}

/// With the wrong sign of its feedback a relay never switches back: the sign of the feedback is that of the static
/// gain.
void warn_sign(const RecordedCycle& cycle, const Fit& fit, std::vector<Warning>& warnings) {
    if (fit.form.structure == Structure::unstable || (fit.linear[0] < 0) == cycle.reversed) return;
    warnings.push_back({"gain-from-oscillation",
                        "The model's static gain K has a sign with which this relay would not oscillate: the record "
                        "contains a drift, a load or another structure. Do not use this model; make a step test.",
                        WarningLevel::bad});
}

double steady_misfit(const CleanRecord& r, const RecordedCycle& cycle, const Fit& fit) {
    double squares = 0;
    int n = 0;
    for (int i = 0; i < r.samples(); ++i) {
        if (r.t[i] < cycle.start || r.t[i] > cycle.start + cycle.period * cycle.periods) continue;
        squares += fit.residual[i] * fit.residual[i];
        ++n;
    }
    return n > 0 ? std::sqrt(squares / n) : 0;
}

Error cancelled() { return {ErrorKind::cancelled, "", "The identification was cancelled."}; }

RecordKind kind_of(const CleanRecord& record) {
    return record.kind == RecordKind::automatic ? found_kind(record) : record.kind;
}

/// The shortest lag of a fit, as a share of the record's length.
double quickest_lag(const Fit& fit) {
    if (fit.form.structure == Structure::ipdt) return 1;
    const double lag = has_quadratic(fit.form.structure) ? fit.shape.a2() / fit.shape.a1() : fit.shape.T();
    return fit.form.structure == Structure::third ? std::min(lag, fit.shape.T3()) : lag;
}

/// The models of a record without its false readings. For a long one, means over blocks are fitted, with u unchanged: a
/// block of length h changes the response of a lag T by (h/T)^2/24, 5e-4 for ten blocks. Faster plants get shorter
/// blocks.
ModelSearch searched(CleanRecord& record, ModelChoice model, const RunControl& control) {
    constexpr int kFirstSamples = 20'000, kMaxFitted = 100'000;  // more samples cost time without a significant gain in
                                                                 // accuracy
    constexpr double kBlocks = 10;                               // blocks in the shortest lag
    const auto search_of = [&](int max) {
        return search_with_further(block_means(record, max), model, kind_of(record) == RecordKind::relay, control);
    };
    ModelSearch search = search_of(kFirstSamples);
    const bool quick = search.choice.index < 0 || quickest_lag(search.chosen()) * kFirstSamples < kBlocks;
    if (quick && record.samples() > kFirstSamples && !control.stop.stop_requested()) search = search_of(kMaxFitted);
    if (search.choice.index < 0 || control.stop.stop_requested()) return search;
    return without_false_readings(std::move(search), record, model, control);
}

Expected<IdentifiedModel> by_output_error(const CleanRecord& record, ModelSearch search, const IdentifyOptions& options,
                                          const RunControl& control) {
    constexpr double kMinUnexplainedShare = 0.004;  // of y's variation: a smaller residual is no reason for another
                                                    // structure
    const RecordKind kind = kind_of(record);
    if (control.stop.stop_requested()) return cancelled();
    if (search.choice.index < 0 || !responds(search.context.record, search.chosen())) {
        const double best = *std::max_element(search.percents.begin(), search.percents.end());
        return no_response(record, best, asked_name(options.model));
    }
    const double noise = search.context.noise;
    const bool whole = search.part == 1;
    const CleanRecord used = whole ? search.context.record : record;
    const auto cycle = kind == RecordKind::relay ? find_cycle(used, noise)
                                                 : Expected<RecordedCycle>(Error{ErrorKind::unsupported, "", ""});
    std::vector<Warning> warnings;
    const double left = unexplained_share(search.context, search.chosen());
    // If the rows show u late, the phase at the oscillation is late too.
    const bool unexplained = left > kMinUnexplainedShare && leaves_a_pattern(search.context, search.chosen());
    if (whole && cycle && unexplained && cycle->periods > 1 && !search.context.record.moved_between_rows) {
        const std::vector<FrequencyConstraint> anchors = anchors_of(search, *cycle);
        constrain(search, anchors, options.model, control);
        if (control.stop.stop_requested()) return cancelled();
        warn_mismatch(*cycle, anchors.size() > 1, left, warnings);
    }
    if (options.model != ModelChoice::automatic)
        search.choice.reason = std::string(name_of(search.chosen().form.structure)) + " was requested.";

    std::vector<Warning> last;
    if (kind == RecordKind::relay)
        warn_extrapolated_gain(cycle ? std::optional(cycle->omega()) : std::nullopt, search.chosen(), left, last);
    if (cycle) warn_sign(*cycle, search.chosen(), last);
    const double steady = cycle && whole ? steady_misfit(used, *cycle, search.chosen()) : 0;
    IdentifiedModel model = searched_model(std::move(search), record);
    model.warnings.insert(model.warnings.begin(), warnings.begin(), warnings.end());
    model.warnings.insert(model.warnings.end(), last.begin(), last.end());
    if (cycle) {
        const Expected<double> sigma = shift_of(options, used, *cycle);
        if (!sigma) return sigma.error();
        add_cycle(used, *cycle, {*sigma / used.scale.t_scale, shifted_response(used, *cycle, *sigma)}, model);
        if (whole) model.limit_cycle->fit_rms = steady * used.scale.y_scale;
    } else if (kind == RecordKind::relay) {
        model.warnings.push_back({"no-limit-cycle", cycle.error().message});
    }
    return model;
}

/// A record with the data of its fit.
struct Fitted {
    CleanRecord record;
    ModelSearch search;
    std::optional<InputLimits> u_limits;
};

/// If u exceeds usual limits of a controller's output and the fit leaves a pattern, tries u limited to them; kept if
/// this reduces the sum of squares to a third or less.
void try_limits(const Record& record, ModelChoice model, const RunControl& control, Fitted& fitted) {
    constexpr double kMinVarianceRatio = 3;  // ratio of sums of squares: large enough that chance never limits u
    if (record.u_limits || fitted.search.choice.index < 0) return;
    if (!leaves_a_pattern(fitted.search.context, fitted.search.chosen())) return;
    for (const InputLimits& limits : plain_limits(record)) {
        Record cut = record;
        cut.u_limits = limits;
        Expected<CleanRecord> clean = clean_record(cut);
        if (!clean || control.stop.stop_requested()) continue;
        ModelSearch search = searched(*clean, model, control);
        if (search.choice.index < 0) continue;
        const auto mean_square = [](const Fit& fit) { return fit.sse / static_cast<double>(fit.residual.size()); };
        if (kMinVarianceRatio * mean_square(search.chosen()) > mean_square(fitted.search.chosen())) continue;
        fitted = {std::move(*clean), std::move(search), limits};
    }
}

Expected<IdentifiedModel> by_fitting(const Record& record, CleanRecord clean, const IdentifyOptions& options,
                                     const RunControl& control) {
    ModelSearch search = searched(clean, options.model, control);
    Fitted fitted{std::move(clean), std::move(search), record.u_limits};
    try_limits(record, options.model, control, fitted);
    auto model = by_output_error(fitted.record, std::move(fitted.search), options, control);
    if (!model) return model;
    model->data_quality.u_limits = fitted.u_limits;
    if (fitted.u_limits && !record.u_limits)
        model->data_quality.notes.push_back(
            "u runs beyond " + text((*fitted.u_limits)[0]) + " to " + text((*fitted.u_limits)[1]) +
            " but y follows it only up to these values: u was logged before its limiter. Give u_limits if the limits "
            "are different.");
    return model;
}

/// A record and the controller that was found in it.
struct Looked {
    CleanRecord clean;
    std::optional<LoopRecord> loop;
    std::optional<double> u_rest;  ///< input at rest, before the set point moves
};

Expected<Looked> looked_at(const Record& record) {
    Expected<CleanRecord> clean = clean_record(record);
    if (!clean) return clean.error();
    if (auto error = refuse_late_step(*clean)) return *error;
    Expected<std::optional<LoopRecord>> loop = find_loop(*clean, record);
    if (!loop) return loop.error();
    const std::optional<double> rest = *loop ? (*loop)->u_rest : std::nullopt;
    if (rest) {
        // Noise moves u from the first row on: that row is not a level of rest.
        Record rested = record;
        rested.u0 = rest;
        clean = clean_record(rested);
        loop = find_loop(*clean, rested);
    }
    return Looked{std::move(*clean), std::move(*loop), rest};
}

/// The model from the rows in which the controller was in manual; empty if there are none.
std::optional<IdentifiedModel> by_manual_rows(const Record& record, const Looked& looked,
                                              const IdentifyOptions& options, const RunControl& control) {
    if (options.method == IdentifyMethod::relay_fourier || options.method == IdentifyMethod::two_point)
        return std::nullopt;
    const std::optional<Stretch> manual = manual_stretch(looked.clean);
    if (!manual || (!looked.loop && (manual->one_step_to_end || !feedback_outside(record, *manual))))
        return std::nullopt;
    Expected<IdentifiedModel> model = identify(rows_of(record, *manual), options, control);
    if (!model) return std::nullopt;
    model->data_quality.notes.push_back("Only the rows from t = " + text(manual->from) + " to " + text(manual->to) +
                                        " are used, in which u is constant or steps: in the others a controller moves "
                                        "u.");
    return std::move(*model);
}

void add_figures(const CleanRecord& record, IdentifiedModel& model) {
    add_excited_band(record, model);
    add_ultimate_point(model);
}

/// The model of a record whose start is as recorded, or given by u0. If only the model of an open-loop test reveals a
/// loop, the loop is stored in `looked`.
Expected<IdentifiedModel> model_of(const Record& record, Looked& looked, const IdentifyOptions& options,
                                   const RunControl& control) {
    auto& [clean, loop, rest] = looked;
    if (!loop) {
        if (auto model = by_manual_rows(record, looked, options, control)) return std::move(*model);
    }
    const bool by_formula = options.method == IdentifyMethod::relay_fourier;
    Expected<IdentifiedModel> model = by_formula                                    ? by_relay_formulas(clean, options)
                                      : options.method == IdentifyMethod::two_point ? by_two_points(clean, options)
                                      : loop ? identify_in_loop(clean, *loop, options.model, control)
                                             : by_fitting(record, clean, options, control);
    if (model && !loop && !by_formula && options.method != IdentifyMethod::two_point) {
        const double left = share_left_by(*model);
        auto by_law = find_loop(clean, record, left * left);
        if (by_law && *by_law) {
            loop = std::move(*by_law);
            model = identify_in_loop(clean, *loop, options.model, control);
        }
    }
    if (!model && loop && model.error().kind == ErrorKind::not_identifiable) {
        if (auto manual = by_manual_rows(record, looked, options, control)) return std::move(*manual);
    }
    if (!model) return model;
    if (rest)
        model->data_quality.notes.push_back(
            "Before the set point first moves, or the controller is switched on, the loop is at rest: u0 = " +
            text(*rest) + " is the mean of u there.");
    note_further_inputs(record, *model);
    if (!loop && set_point_is_input(clean, record))
        model->data_quality.notes.emplace_back(
            "Column r is u itself, or a straight line over it: it is assumed to be a command of u, not a set point.");
    loop ? report_loop(*loop, *model) : doubt_open_loop(clean, *model);
    add_figures(clean, *model);
    return model;
}

bool by_fit(IdentifyMethod method) {
    return method == IdentifyMethod::automatic || method == IdentifyMethod::output_error;
}

/// The model, with the rows in their assumed direction of time.
Expected<IdentifiedModel> identified(const Record& record, const IdentifyOptions& options, const RunControl& control) {
    Expected<Looked> looked = looked_at(record);
    if (!looked) return looked.error();
    Expected<IdentifiedModel> model = model_of(record, *looked, options, control);
    const bool in_loop = looked->loop || (model && model->data_quality.closed_loop) || !record.r.empty();
    const ColdStart start = by_fit(options.method) ? cold_start(record, looked->clean, in_loop) : ColdStart::none;
    if (model && looked->loop && model->data_quality.closed_loop)
        model->loop = std::make_shared<const IdentifiedLoop>(
            identified_loop(std::move(looked->clean), std::move(looked->loop->set_point), record));
    if (start == ColdStart::none) return model;
    Record off = record;
    off.u0 = off_level(record);
    return cold_start_model(start, std::move(model), identified(off, options, control), *off.u0);
}

}  // namespace

Expected<IdentifiedModel> identify(const Record& record, const IdentifyOptions& options, const RunControl& control) {
    Expected<IdentifiedModel> model = identified(record, options, control);
    if (by_fit(options.method) && times_fall(record)) {
        const Expected<Looked> turned = looked_at(record);
        model =
            model_in_time(std::move(model), identified(counted_down(record), options, control), turned && turned->loop);
    }
    if (model) grade_candidates(*model);
    if (model && control.progress) control.progress({1, "identify", "model found", nullptr});
    return model;
}

}  // namespace tunewright
