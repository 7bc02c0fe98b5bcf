// The search of one record's models, in this order. Each attempt either replaces the search by a better one or does not
// change it:
//
//  1. Fit the structures of the request, simpler ones first, from each other's results; more complex ones if a pattern
//     or more than noise remains. Choose by the information criterion (candidates.h).
//  2. For a relay test that no model explains, or with an unstable model over too long a time: try only the beginning.
//  3. For a pattern in unevenly spaced rows: let u change midway between its rows.
//  4. For moves of u in gaps: place them at the missing rows where they explain y best.
//  5. For moves of u within their rows: estimate their times with the model; for a relay also place its switches where
//     they explain y best, and keep the better result.
//  6. A pattern still: a drift, a load, both; or a play between u and the plant.
//  7. Replace a slow part by a drift if that is as good; then try a drift that leaves no pattern.
//  8. Determine how late the rows may show u, for the errors of the dead time.
//
// The order matters: a misplaced move of u looks like a lag or a drift, and a drift explains part of a lag's response.
#include "engine/identification/search/model_search.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>
#include <optional>
#include <string>
#include <utility>

#include "engine/identification/record/series.h"
#include "engine/identification/search/move_times.h"
#include "engine/identification/search/play.h"
#include "engine/identification/search/record_repair.h"

