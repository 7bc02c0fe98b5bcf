#include "engine/identification/search/model_answer.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "engine/identification/fit/nuisance.h"
#include "engine/identification/fit/uncertainty.h"
#include "engine/identification/record/data_quality.h"
#include "engine/identification/search/diagnosis.h"
#include "engine/identification/search/move_times.h"
#include "engine/identification/search/play.h"
#include "engine/number_text.h"
#include "engine/plant/linear/linear_plant.h"

namespace tunewright {
namespace {

constexpr int kTracePoints = 2000;

/// The samples that a plot shows: all, or evenly chosen ones.
std::vector<int> shown(int n) {
    const int points = std::min(n, kTracePoints);
    std::vector<int> rows;
    rows.reserve(static_cast<std::size_t>(points));
    for (int k = 0; k < points; ++k)
        rows.push_back(points == 1 ? 0 : static_cast<int>(static_cast<long long>(k) * (n - 1) / (points - 1)));
    return rows;
}

FitTrace trace_of(const CleanRecord& r, const std::vector<double>& y_model) {
    FitTrace trace;
    const std::vector<double>& levels = r.play ? r.v_recorded : r.v_level;
    int change = 0;
    double v = 0;
    for (const int i : shown(r.samples())) {
        trace.t.push_back(r.scale.t_origin + r.scale.t_scale * r.t[i]);
        for (; change < r.changes() && r.v_time[change] <= r.t[i]; ++change) v = levels[change];
        trace.u.push_back(r.scale.u_rest + r.scale.u_scale * v);
        trace.y.push_back(r.scale.y_origin + r.scale.y_scale * r.y[i]);
        trace.y_model.push_back(r.scale.y_origin + r.scale.y_scale * y_model[i]);
    }
    return trace;
}

void add_record_warnings(const CleanRecord& record, IdentifiedModel& model) {
    for (Warning& warning : record_warnings(record, model.data_quality)) model.warnings.push_back(std::move(warning));
}

void note_start(const CleanRecord& record, const Fit& fit, DataQuality& quality) {
    if (!fit.form.other_level && !(fit.form.slope && is_integrating(fit.form.structure))) return;
    constexpr double kStepRounding = 1e-12;  // of u's steps
    const double rest = level_of_rest(fit), moved = std::abs(rest) > kStepRounding ? rest : 0;
    const double level = moved * record.scale.u_scale + record.scale.u_rest;
    quality.notes.push_back("The record does not start at rest: y is at rest for u = " + text(level) +
                            ", as estimated from the record (the first u is " + text(record.scale.u_rest) +
                            "). Give u0 if it is known.");
}

/// Relative to the record's length: a longer lag may be an integrator, or a drift.
constexpr double kMinSlowLag = 0.5;

/// In addition to a fast part, a slow part of many record lengths and a drift look the same.
void warn_slow_part(const CleanRecord& r, const Fit& fit, std::vector<Warning>& warnings) {
    if (fit.form.structure != Structure::sopdt_zero || fit.shape.slowest_lag() < kMinSlowLag) return;
    warnings.push_back(
        {"slow-part", "A part of the response has a lag of " + text(fit.shape.slowest_lag() * r.scale.t_scale, 3) +
                          ", more than half of the record. It may belong to the plant or be a drift, so the static "
                          "gain K is uncertain. Record longer, or choose the model fopdt or sopdt."});
}

/// The beginning of a slow response cannot be distinguished from that of an integrator if the test ends before it has
/// settled.
void warn_slow_or_integrating(const ModelSearch& search, std::vector<Warning>& warnings) {
    constexpr double kStrongEvidence = 10, kMinPercentGain = 1;
    const auto chosen = static_cast<std::size_t>(search.choice.index);
    const bool integrating = is_integrating(search.chosen().form.structure);
    if (search.chosen().form.structure == Structure::unstable) return;
    const double scale = search.context.record.scale.t_scale;
    if (!integrating && search.chosen().shape.slowest_lag() < kMinSlowLag) return;
    for (std::size_t i = 0; i < search.fits.size(); ++i) {
        const Fit& fit = search.fits[i];
        if (!fit.determined || fit.form.structure == Structure::unstable || is_nearly_integrating(fit)) continue;
        if (is_integrating(fit.form.structure) == integrating) continue;
        if (search.criteria[i] - search.criteria[chosen] > kStrongEvidence &&
            search.percents[chosen] - search.percents[i] > kMinPercentGain)
            continue;
        const Fit& slow = integrating ? fit : search.chosen();
        warnings.push_back({"slow-or-integrating",
                            "A response with a time constant of " + text(slow.shape.slowest_lag() * scale, 3) +
                                " explains this record as well as an integrator does: the record ends too early to "
                                "decide, and the static gain is uncertain. Record longer, or choose the model from "
                                "your knowledge of the process."});
        return;
    }
}

void warn_disturbances(const CleanRecord& r, const Fit& fit, std::vector<Warning>& warnings) {
    if (fit.form.slope && !is_integrating(fit.form.structure)) {
        const double slope = fit.linear[fit.form.slope_index()] * r.scale.y_scale / r.scale.t_scale;
        warnings.push_back({"drift", "y drifts by " + text(slope, 3) +
                                         " per unit of time in addition to its response "
                                         "to u (" +
                                         text(slope * r.scale.t_scale, 3) +
                                         " over the record). The model was fitted together with this drift."});
    }
    if (fit.form.load) {
        const double size = fit.linear[fit.form.load_index()] / fit.linear[0] * r.scale.u_scale;
        warnings.push_back(
            {"load-disturbance",
             "According to the fit, a lasting load as large as " + text(size, 3) +
                 " of u reached the plant at about t = " +
                 text(r.scale.t_origin + r.scale.t_scale * fit.shape.load_time(), 4) +
                 ". The model was fitted together with this load; if possible, repeat the test without it." +
                 (load_over_move(r, fit) > 0
                      ? " It begins together with a move of u, which may have another effect instead, as behind a "
                        "backlash or with a gain that varies: the standard error of K includes this."
                      : "")});
    }
}

/// u was moved by less than the plant noticed: the model is that of the plant behind the play.
void tell_play(const CleanRecord& r, IdentifiedModel& model) {
    if (!r.play) return;
    const double width = r.play->width * r.scale.u_scale;
    model.data_quality.backlash = width;
    model.warnings.push_back(
        {"backlash", "After u turns back, the first " + text(width, 3) +
                         " of its move have no effect on y: backlash or friction, for example of a valve. The model is "
                         "that of the plant without it. Where the record does not show how much of the first move was "
                         "lost too, K may be larger, and its standard error includes that. A controller with integral "
                         "action cycles around the set point behind a backlash: have it repaired."});
}

void note_disturbances(IdentifiedModel& model) {
    for (const DisturbanceModel& one : model.disturbances) {
        model.data_quality.notes.push_back("The measured disturbance \"" + one.name + "\" makes " +
                                           text(100 * one.share, 2) +
                                           " % of the explained variance of y: it was identified together with u, and "
                                           "its own model is in disturbances.");
    }
}

/// A structure that Akaike's criterion does not distinguish from the chosen one.
struct OpenChoice {
    std::size_t index = 0;  ///< index of the fit
    double weight = 0;      ///< its likelihood by that criterion, relative to the chosen one's
};

/// The other structures of the same kind as the chosen one that Akaike's criterion does not distinguish from it: less
/// than 4 above it (Burnham and Anderson 2002, section 2.6).
std::vector<OpenChoice> open_choices(const ModelSearch& search) {
    constexpr double kMaxOpenCriterion = 4;
    const auto chosen = static_cast<std::size_t>(search.choice.index);
    const double log_n = std::log(search.independent);
    const auto akaike = [&](std::size_t i) {
        return search.criteria[i] + (2 - log_n) * search.fits[i].form.parameters();
    };
    std::vector<OpenChoice> open;
    if (search.chosen().form.structure == Structure::unstable) return open;
    for (std::size_t i = 0; i < search.fits.size(); ++i) {
        const Fit& fit = search.fits[i];
        if (i == chosen || !fit.determined || is_nearly_integrating(fit) || fit.form.structure == Structure::unstable ||
            is_integrating(fit.form.structure) != is_integrating(search.chosen().form.structure))
            continue;
        const double above = akaike(i) - akaike(chosen);
        if (above <= kMaxOpenCriterion) open.push_back({i, std::exp(-0.5 * std::max(above, -2 * kMaxOpenCriterion))});
    }
    return open;
}

bool knows_gain(const FittedPlant& plant) { return plant.standard_errors.at("K") <= std::abs(plant.values.at("K")); }

/// The variance of K including the uncertainty of the structure, at least the chosen one's own: the mean over the open
/// structures of own variance plus squared distance from the chosen one's K (Burnham and Anderson 2002, section 4.3). A
/// structure that does not determine K contributes only the size of K.
double open_choice_variance(const FittedPlant& chosen, const std::vector<FittedPlant>& plants,
                            const std::vector<OpenChoice>& open) {
    const double its_own = std::pow(chosen.standard_errors.at("K"), 2);
    double sum = its_own, weights = 1;
    for (const auto& [index, weight] : open) {
        const FittedPlant& other = plants[index];
        const double K = other.values.at("K"), own = std::min(other.standard_errors.at("K"), std::abs(K)),
                     apart = K - chosen.values.at("K");
        sum += weight * (own * own + apart * apart);
        weights += weight;
    }
    return std::max(its_own, sum / weights);
}

/// The other parameters change with K according to the covariance: a plant with another gain must still respond to u as
/// in the record.
void widen_gain(FittedPlant& plant, double variance) {
    ParameterCovariance& covariance = plant.covariance;
    const auto at = static_cast<std::size_t>(std::ranges::find(covariance.names, "K") - covariance.names.begin());
    const double own = covariance.matrix[at][at];
    if (!(own > 0)) return;
    std::vector<double> along;
    for (const double with_K : covariance.matrix[at]) along.push_back(with_K / own);
    for (std::size_t i = 0; i < along.size(); ++i) {
        for (std::size_t k = 0; k <= i; ++k) {
            covariance.matrix[i][k] += (variance - own) * along[i] * along[k];
            covariance.matrix[k][i] = covariance.matrix[i][k];
        }
        plant.standard_errors[covariance.names[i]] = std::sqrt(covariance.matrix[i][i]);
    }
}

/// A load that begins with the response to a move may be another effect of that move: K as of the other moves, or as of
/// this one.
void widen_for_load_at_move(const CleanRecord& record, const Fit& fit, FittedPlant& plant) {
    const double apart = load_over_move(record, fit) * plant.values.at("K");
    if (apart != 0) widen_gain(plant, std::pow(plant.standard_errors.at("K"), 2) + apart * apart);
}

/// The columns take most of the memory of a long record's fits.
void forget_columns(Fit& fit) {
    fit.J.clear();
    fit.nuisance.clear();
}

}  // namespace

IdentifiedModel searched_model(ModelSearch search, const CleanRecord& recorded) {
    const CleanRecord& record = search.context.record;
    const FitData data = search.context.all();
    IdentifiedModel model;
    model.data_quality = describe_record(recorded);
    // Means over blocks have no grid.
    const double grid =
        recorded.samples() == record.samples() ? model.data_quality.quantisation / record.scale.y_scale : 0;
    const double noise = model.data_quality.noise_std / record.scale.y_scale;
    const auto chosen = static_cast<std::size_t>(search.choice.index);
    std::vector<OpenChoice> open = open_choices(search);
    const auto may_be_answered = [&](std::size_t i) {
        return i == chosen || std::ranges::find(open, i, &OpenChoice::index) != open.end();
    };
    std::vector<FittedPlant> plants(search.fits.size());
    parallel_for(search.context.spread, static_cast<int>(plants.size()), [&](int index) {
        const auto i = static_cast<std::size_t>(index);
        Fit& fit = search.fits[i];
        if (!fit.determined) return;
        jacobian(data, fit);
        take_out_unknowns(joined(time_unknowns(record, fit), play_unknowns(record, fit)), fit);
        const LoadDoubt load = may_be_answered(i) ? LoadDoubt::counted : LoadDoubt::left_out;
        plants[i] = fitted_plant(record, fit, grid, noise, load);
        if (i != chosen) forget_columns(fit);
    });
    // A relay's record does not determine the static gain for every structure: one that explains it without determining
    // the gain counts.
    if (!search.context.relay)
        std::erase_if(open, [&](const OpenChoice& other) { return !knows_gain(plants[other.index]); });
    for (const OpenChoice& other : open) model.alternatives.push_back(plants[other.index].plant);
    if (!open.empty()) widen_gain(plants[chosen], open_choice_variance(plants[chosen], plants, open));
    widen_for_load_at_move(record, search.fits[chosen], plants[chosen]);
    plants[chosen].covariance.reach = region_reach(record, search.fits[chosen], plants[chosen]);
    forget_columns(search.fits[chosen]);
    std::vector<int> order(search.fits.size());
    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return search.criteria[a] < search.criteria[b]; });
    for (const int i : order) {
        Fit& fit = search.fits[i];
        if (!fit.determined) continue;
        FittedPlant& fitted = plants[static_cast<std::size_t>(i)];
        FitTrace trace = trace_of(record, fit.model);
        model.candidates.push_back(
            {fitted.plant, search.percents[i], search.criteria[i], fitted.standard_errors, trace.y_model});
        if (i != search.choice.index) continue;
        Diagnosis diagnosis = diagnose(record, fit, fitted.values, fitted.standard_errors, model.data_quality);
        model.plant = fitted.plant;
        model.fit_percent = search.percents[i];
        model.standard_errors = std::move(fitted.standard_errors);
        model.covariance = std::move(fitted.covariance);
        model.disturbances = std::move(fitted.disturbances);
        model.choice_reason = search.choice.reason;
        model.fit = std::move(trace);
        model.data_quality.settled = diagnosis.settled;
        model.warnings = std::move(diagnosis.warnings);
        warn_disturbances(record, fit, model.warnings);
        tell_play(record, model);
        note_disturbances(model);
        warn_slow_or_integrating(search, model.warnings);
        warn_slow_part(record, fit, model.warnings);
        add_record_warnings(recorded, model);
        note_start(record, fit, model.data_quality);
    }
    if (search.part < 1) {
        model.data_quality.notes.push_back("The model is based on the first " + text(100 * search.part, 2) +
                                           " % of the record, because over the whole record the free run of an "
                                           "unstable plant is numerically meaningless.");
    }
    if (at_shortest_lag(search.chosen())) {
        model.warnings.push_back(
            {"record-too-long",
             "The unstable model's time constant is the smallest that a record of this length can show (a twentieth of "
             "it), so it is only a bound. Give only the first few oscillations (`from`, `to`)."});
    }
    if (record.moves_placed > 0) {
        model.data_quality.notes.push_back(
            std::to_string(record.moves_placed) +
            " change(s) of u happened where rows are missing: each is placed where it explains y best.");
    }
    if (record.switches_placed > 0) {
        model.warnings.push_back({"coarse-relay-record",
                                  "The rows are too far apart to show when the relay switched: each switch is placed "
                                  "between two rows where it explains y best, and the standard errors do not include "
                                  "this. Record at least 40 rows per period."});
    }
    if (!record.v_open.empty()) {
        const auto moves = std::ranges::count_if(record.v_open, [](double length) { return length > 0; });
        model.data_quality.notes.push_back(std::to_string(moves) +
                                           " change(s) of u happened between rows: their times are estimated with the "
                                           "model, each within its row, and the standard errors include this.");
    }
    if (record.moves_unseen > 0) {
        model.warnings.push_back(
            {"unseen-move", "u moved while nothing was recorded: rows are missing for " +
                                text(record.moves_unseen * record.scale.t_scale, 3) +
                                " before the record shows the move. The move is assumed to be in the middle of them, "
                                "so the dead time may be wrong by half of that; its standard error includes this. "
                                "Repeat the test with the recorder running, or give the row at which u moved."});
    }
    if (record.moved_within > 0 && record.v_open.empty()) {
        model.data_quality.notes.push_back(
            "The time of the move of u is known only to one row (" +
            text(usual_spacing(record) * record.scale.t_scale, 3) +
            "), which is not small compared with the dead time: if u moved between two rows, L is longer by up to that "
            "time, and its standard error includes this. Record faster around the step for a better L.");
    }
    if (record.moved_between_rows) {
        model.data_quality.notes.emplace_back(
            "u is assumed to change midway between the row that shows it and the previous row, because the samples are "
            "not evenly spaced and y responds earlier than the rows of u allow.");
    }
    return model;
}

