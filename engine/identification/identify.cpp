#include "engine/identification/identify.h"

#include <algorithm>
#include <cmath>

#include "engine/identification/closed_loop/closed_loop.h"
#include "engine/identification/fit/diagnosis.h"
#include "engine/identification/fit/model_answer.h"
#include "engine/identification/fit/model_search.h"
#include "engine/identification/fit/record_repair.h"
#include "engine/identification/record/data_quality.h"
#include "engine/identification/record/record_kind.h"
#include "engine/identification/record/series.h"
#include "engine/identification/relay_test/relay_fourier.h"
#include "engine/identification/two_point.h"
#include "engine/number_text.h"

namespace tunewright {
namespace {

/// A change of u in the last samples shows nothing of the response.
std::optional<Error> refuse_late_step(const CleanRecord& r) {
    constexpr int kTooFew = 3;  // a gain, a lag and a dead time take one sample each
    const auto after = std::count_if(r.t.begin(), r.t.end(), [&](double t) { return t > r.v_time.front(); });
    if (after > kTooFew) return std::nullopt;
    return Error{
        ErrorKind::not_identifiable, "record",
        "u first changes at t = " + text(r.scale.t_origin + r.scale.t_scale * r.v_time.front()) + ", with " +
            std::to_string(after) +
            " sample(s) after it: the response is not in the record. Record until y has settled after the step."};
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
                    text(std::max(0.0, percent), 3) + " %). Use model auto, or look whether y responds to u at all."};
    }
    return {ErrorKind::not_identifiable, "record",
            "y does not respond to u beyond what its own noise and drift explain (the best model reaches a fit of " +
                text(std::max(0.0, percent), 3) +
                " %). u first changes at t = " + text(r.scale.t_origin + r.scale.t_scale * r.v_time.front()) +
                " and the record ends at t = " + text(r.scale.t_origin + r.scale.t_scale * r.t.back()) +
                ". Make a larger step, record until y has settled, and check that u and y belong to the same loop."};
}

/// The shift of Eq. 9, dimensionless; 1/Pu unless given.
Expected<double> shift_of(const IdentifyOptions& options, const CleanRecord& record, const RecordedCycle& cycle) {
    if (!options.shift) return 1 / cycle.period;
    if (!(*options.shift > 0) || !std::isfinite(*options.shift))
        return Error{ErrorKind::invalid_argument, "identify/shift", "shift must be a number above 0."};
    return *options.shift * record.scale.t_scale;
}

/// Every model that the formulas give and `asked` admits, the one that repeats y best first.
std::vector<RelayModel> relay_models(const RecordedCycle& cycle, std::complex<double> shifted, double sigma,
                                     ModelChoice asked) {
    std::vector<RelayModel> models;
    auto add = [&](const std::vector<RelayModel>& more) { models.insert(models.end(), more.begin(), more.end()); };
    const bool any = asked == ModelChoice::automatic;
    if (any || asked == ModelChoice::fopdt) {
        const auto by_gain = cycle.biased() ? biased_fopdt(cycle) : std::nullopt;
        if (by_gain)
            models.push_back(*by_gain);
        else
            add(unbiased_models(cycle, shifted, sigma, Structure::fopdt));
        if (!by_gain) add(unbiased_models(cycle, shifted, sigma, Structure::unstable));
    }
    if (any || asked == ModelChoice::ipdt) {
        if (const auto model = integrating_model(cycle)) models.push_back(*model);
    }
    if (asked == ModelChoice::ipdt_lag) add(unbiased_models(cycle, shifted, sigma, Structure::ipdt_lag));
    // The request asks for the paper's first-order lag, unless the integrator repeats the oscillation twice as well, or
    // as well where both repeat it: a lag without end is an integrator.
    constexpr double kRepeats = 0.01;              // of half a swing: no more than sampling and noise leave
    constexpr double kAsWell = 0.95, kTie = 1e-5;  // so that of equal misfits the integrator's is the smaller
    constexpr double kFarBetter = 2;
    auto cost = [&](const RelayModel& model) {
        const bool integrator = any && model.shape.structure == Structure::ipdt;
        if (!integrator) return model.fit_rms;
        return model.fit_rms < kRepeats * cycle.y_half ? kAsWell * model.fit_rms - kTie : kFarBetter * model.fit_rms;
    };
    std::stable_sort(models.begin(), models.end(), [&](const auto& a, const auto& b) { return cost(a) < cost(b); });
    return models;
}

