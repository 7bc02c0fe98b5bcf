#include "engine/identification/further_inputs/further_inputs.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "engine/numerics/statistics.h"

namespace tunewright {
namespace {

/// Shapes that differ in the dead time and the lag of input `k`, as shares of the record.
std::vector<ModelShape> scanned(const ModelShape& shape, int k) {
    constexpr double kDeadTimes[] = {0, 0.005, 0.01, 0.02, 0.04, 0.08, 0.15, 0.3};
    constexpr double kShortest = 0.001, kLongest = 3;
    constexpr int kLagCount = 12;
    std::vector<ModelShape> all;
    for (const double dead_time : kDeadTimes) {
        for (int i = 0; i < kLagCount; ++i) {
            ModelShape next = shape;
            next.p[further_dead_time(k)] = dead_time;
            next.p[further_lag(k)] =
                std::log(kShortest) + i * (std::log(kLongest) - std::log(kShortest)) / (kLagCount - 1);
            all.push_back(next);
        }
    }
    return all;
}

/// The plant of `fit` with all further inputs of the context's record: their lags and dead times are scanned one after
/// the other and then refined together.
Fit with_further(const FitContext& context, const Fit& fit) {
    ModelForm form = fit.form;
    ModelShape shape = fit.shape;
    const int count = static_cast<int>(context.record.d.size());
    for (int k = 0; k < count; ++k) {
        form.further = k + 1;
        const std::vector<ModelShape> starts = scanned(shape, k);
        const std::vector<double> sums = sums_of_squares(context.some(), form, starts, context.stop);
        shape = starts[static_cast<std::size_t>(std::ranges::min_element(sums) - sums.begin())];
    }
    return fit_shape(context.some(), form, shape, {}, context.stop);
}

/// The same on all samples.
Fit on_all(const FitContext& context, const Fit& fit) {
    return fit_shape(context.all(), fit.form, fit.shape, {}, context.stop);
}

CleanRecord without_parts(CleanRecord record, const Fit& fit) {
    for (int k = 0; k < fit.form.further; ++k) {
        const std::vector<double> part = further_part(record, fit, k);
        for (std::size_t i = 0; i < part.size(); ++i) record.y[i] -= part[i];
    }
    return record;
}

/// The plant of `fit` with the lags and dead times of the further inputs of `of`.
Fit joined(Fit fit, const Fit& of) {
    fit.form.further = of.form.further;
    for (int k = 0; k < of.form.further; ++k) {
        fit.shape.p[further_dead_time(k)] = of.shape.p[further_dead_time(k)];
        fit.shape.p[further_lag(k)] = of.shape.p[further_lag(k)];
    }
    return fit;
}

void leave_out(Fit& fit, int k) {
    for (int j = k; j + 1 < fit.form.further; ++j) {
        fit.shape.p[further_dead_time(j)] = fit.shape.p[further_dead_time(j + 1)];
        fit.shape.p[further_lag(j)] = fit.shape.p[further_lag(j + 1)];
    }
    --fit.form.further;
}

void leave_out(FitContext& context, int k) {
    for (CleanRecord* record : {&context.record, &context.medium, &context.thin})
        record->d.erase(record->d.begin() + k);
}

double sum_of_squares(const Fit& fit) { return fit.determined ? fit.sse : HUGE_VAL; }

/// A drift or a load that was fitted without the further inputs may be due to them.
Fit without_disturbances(Fit fit) {
    fit.form.slope = fit.form.load = false;
    return fit;
}

/// Starts from the plant alone, and from plants with any lag: if the further inputs move y more than u does, the plant
/// alone is not a good start.
Fit first_joint(const ModelSearch& plain) {
    constexpr double kLagShares[] = {0.01, 0.03, 0.1, 0.3};  // of the record
    std::vector<Fit> starts;
    if (plain.choice.index >= 0) starts.push_back(without_disturbances(plain.chosen()));
    for (const double lag : kLagShares) {
        for (const Structure structure : {Structure::fopdt, Structure::ipdt_lag}) {
            Fit start;
            start.form.structure = start.shape.structure = structure;
            start.shape.p[1] = std::log(lag);
            starts.push_back(start);
        }
    }
    std::vector<Fit> fits(starts.size());
    parallel_for(plain.context.spread, static_cast<int>(starts.size()), [&](int i) {
        const auto at = static_cast<std::size_t>(i);
        fits[at] = with_further(plain.context, starts[at]);
    });
    return *std::ranges::min_element(fits, {}, sum_of_squares);
}

/// All structures of `search` with the further inputs of `joint`, and the choice repeated, on the samples of `context`.
ModelSearch all_structures(const ModelSearch& search, const FitContext& context, const Fit& joint, ModelChoice model) {
    std::vector<Fit> fits(search.fits.size());
    parallel_for(context.spread, static_cast<int>(fits.size()), [&](int i) {
        const auto at = static_cast<std::size_t>(i);
        const Fit start = joined(search.fits[at], joint);
        fits[at] = start.determined ? fit_shape(context.some(), start.form, start.shape, {}, context.stop) : start;
    });
    return ranked_anew(search, context, std::move(fits), model);
}

/// The search without drift and load, if these explain no more than chance would in addition to the inputs; else
/// `search`.
ModelSearch with_needed_disturbances(ModelSearch search, const FitContext& context, ModelChoice model) {
    constexpr double kMinEvidence = 10;  // of the criterion (Kass and Raftery 1995)
    if (!(search.disturbances.slope || search.disturbances.load) || search.choice.index < 0) return search;
    ModelSearch bare = search;
    bare.disturbances = {};
    for (Fit& fit : bare.fits) fit = without_disturbances(std::move(fit));
    bare = all_structures(bare, context, with_further(context, without_disturbances(search.chosen())), model);
    if (bare.choice.index < 0) return search;
    const double n = search.independent;
    const double lead = information_criterion(bare.chosen(), n) - information_criterion(search.chosen(), n);
    return lead < kMinEvidence ? bare : search;
}

/// The input that matters least, if it is not significant.
std::optional<int> min_needed(const ModelSearch& search) {
    constexpr double kMinEvidence = 10,
                     kMinVarianceShare = 0.001;  // of the criterion (Kass and Raftery 1995); of y's variance
    const Fit& with = search.chosen();
    std::optional<int> min;
    double smallest = kMinEvidence;
    for (int k = 0; k < with.form.further; ++k) {
        FitContext context = search.context;
        Fit without = with;
        leave_out(without, k);
        leave_out(context, k);
        without = on_all(context, without);
        const double lead =
            information_criterion(without, search.independent) - information_criterion(with, search.independent);
        const double part = deviation(further_part(search.context.record, with, k));
        const double all = deviation(search.context.record.y);
        const double needed = part * part < kMinVarianceShare * all * all ? 0 : lead;
        if (without.determined && needed < smallest) smallest = needed, min = k;
    }
    return min;
}

}  // namespace

std::vector<double> further_part(const CleanRecord& record, const Fit& fit, int k) {
    const FurtherSteps& input = record.d[static_cast<std::size_t>(k)];
    UnitResponse response;
    unit_response(record.t, {input.time, input.level}, further_shape(fit.shape, k), 0, response);
    const double gain = fit.linear[static_cast<std::size_t>(fit.form.further_index() + k)];
    for (double& x : response.x) x *= gain;
    return response.x;
}

double further_share(const CleanRecord& record, const Fit& fit, int k) {
    std::vector<double> by_u = fit.model;
    double own = 0, sum = 0;
    for (int j = 0; j < fit.form.further; ++j) {
        const std::vector<double> part = further_part(record, fit, j);
        for (std::size_t i = 0; i < part.size(); ++i) by_u[i] -= part[i];
        const double size = deviation(part);
        sum += size * size;
        if (j == k) own = size * size;
    }
    const double size = deviation(by_u);
    sum += size * size;
    return sum > 0 ? own / sum : 0;
}

std::vector<double> further_parameters(const CleanRecord& record, const ModelForm& form, const ModelShape& shape,
                                       std::span<const double> linear) {
    std::vector<double> all;
    const RecordScale& s = record.scale;
    for (int k = 0; k < form.further; ++k) {
        const double K = linear[static_cast<std::size_t>(form.further_index() + k)] * s.y_scale /
                         record.d[static_cast<std::size_t>(k)].scale;
        all.push_back(is_integrating(form.structure) ? K / s.t_scale : K);
        all.push_back(further_shape(shape, k).T() * s.t_scale);
        all.push_back(further_shape(shape, k).L() * s.t_scale);
    }
    return all;
}

std::vector<DisturbanceModel> disturbances_of(const CleanRecord& record, const Fit& fit,
                                              const std::vector<double>& values, const std::vector<double>& variances) {
    static constexpr const char* kNames[] = {"K", "T", "L"};
    std::vector<DisturbanceModel> found;
    for (int k = 0; k < fit.form.further; ++k) {
        const auto at = static_cast<std::size_t>(3 * k);
        const double K = values[at], T = values[at + 1], L = values[at + 2];
        DisturbanceModel one{record.d[static_cast<std::size_t>(k)].name, Fopdt{K, T, L}, {}, 0};
        if (is_integrating(fit.form.structure)) one.plant = Ipdt{K, L, T};
        for (std::size_t i = 0; i < 3; ++i) one.standard_errors[kNames[i]] = std::sqrt(variances[at + i]);
        one.share = further_share(record, fit, k);
        found.push_back(std::move(one));
    }
    return found;
}

ModelSearch search_with_further(const CleanRecord& record, ModelChoice model, bool relay, const RunControl& control) {
    ModelSearch plain = search_models(record, model, relay, control);
    if (record.d.empty() || plain.part < 1 || control.stop.stop_requested()) return plain;
    Fit joint = first_joint(plain);
    ModelSearch search = plain;
    RunControl quiet = control;  // a search must not report progress that has been reported before
    quiet.progress = {};
    for (int round = 0; round < 2 && !control.stop.stop_requested(); ++round) {
        const Fit whole = on_all(plain.context, joint);
        ModelSearch next = search_models(without_parts(plain.context.record, whole), model, relay, quiet);
        if (next.choice.index < 0 || next.part < 1) break;
        const Fit again = with_further(plain.context, next.chosen());
        if (round > 0 && !(sum_of_squares(again) < sum_of_squares(joint))) break;
        joint = again;
        search = std::move(next);
    }
    if (search.choice.index < 0 || control.stop.stop_requested()) return plain;
    CleanRecord shown = search.context.record;
    shown.y = plain.context.record.y;
    FitContext context = fit_context(std::move(shown), relay, control);
    search = with_needed_disturbances(all_structures(search, context, joint, model), context, model);
    while (search.choice.index >= 0 && search.chosen().form.further > 0) {
        const std::optional<int> min = min_needed(search);
        if (!min) return search;
        Fit rest = search.chosen();
        leave_out(rest, *min);
        leave_out(context, *min);
        if (rest.form.further > 0) {
            search = all_structures(search, context, rest, model);
            continue;
        }
        break;
    }
    plain.context.record.d.clear();
    return plain;
}

void note_further_inputs(const Record& record, IdentifiedModel& model) {
    for (const FurtherInput& input : record.d) {
        if (std::ranges::find(model.disturbances, input.name, &DisturbanceModel::name) != model.disturbances.end())
            continue;
        model.data_quality.notes.push_back("The measured disturbance \"" + input.name +
                                           "\" explains no part of y beyond u and noise, so the model does not include "
                                           "it.");
    }
}

}  // namespace tunewright