IdentifiedModel formula_model(const CleanRecord& record, const ModelShape& shape, double K, double v_rest) {
    static constexpr double kAtOnce[] = {0}, kUnit[] = {1};
    UnitResponse response, level;
    unit_response(record.t, {record.v_time, record.v_level}, shape, 0, response);
    unit_response(record.t, {kAtOnce, kUnit}, shape, 0, level);
    const auto n = static_cast<std::size_t>(record.samples());
    std::vector<double> y_model(n);
    for (std::size_t i = 0; i < n; ++i) y_model[i] = K * (response.x[i] - v_rest * level.x[i]);
    double offset = 0;
    for (std::size_t i = 0; i < n; ++i) offset += (record.y[i] - y_model[i]) / static_cast<double>(n);
    for (double& y : y_model) y += offset;

    Fit fit;
    fit.form.structure = shape.structure;
    fit.shape = shape;
    fit.linear = {K, offset};
    fit.determined = true;
    for (std::size_t i = 0; i < n; ++i) fit.residual.push_back(record.y[i] - y_model[i]);
    IdentifiedModel model;
    model.plant = plant_in_units(record.scale, fit);
    model.fit_percent = fit_percent(record, fit);
    model.fit = trace_of(record, y_model);
    model.data_quality = describe_record(record);
    add_record_warnings(record, model);
    model.candidates.push_back({model.plant, model.fit_percent, 0, {}, model.fit.y_model});
    return model;
}