namespace tunewright {
namespace {

constexpr ModelSearchConstants k;

/// The structures to fit, simpler ones first, those to fit if these leave a pattern, and those that are allowed as a
/// result: the others only give starting values.
struct Plan {
    std::vector<Structure> fitted, answers, richer = {};
};

Plan plan_for(ModelChoice model, const CleanRecord& record) {
    using enum Structure;
    // An unstable plant is recorded under feedback, so u moves often; after a single step any curve may look like its
    // beginning.
    const bool maybe_unstable = record.changes() > 2;
    Plan plan;
    switch (model) {
        case ModelChoice::fopdt:
            plan.fitted = {fopdt};
            if (maybe_unstable) plan.fitted.push_back(unstable);
            plan.answers = plan.fitted;
            return plan;
        case ModelChoice::sopdt: return {{fopdt, sopdt}, {sopdt}};
        case ModelChoice::sopdt_zero: return {{fopdt, sopdt, sopdt_zero}, {sopdt_zero}};
        case ModelChoice::ipdt: return {{ipdt}, {ipdt}};
        case ModelChoice::ipdt_lag: return {{ipdt, ipdt_lag}, {ipdt_lag}};
        case ModelChoice::automatic: break;
    }
    plan.fitted = {ipdt, fopdt, ipdt_lag, sopdt, sopdt_zero};
    if (maybe_unstable) plan.fitted.push_back(unstable);
    plan.richer = {third, ipdt_second};
    plan.answers = plan.fitted;
    plan.answers.insert(plan.answers.end(), plan.richer.begin(), plan.richer.end());
    return plan;
}

void report(const RunControl& control, double fraction, std::string message) {
    if (control.progress) control.progress({fraction, "identify", std::move(message), nullptr});
}

/// A relay with the wrong sign does not oscillate. A structure whose gain has that sign explains a drift or a load
/// instead, and is left out unless the others explain much less.
void leave_out_wrong_signs(ModelSearch& search) {
    const auto wrong = [&](const Fit& fit) {
        return search.context.gain_sign != 0 && fit.form.structure != Structure::unstable &&
               fit.linear[0] * search.context.gain_sign < 0;
    };
    double best = 0, best_right = 0;
    for (std::size_t i = 0; i < search.fits.size(); ++i) {
        if (!search.fits[i].determined) continue;
        best = std::max(best, search.percents[i]);
        if (!wrong(search.fits[i])) best_right = std::max(best_right, search.percents[i]);
    }
    if (best_right < best - k.max_sign_cost) return;
    for (Fit& fit : search.fits) fit.determined = fit.determined && !wrong(fit);
}

ModelSearch ranked(FitContext context, std::vector<Fit> fits, const Plan& plan, const Disturbances& disturbances) {
    std::erase_if(fits, [&](const Fit& fit) {
        return std::find(plan.answers.begin(), plan.answers.end(), fit.form.structure) == plan.answers.end();
    });
    ModelSearch search{std::move(context), std::move(fits), {}, {}, kMinIndependent, {}, disturbances};
    finish_fits(search.context, search.fits);
    const Fit* best = best_fit(search.fits);
    if (best != nullptr) search.independent = effective_samples(best->residual);
    const double noise = known_noise(search.context, best), min = k.min_noise_share * noise * noise;
    for (const Fit& fit : search.fits) {
        search.criteria.push_back(information_criterion(fit, search.independent, min));
        search.percents.push_back(fit_percent(search.context.record, fit));
    }
    leave_out_wrong_signs(search);
    search.choice = choose(search.fits, search.criteria, search.percents, search.independent);
    if (search.choice.index < 0) return search;
    const auto chosen = static_cast<std::size_t>(search.choice.index);
    polish(search.context, search.fits[chosen]);
    search.criteria[chosen] = information_criterion(search.fits[chosen], search.independent, min);
    search.percents[chosen] = fit_percent(search.context.record, search.fits[chosen]);
    return search;
}

/// True if another lag could explain the best fit's residual: it is more than noise, or not white. Always true after a
/// relay test, because the static gain depends on the structure.
bool wants_richer(const FitContext& context, const std::vector<Fit>& fits) {
    const Fit* best = best_fit(fits);
    if (best == nullptr || context.relay) return best != nullptr;
    const auto n = static_cast<double>(best->residual.size());
    return best->sse > k.richer_min_noise_variances * n * context.noise * context.noise ||
           correlation_time(best->residual) > k.richer_min_correlation;
}

std::string names_of(const std::vector<Structure>& structures) {
    std::string names;
    for (const Structure structure : structures) names += (names.empty() ? "" : ", ") + std::string(name_of(structure));
    return names;
}

ModelSearch fit_all(FitContext context, ModelChoice model, const Disturbances& disturbances,
                    const RunControl& control) {
    const Plan plan = plan_for(model, context.record);
    std::vector<Fit> fits;
    const auto fit = [&](const std::vector<Structure>& structures, double fraction) {
        if (structures.empty() || control.stop.stop_requested()) return;
        report(control, fraction, "fitting " + names_of(structures));
        std::ranges::move(fit_structures(context, structures, disturbances, fits), std::back_inserter(fits));
    };
    for (int level = 0; level <= k.max_depth; ++level) {
        std::vector<Structure> here;
        std::ranges::copy_if(plan.fitted, std::back_inserter(here), [&](Structure s) { return depth(s) == level; });
        fit(here, static_cast<double>(fits.size()) / static_cast<double>(plan.fitted.size()));
    }
    std::ranges::stable_sort(fits, {}, [&](const Fit& f) { return std::ranges::find(plan.fitted, f.form.structure); });
    if (!plan.richer.empty() && wants_richer(context, fits)) fit(plan.richer, 0.9);
    return ranked(std::move(context), std::move(fits), plan, disturbances);
}

/// Fits the chosen structure with disturbances, the one that it extends, and the simplest: the chosen one may have
/// taken the disturbance for its own response.
ModelSearch fit_some(const ModelSearch& search, ModelChoice model, const Disturbances& disturbances,
                     const RunControl& control) {
    const Structure chosen = search.chosen().form.structure;
    const Plan answers = plan_for(model, search.context.record);
    std::vector<Fit> fits;
    for (const Structure structure :
         {Structure::ipdt, Structure::fopdt, Structure::ipdt_lag, Structure::sopdt, chosen}) {
        const bool extended =
            is_integrating(structure) == is_integrating(chosen) && shape_size(structure) < shape_size(chosen);
        const bool simplest = structure == Structure::fopdt;
        if ((structure == chosen || extended || simplest) && !control.stop.stop_requested() &&
            std::none_of(fits.begin(), fits.end(), [&](const Fit& f) { return f.form.structure == structure; }))
            fits.push_back(fit_structure(search.context, structure, disturbances, fits));
    }
    return ranked(search.context, std::move(fits), answers, disturbances);
}

bool usable(const ModelSearch& search) { return search.choice.index >= 0; }

/// True if the rows are so far apart that they hardly show when u moved.
bool few_rows(const CleanRecord& record) { return record.samples() <= k.few_rows * record.changes(); }

void try_between_rows(ModelSearch& search, ModelChoice model, const RunControl& control) {
    if (!unevenly_spaced(search.context.record)) return;
    const CleanRecord moved = changed_between_rows(search.context.record);
    const Fit& now = search.chosen();
    const Fit fit = fit_shape({&moved, {}}, now.form, now.shape, {}, control.stop);
    // If rows were written at the changes there would be no pattern: late rows are more probable, unless the fit
    // contradicts.
    if (!fit.determined || fit.sse > k.between_rows_max_ratio * now.sse) return;
    ModelSearch other = fit_all(fit_context(moved, search.context.relay, control), model, {}, control);
    if (!usable(other) || other.chosen().sse > k.between_rows_max_ratio * now.sse) return;
    search = std::move(other);
}

/// A change of u in a gap of the record happened at a missing row, which the models determine. Kept if this reduces the
/// sum of squares to a third or less.
void try_gap_moves(ModelSearch& search, ModelChoice model, const RunControl& control) {
    // A few wrong rows are no pattern and look like noise, so the fit itself decides whether to search.
    if (search.percents[static_cast<std::size_t>(search.choice.index)] > k.explained_percent) return;
    const std::vector<int> moves = gap_moves(search.context.record);
    if (moves.empty() || static_cast<int>(moves.size()) > k.max_gap_moves) return;
    ModelSearch other = search;
    for (int round = 0; round < k.gap_rounds; ++round) {
        CleanRecord placed = with_gap_moves_placed(search.context.record, other.chosen(), moves, control.stop);
        ModelSearch next = fit_all(fit_context(std::move(placed), search.context.relay, control), model, {}, control);
        if (!usable(next) || next.chosen().sse >= other.chosen().sse) break;
        other = std::move(next);
    }
    if (k.gap_min_ratio * other.chosen().sse > search.chosen().sse) return;
    search = std::move(other);
}

/// `record` with the times of its moves estimated within their rows, from those of `search`, and its models; empty if y
/// does not show them.
std::optional<ModelSearch> with_times_estimated(const CleanRecord& record, const ModelSearch& search, ModelChoice model,
                                                const RunControl& control) {
    const double noise = search.context.noise, n = record.samples();
    if (record.row.empty() || record.changes() < 2) return std::nullopt;
    // With few rows per half period, misplaced switches leave a residual that looks like white noise.
    const bool pattern = (search.context.relay && few_rows(record)) ||
                         (search.chosen().sse > k.moves_min_noise_variances * n * noise * noise &&
                          correlation_time(search.chosen().residual) > k.moves_min_correlation);
    RunControl quiet = control;  // a search must not report progress that has been reported before
    quiet.progress = {};
    std::optional<ModelSearch> other;
    Fit start = search.chosen();
    std::vector<double> times = search.context.record.v_time;
    for (int round = 0; round < k.move_rounds && !control.stop.stop_requested(); ++round) {
        std::optional<CleanRecord> placed = with_move_times(record, times, start, noise, pattern, control.stop);
        if (!placed) break;
        times = placed->v_time;
        ModelSearch next = fit_all(fit_context(std::move(*placed), search.context.relay, quiet), model, {}, quiet);
        if (!usable(next) || (other && next.chosen().sse >= other->chosen().sse)) break;
        const bool same = next.chosen().form.structure == start.form.structure;
        start = next.chosen();
        other = std::move(next);
        if (same) break;
    }
    return other;
}

/// Tries moves of u between the rows, as y shows them.
void try_move_times(ModelSearch& search, ModelChoice model, const RunControl& control) {
    std::optional<ModelSearch> other = with_times_estimated(search.context.record, search, model, control);
    if (!other) return;
    const double less = search.chosen().sse / other->chosen().sse;
    if (less > (leaves_a_pattern(other->context, other->chosen()) ? k.moves_min_ratio_of_pattern : k.moves_min_ratio))
        search = std::move(*other);
}

/// A relay recorded in few rows per half period: each of its switches lies within the row that shows it. Kept if this
/// reduces the sum of squares to two thirds or less.
void try_switches_between_rows(ModelSearch& search, ModelChoice model, const RunControl& control) {
    if (search.percents[static_cast<std::size_t>(search.choice.index)] > k.explained_percent) return;
    const CleanRecord& record = search.context.record;
    const double rows = record.samples(), changes = record.changes();
    if (!few_rows(record) || rows * changes > k.max_switch_work) return;
    const auto fitted = [&](CleanRecord placed, ModelChoice choice) {
        return fit_all(fit_context(std::move(placed), true, control), choice, {}, control);
    };
    // A model with few parameters places them: one with more would also explain misplaced ones.
    ModelSearch other = fitted(changed_between_rows(record), ModelChoice::fopdt);
    for (int round = 0; round < k.switch_rounds && usable(other) && !control.stop.stop_requested(); ++round) {
        ModelSearch next = fitted(with_switches_placed(record, other.chosen(), control.stop), ModelChoice::fopdt);
        if (!usable(next) || next.chosen().sse >= other.chosen().sse) break;
        other = std::move(next);
    }
    if (!usable(other)) return;
    other = fitted(with_switches_placed(record, other.chosen(), control.stop), model);
    // Each place is an additional parameter.
    const double freedom = std::max(1 - changes / rows, k.min_freedom);
    if (!usable(other) || k.switches_min_ratio * other.chosen().sse > search.chosen().sse * freedom) return;
    search = std::move(other);
}

/// True if another lag explains the record as well as a drift (`by_drift`, criterion with `independent` samples): then
/// the lag is kept instead, and the choice is repeated.
bool another_lag_does(ModelSearch& search, ModelChoice model, double by_drift, double independent) {
    const Plan plan = plan_for(model, search.context.record);
    const auto fitted = [&](Structure structure) {
        return std::ranges::any_of(search.fits, [&](const Fit& f) { return f.form.structure == structure; });
    };
    if (plan.richer.empty() || fitted(Structure::third) || !fitted(Structure::sopdt)) return false;
    Fit richer = fit_structure(search.context, Structure::third, search.disturbances, search.fits);
    if (!richer.determined || information_criterion(richer, independent) > by_drift + k.as_good) return false;
    std::vector<Fit> fits = std::move(search.fits);
    fits.push_back(std::move(richer));
    search = ranked(search.context, std::move(fits), plan, search.disturbances);
    return true;
}

/// A slow part that is slower than the record may replace a drift: a drift is tried in its place, and kept if it
/// explains the record as well.
void try_drift_for_slow_part(ModelSearch& search, ModelChoice model, const RunControl& control) {
    const Fit& now = search.chosen();
    if (now.form.structure != Structure::sopdt_zero || now.shape.slowest_lag() < k.slow_part || now.form.slope) return;
    if (!shows_drift(search.context.record)) return;
    ModelSearch other = fit_all(search.context, model, {true, false}, control);
    if (!usable(other) || is_integrating(other.chosen().form.structure)) return;
    const double n = other.independent;
    if (information_criterion(other.chosen(), n) > information_criterion(now, n) + k.as_good) return;
    search = std::move(other);
}

/// A slow drift can be hidden in gain and time constant without leaving a pattern: its column is tried whenever the
/// record can show it.
void try_drift(ModelSearch& search, ModelChoice model, const RunControl& control) {
    const Fit& now = search.chosen();
    if (!shows_drift(search.context.record) || is_integrating(now.form.structure)) return;
    ModelForm form = now.form;
    form.slope = true;
    const Fit fit = fit_shape(search.context.some(), form, now.shape, k.rough, control.stop);
    const Fit plain = project(search.context.some(), now.form, now.shape);
    if (!fit.determined) return;
    // Low-frequency noise and a coarse grid look like a drift over the record.
    const double time = correlation_time(fit.residual), n = std::max(kMinIndependent, fit.residual.size() / time);
    const double lead = information_criterion(plain, n) - information_criterion(fit, n);
    if (lead < (time < k.white_correlation ? k.strong : k.very_strong)) return;
    if (std::abs(fit.linear[form.slope_index()]) < k.min_drift_steps * search.context.grid) return;
    if (another_lag_does(search, model, information_criterion(fit, n), n)) return;
    ModelSearch other = fit_all(search.context, model, {true, false}, control);
    if (!usable(other) || is_integrating(other.chosen().form.structure)) return;
    search = std::move(other);
}

/// Tries moves of u within their rows: all times estimated with the model, or a relay's switches placed where they
/// explain y best, whichever is better. With few rows per half period the joint estimate may end in another local
/// minimum.
void try_moves(ModelSearch& search, ModelChoice model, bool relay, const RunControl& control) {
    ModelSearch placed = search;
    try_move_times(search, model, control);
    if (!relay || control.stop.stop_requested()) return;
    const CleanRecord recorded = placed.context.record;
    try_switches_between_rows(placed, model, control);
    if (placed.context.record.switches_placed == 0) return;
    if (!search.context.record.v_open.empty() && placed.chosen().sse >= search.chosen().sse) return;
    search = std::move(placed);
    std::optional<ModelSearch> joint = with_times_estimated(recorded, search, model, control);
    if (joint && joint->chosen().sse < k.joint_max_ratio * search.chosen().sse) search = std::move(*joint);
}

void try_disturbances(ModelSearch& search, ModelChoice model, const RunControl& control) {
    const CleanRecord& record = search.context.record;
    if (unexplained_share(search.context, search.chosen()) < k.min_unexplained_share) return;
    const ModelSearch* best = &search;
    std::vector<ModelSearch> others;
    others.reserve(3);
    for (const Disturbances& d : {Disturbances{true, false}, Disturbances{false, true}, Disturbances{true, true}}) {
        if (control.stop.stop_requested()) return;
        if ((d.slope && !shows_drift(record)) || (d.load && !shows_load(record))) continue;
        // Both together only if neither alone explains the record.
        if (d.slope && d.load && !leaves_a_pattern(best->context, best->chosen())) break;
        others.push_back(fit_some(search, model, d, control));
        const ModelSearch& other = others.back();
        if (!usable(other) || !plausible_load(record, other.chosen())) continue;
        // If a pattern remains with the disturbance, it only replaces a structure that is missing.
        const double less = best->chosen().sse / other.chosen().sse;
        if (less < (leaves_a_pattern(other.context, other.chosen()) ? k.disturbance_min_ratio_of_pattern
                                                                    : k.disturbance_min_ratio))
            continue;
        const double n = other.independent;
        if (information_criterion(other.chosen(), n) + k.very_strong < information_criterion(best->chosen(), n))
            best = &other;
    }
    if (best == &search) return;
    ModelSearch whole = fit_all(search.context, model, best->disturbances, control);
    if (usable(whole) && plausible_load(record, whole.chosen())) search = std::move(whole);
}

/// The record behind the play with which the structure of `start` explains it best, and its models.
std::optional<ModelSearch> with_play_estimated(const CleanRecord& record, Fit start, ModelChoice model,
                                               const RunControl& control) {
    std::optional<ModelSearch> other;
    for (int round = 0; round < k.play_rounds && !control.stop.stop_requested(); ++round) {
        std::optional<CleanRecord> moved = with_play(record, start, control.stop);
        if (!moved) break;
        ModelSearch next = fit_all(fit_context(std::move(*moved), false, control), model, {}, control);
        if (!usable(next) || (other && next.chosen().sse >= other->chosen().sse)) break;
        start = next.chosen();
        other = std::move(next);
    }
    return other;
}

/// A play between u and the plant, in place of the drift or load that `search` may have; `without` is the search
/// without any of them. Kept if it explains the record as well as they do: that a load comes together with a move of u
/// is less likely than a valve with backlash. Not for relay tests: with two levels of u, which have different effects,
/// the gain may also be another one to each side.
void try_play(ModelSearch& search, const ModelSearch& without, ModelChoice model, const RunControl& control) {
    RunControl quiet = control;  // a search must not report progress that has been reported before
    quiet.progress = {};
    // The structure may be another one with a play: the best integrating and the best other one are tried.
    std::optional<ModelSearch> other;
    for (const bool integrating : {false, true}) {
        const Fit* start = nullptr;
        for (const std::vector<Fit>* fits : {&std::as_const(search.fits), &without.fits})
            for (const Fit& fit : *fits)
                if (fit.determined && is_integrating(fit.form.structure) == integrating &&
                    (start == nullptr || fit.sse < start->sse))
                    start = &fit;
        if (start == nullptr) continue;
        auto next = with_play_estimated(search.context.record, *start, model, quiet);
        if (next && (!other || information_criterion(next->chosen(), next->independent) <
                                   information_criterion(other->chosen(), next->independent)))
            other = std::move(next);
    }
    if (!other || control.stop.stop_requested()) return;
    const Fit &now = other->chosen(), &plain = without.chosen();
    // With a pattern left, it only replaces a load or a structure that is missing.
    if (plain.sse < k.disturbance_min_ratio * now.sse || leaves_a_pattern(other->context, now)) return;
    const double n = other->independent;
    const double with_width = information_criterion(now, n) + std::log(n);
    if (with_width + k.very_strong > information_criterion(plain, n)) return;
    if (with_width > information_criterion(search.chosen(), n) + k.as_good) return;
    search = std::move(*other);
}

/// True if an unstable model's free run lasts so many time constants that it is nearly arbitrary.
bool runs_too_long(const Fit& fit) {
    return fit.form.structure == Structure::unstable && fit.shape.T() < k.min_unstable_lag;
}

/// Kept if an unstable model explains the beginning alone, with a time constant that it can show.
void try_beginning(ModelSearch& search, const CleanRecord& record, ModelChoice model, const RunControl& control) {
    if (model != ModelChoice::automatic && model != ModelChoice::fopdt) return;
    std::vector<double> parts(k.beginnings.begin(), k.beginnings.end());
    if (search.percents[static_cast<std::size_t>(search.choice.index)] < k.badly_fitted_percent)
        parts.insert(parts.end(), k.more_beginnings.begin(), k.more_beginnings.end());
    for (const double part : parts) {
        if (control.stop.stop_requested()) return;
        const CleanRecord beginning = first_part(record, part);
        if (beginning.changes() < k.min_beginning_changes || beginning.samples() < k.min_beginning_samples) continue;
        ModelSearch other = fit_all(fit_context(beginning, true, control), model, {}, control);
        if (!usable(other) || other.chosen().form.structure != Structure::unstable) continue;
        if (at_shortest_lag(other.chosen()) || leaves_a_pattern(other.context, other.chosen())) continue;
        search = std::move(other);
        search.part = part;
        return;
    }
}

}  // namespace

ModelSearch search_models(const CleanRecord& record, ModelChoice model, bool relay, const RunControl& control) {
    ModelSearch search =
        fit_all(fit_context(with_unseen_moves(record).value_or(record), relay, control), model, {}, control);
    auto unexplained = [&] {
        return usable(search) && !control.stop.stop_requested() && leaves_a_pattern(search.context, search.chosen());
    };
    if (relay && usable(search) && (unexplained() || runs_too_long(search.chosen())))
        try_beginning(search, record, model, control);
    if (search.part < 1) return search;
    if (unexplained()) try_between_rows(search, model, control);
    if (usable(search) && !control.stop.stop_requested()) try_gap_moves(search, model, control);
    if (usable(search) && !control.stop.stop_requested()) try_moves(search, model, relay, control);
    if (unexplained()) {
        const ModelSearch plain = search;
        try_disturbances(search, model, control);
        if (!relay && !control.stop.stop_requested()) try_play(search, plain, model, control);
    }
    if (usable(search) && !control.stop.stop_requested() && !search.disturbances.slope) {
        try_drift_for_slow_part(search, model, control);
        if (!search.disturbances.slope) try_drift(search, model, control);
    }
    CleanRecord& fitted = search.context.record;
    if (!relay && usable(search) && !control.stop.stop_requested() && fitted.v_open.empty())
        fitted.moved_within = shown_within(fitted, search.chosen(), control.stop);
    return search;
}

ModelSearch ranked_anew(const ModelSearch& search, FitContext context, std::vector<Fit> fits, ModelChoice model) {
    return ranked(std::move(context), std::move(fits), plan_for(model, search.context.record), search.disturbances);
}

void constrain(ModelSearch& search, std::vector<FrequencyConstraint> anchors, ModelChoice model,
               const RunControl& control) {
    FitContext context = search.context;
    context.anchors = std::move(anchors);
    for (Fit& fit : search.fits)
        if (fit.determined) fit = fit_shape(context.some(), fit.form, fit.shape, {}, control.stop);
    search = ranked_anew(search, std::move(context), search.fits, model);
}

}  // namespace tunewright