void warn_formula(const CleanRecord& r, const RecordedCycle& cycle, const RelayModel& chosen, double noise,
                  std::vector<Warning>& warnings) {
    if (cycle.rest.assumed) {
        warnings.push_back({"rest-assumed", "The record starts under the relay: u is taken to rest at " +
                                                text(r.scale.u_rest + r.scale.u_scale * cycle.rest.v) +
                                                " and y at its first values, " +
                                                text(r.scale.y_origin + r.scale.y_scale * cycle.rest.y) +
                                                ". Give u0 and y0 if they are known."});
    }
    if (cycle.biased() && !chosen.by_static_gain && !is_integrating(chosen.shape.structure)) {
        warnings.push_back({"static-gain-contradiction",
                            "The mean of y over the mean of u is " +
                                text(cycle.static_gain() * r.scale.y_scale / r.scale.u_scale) +
                                ", which the phase at the oscillation contradicts: a load, a drift or a wrong rest "
                                "level is in the record. Eq. 13 was used in place of Eq. 14; method output_error fits "
                                "such disturbances."});
    }
    // Periods that differ blur the harmonics of their mean.
    const double scatter = noise / std::sqrt(static_cast<double>(std::max(1, r.samples()))) +
                           2 * cycle.period_scatter / cycle.period * cycle.y_half;
    constexpr double kPlainly = 0.03, kErrors = 4;  // of half a swing, and of what scatter explains
    if (chosen.fit_rms > kPlainly * cycle.y_half + kErrors * scatter) {
        warnings.push_back(
            {"structure-mismatch", "The model repeats the steady oscillation only within " +
                                       text(chosen.fit_rms * r.scale.y_scale, 3) + " (r.m.s., of a half swing of " +
                                       text(cycle.y_half * r.scale.y_scale, 3) +
                                       "): the plant is not of this structure. Trust the measured frequency point; " +
                                       (chosen.by_static_gain ? "the gain is the mean of y over the mean of u."
                                                              : "the gain is not the plant's static gain.")});
    }
    if (std::abs(cycle.drift) > 0) {
        warnings.push_back(
            {"drift", "The mean of y creeps from period to period by " +
                          text(cycle.drift * cycle.period * r.scale.y_scale, 3) +
                          ": a load or a drift is in the record, and Eqs. 9 and 14 suffer from it. Method "
                          "output_error fits it."});
    }
}

Error no_relay_model(const CleanRecord& r, const RecordedCycle& cycle, ModelChoice asked) {
    std::string why = "No ";
    why += asked == ModelChoice::ipdt || asked == ModelChoice::ipdt_lag ? "integrating" : "first-order";
    why += " model with a dead time meets the oscillation (A_u = " +
           text(std::abs(cycle.harmonics.front().G) * r.scale.y_scale / r.scale.u_scale) +
           ", phi_u = " + text(std::arg(cycle.harmonics.front().G)) + ")";
    if (cycle.biased()) {
        why += "; the mean of y over the mean of u is " +
               text(cycle.static_gain() * r.scale.y_scale / r.scale.u_scale) +
               ", which a load or a wrong rest level would explain";
    }
    return {ErrorKind::not_identifiable, "identify/method", why + ". Use method output_error."};
}