void add_cycle(const CleanRecord& r, const RecordedCycle& cycle, const Shift& shift, IdentifiedModel& model) {
    constexpr double kTwoPi = 2 * std::numbers::pi;
    const double unit = r.scale.y_scale / r.scale.u_scale;
    auto lag = [](std::complex<double> G) { return std::arg(G) > 0 ? std::arg(G) - kTwoPi : std::arg(G); };
    const Harmonic& first = cycle.harmonics.front();
    LimitCycle answer;
    answer.Pu = cycle.period * r.scale.t_scale;
    answer.Au = std::abs(first.G) * unit;
    answer.phi_u = lag(first.G);
    answer.periods = cycle.periods;
    answer.shift = ShiftedPoint{shift.sigma, std::abs(shift.value) * unit, lag(shift.value)};
    answer.describing_function = UltimatePoint{
        (cycle.reversed ? -1 : 1) * 4 * cycle.v_half / (std::numbers::pi * cycle.y_half) / unit, answer.Pu};
    model.limit_cycle = answer;
    for (const Harmonic& h : cycle.harmonics) {
        const bool known = std::abs(h.U) > 0.03 * std::abs(first.U) && h.G_std < 0.2 * std::abs(h.G);
        if (h.order > 1 && !known) continue;
        model.frequency_points.push_back(
            {h.order * cycle.omega() / r.scale.t_scale, h.G.real() * unit, h.G.imag() * unit, h.G_std * unit});
    }
    model.data_quality.notes.push_back(
        "The relay's oscillation repeats " + std::to_string(cycle.periods) + " times (" +
        std::to_string(cycle.recorded_periods) + " whole periods are recorded), its period " + text(answer.Pu) +
        (cycle.periods > 1 ? " +- " + text(cycle.period_scatter * r.scale.t_scale, 2) : "") + ".");
}

void add_excited_band(const CleanRecord& record, IdentifiedModel& model) {
    constexpr double kResolution = 1e-3;  // of y's range: least resolution of any sensor
    const double rounding = model.data_quality.quantisation / std::sqrt(12.0);
    const double noise = std::max({model.data_quality.noise_std, rounding, kResolution * record.scale.y_scale});
    model.excited_band = excited_band(
        {model.fit.t, model.fit.u, record.scale.u_rest, model.data_quality.sample_time, noise}, model.plant);
}

void add_ultimate_point(IdentifiedModel& model) {
    if (const auto plant = LinearPlant::make(model.plant)) model.ultimate_point = ultimate_point(*plant);
}

}  // namespace tunewright