Expected<IdentifiedModel> by_relay_formulas(const CleanRecord& record, const IdentifyOptions& options) {
    if (options.model == ModelChoice::sopdt || options.model == ModelChoice::sopdt_zero) {
        return Error{ErrorKind::unsupported, "identify/model",
                     "The relay formulas give models fopdt, ipdt and ipdt_lag; use method output_error for a second "
                     "order."};
    }
    const double noise = std::max(noise_std(record.y), quantisation_step(record.y) / std::sqrt(12.0));
    const Expected<RecordedCycle> cycle = find_cycle(record, noise);
    if (!cycle) return cycle.error();
    const Expected<double> sigma = shift_of(options, record, *cycle);
    if (!sigma) return sigma.error();
    const std::complex<double> shifted = shifted_response(record, *cycle, *sigma);
    const std::vector<RelayModel> models = relay_models(*cycle, shifted, *sigma, options.model);
    if (models.empty()) return no_relay_model(record, *cycle, options.model);
    const RelayModel& chosen = models.front();
    IdentifiedModel model = formula_model(record, chosen.shape, chosen.K, cycle->rest.v);
    model.choice_reason = std::string(name_of(chosen.shape.structure)) + " by the relay formulas " +
                          (chosen.by_static_gain                       ? "(11), (12), (14)"
                           : chosen.shape.structure == Structure::ipdt ? "(4) of an integrator"
                                                                       : "(11) to (13)") +
                          ": it repeats the steady oscillation best.";
    add_cycle(record, *cycle, {*sigma / record.scale.t_scale, shifted}, model);
    model.limit_cycle->fit_rms = chosen.fit_rms * record.scale.y_scale;
    warn_formula(record, *cycle, chosen, noise, model.warnings);
    return model;
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

/// What the model is held to where its structure does not fit: the measured response at the oscillation, and the static
/// gain where the test shows it.
std::vector<FrequencyConstraint> anchors_of(const ModelSearch& search, const RecordedCycle& cycle) {
    constexpr double kHeldWithin = 3e-4;  // relative: tighter than any fit's own error, loose enough to be solved
    const Fit& fit = search.chosen();
    const double rms = std::sqrt(fit.sse / static_cast<double>(fit.residual.size()));
    const std::complex<double> G = cycle.harmonics.front().G;
    std::vector<FrequencyConstraint> anchors = {{cycle.omega(), G, rms / (kHeldWithin * std::abs(G))}};
    constexpr double kMoved = 0.01;  // of half a swing of u: less divides noise by noise
    const double gain = cycle.static_gain(), sign = cycle.reversed ? -1 : 1;
    const bool shows_gain = cycle.biased() && std::abs(cycle.v_mean - cycle.rest.v) > kMoved * cycle.v_half &&
                            cycle.drift == 0 && !search.disturbances.slope && !search.disturbances.load &&
                            gain * sign > std::abs(G);
    if (shows_gain) anchors.push_back({0, gain, rms / (kHeldWithin * std::abs(gain))});
    return anchors;
}

void warn_mismatch(const RecordedCycle& cycle, bool gain_held, double left, std::vector<Warning>& warnings) {
    std::string detail = "The structure does not fit this plant: it leaves " + text(100 * left, 3) +
                         " % of y's variation beyond noise. The model is held to the response measured at the "
                         "oscillation";
    detail += gain_held ? " and to the static gain." : ".";
    if (!gain_held) {
        detail += cycle.biased() ? " The static gain is not reliable: a load or an unknown rest level is in the record."
                                 : " The test has no bias, so the static gain is unknown.";
    }
    warnings.push_back({"structure-mismatch", detail});
}

/// At the oscillation a lag much longer than its period looks like an integrator: the static gain comes from the
/// structure alone. Where the model leaves more than noise (`left` of y's variation) or a pattern, the structure is not
/// the plant's: then what it says far from the oscillation is open.
void warn_extrapolated_gain(const std::optional<double>& omega, const Fit& fit, double left,
                            std::vector<Warning>& warnings) {
    constexpr double kFar = 2;         // lag times omega from which a lag looks like an integrator
    constexpr double kPlainly = 0.02;  // of y's variation, beyond noise
    constexpr double kPattern = 2;     // samples of correlation time: white noise has 1
    const Structure structure = fit.form.structure;
    const bool another = left > kPlainly || correlation_time(fit.residual) > kPattern;
    if (is_integrating(structure) || structure == Structure::unstable) {
        if (!another) return;
        warnings.push_back({"gain-from-oscillation",
                            "The model leaves more than noise, so whether the plant integrates, is unstable or has a "
                            "static gain K is open: a relay's oscillation says little about it. Make a step test."});
        return;
    }
    const double lag = has_quadratic(structure) ? fit.shape.a1() : fit.shape.T();
    if (omega && lag * *omega >= kFar) {
        warnings.push_back({"gain-from-oscillation",
                            "The relay's oscillation shows the plant where its lags times omega are " +
                                text(lag * *omega, 2) +
                                ": the static gain K is extrapolated by the model's structure. The design rests on "
                                "what is measured near the oscillation; a step test shows the gain."});
    } else if (another) {
        warnings.push_back({"gain-from-oscillation",
                            "The model leaves more than noise, and a relay's oscillation shows the plant near one "
                            "frequency: the static gain K may be off by more than its standard error. A step test "
                            "shows it."});
    }
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

/// The quickest lag of a fit, as part of the record's length.
double quickest_lag(const Fit& fit) {
    if (fit.form.structure == Structure::ipdt) return 1;
    const double lag = has_quadratic(fit.form.structure) ? fit.shape.a2() / fit.shape.a1() : fit.shape.T();
    return fit.form.structure == Structure::third ? std::min(lag, fit.shape.T3()) : lag;
}

/// The models of a record, its false readings left out. Of a long one, means over blocks are fitted, u as it is: a
/// block of length h changes what a lag T leaves by (h/T)^2/24, 5e-4 for ten blocks. Quicker plants get shorter ones.
ModelSearch searched(CleanRecord& record, ModelChoice model, const RunControl& control) {
    constexpr int kEnough = 20'000, kMaxFitted = 100'000;  // more samples add time, and no digits that count
    constexpr double kBlocks = 10;                         // in the quickest lag
    const auto search_of = [&](int most) {
        return search_models(block_means(record, most), model, kind_of(record) == RecordKind::relay, control);
    };
    ModelSearch search = search_of(kEnough);
    const bool quick = search.choice.index < 0 || quickest_lag(search.chosen()) * kEnough < kBlocks;
    if (quick && record.samples() > kEnough && !control.stop.stop_requested()) search = search_of(kMaxFitted);
    if (search.choice.index < 0 || control.stop.stop_requested()) return search;
    return without_false_readings(std::move(search), record, model, control);
}

Expected<IdentifiedModel> by_output_error(const CleanRecord& record, ModelSearch search, const IdentifyOptions& options,
                                          const RunControl& control) {
    constexpr double kUnexplained = 0.004;  // of y's variation: less is not worth another structure
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
    // Where the rows show u late, the phase that they show at the oscillation is late too.
    const bool unexplained = left > kUnexplained && leaves_a_pattern(search.context, search.chosen());
    if (whole && cycle && unexplained && cycle->periods > 1 && !search.context.record.moved_between_rows) {
        const std::vector<FrequencyConstraint> anchors = anchors_of(search, *cycle);
        constrain(search, anchors, options.model, control);
        if (control.stop.stop_requested()) return cancelled();
        warn_mismatch(*cycle, anchors.size() > 1, left, warnings);
    }
    if (options.model != ModelChoice::automatic)
        search.choice.reason = std::string(name_of(search.chosen().form.structure)) + " was asked for.";

    std::vector<Warning> last;
    if (kind == RecordKind::relay)
        warn_extrapolated_gain(cycle ? std::optional(cycle->omega()) : std::nullopt, search.chosen(), left, last);
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

/// What a record is fitted as.
struct Fitted {
    CleanRecord record;
    ModelSearch search;
    std::optional<InputLimits> u_limits;
};

/// Where u runs beyond ends that are usual for a controller's output and the fit leaves a pattern: with u cut to them,
/// kept if that leaves a third of the sum of squares or less.
void try_limits(const Record& record, ModelChoice model, const RunControl& control, Fitted& fitted) {
    constexpr double kMuchLess = 3;  // times, so that chance alone never cuts u
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
        if (kMuchLess * mean_square(search.chosen()) > mean_square(fitted.search.chosen())) continue;
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
            " and y follows it only as far as that: it was logged before its limiter. Give u_limits if these are not "
            "the ends.");
    return model;
}

}  // namespace

Expected<IdentifiedModel> identify(const Record& record, const IdentifyOptions& options, const RunControl& control) {
    const Expected<CleanRecord> clean = clean_record(record);
    if (!clean) return clean.error();
    if (auto error = refuse_late_step(*clean)) return *error;
    const Expected<std::optional<LoopRecord>> loop = find_loop(*clean, record);
    if (!loop) return loop.error();
    const bool by_formula = options.method == IdentifyMethod::relay_fourier;
    Expected<IdentifiedModel> model = by_formula                                    ? by_relay_formulas(*clean, options)
                                      : options.method == IdentifyMethod::two_point ? by_two_points(*clean, options)
                                      : *loop ? identify_in_loop(*clean, **loop, options.model, control)
                                              : by_fitting(record, *clean, options, control);
    if (!model) return model;
    *loop ? report_loop(**loop, *model) : doubt_open_loop(*clean, *model);
    add_excited_band(*clean, *model);
    add_ultimate_point(*model);
    if (control.progress) control.progress({1, "identify", "model found", std::nullopt});
    return model;
}

}  // namespace tunewright
