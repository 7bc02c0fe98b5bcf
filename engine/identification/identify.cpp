#include "engine/identification/identify.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "engine/identification/candidates.h"
#include "engine/identification/data_quality.h"
#include "engine/identification/diagnosis.h"
#include "engine/identification/uncertainty.h"
#include "engine/identification/wording.h"

namespace tunewright {
namespace {

constexpr int kThinSamples = 240;
constexpr int kTracePoints = 2000;

/// The structures to fit, simpler ones first, and those that answer the request: the others only give starting values.
struct Plan {
    std::vector<Structure> fitted, answers;
};

Plan plan_for(ModelChoice model, const CleanRecord& record) {
    using enum Structure;
    // An unstable plant is recorded under feedback, so u moves often; after one step any curve may look like its
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
    plan.answers = plan.fitted;
    return plan;
}

std::optional<Error> refuse_method(const IdentifyOptions& options) {
    if (options.method == IdentifyMethod::relay_fourier) {
        return Error{ErrorKind::unsupported, "identify/method",
                     "The relay formulas alone (relay_fourier) are not available; use output_error, which fits relay "
                     "records too."};
    }
    if (options.method == IdentifyMethod::two_point) {
        return Error{ErrorKind::unsupported, "identify/method",
                     "The two-point construction is not available; use output_error, which uses every sample."};
    }
    return std::nullopt;
}

/// A change of u in the last samples shows nothing of the response.
std::optional<Error> refuse_late_step(const CleanRecord& r) {
    const auto after = std::count_if(r.t.begin(), r.t.end(), [&](double t) { return t > r.v_time.front(); });
    if (after > 3) return std::nullopt;
    return Error{
        ErrorKind::not_identifiable, "record",
        "u first changes at t = " + number_text(r.scale.t_origin + r.scale.t_scale * r.v_time.front()) + ", with " +
            std::to_string(after) +
            " sample(s) after it: the response is not in the record. Record until y has settled after the step."};
}

Error no_response(const CleanRecord& r, double percent, const char* asked) {
    if (asked != nullptr) {
        return {ErrorKind::not_identifiable, "identify/model",
                std::string("No ") + asked + " model explains y beyond noise and drift (the best reaches a fit of " +
                    number_text(std::max(0.0, percent), 3) +
                    " %). Use model auto, or look whether y responds to u at all."};
    }
    return {ErrorKind::not_identifiable, "record",
            "y does not respond to u beyond what its own noise and drift explain (the best model reaches a fit of " +
                number_text(std::max(0.0, percent), 3) +
                " %). u first changes at t = " + number_text(r.scale.t_origin + r.scale.t_scale * r.v_time.front()) +
                " and the record ends at t = " + number_text(r.scale.t_origin + r.scale.t_scale * r.t.back()) +
                ". Make a larger step, record until y has settled, and check that u and y belong to the same loop."};
}

Error cancelled() { return {ErrorKind::cancelled, "", "The identification was cancelled."}; }

void report(const RunControl& control, double fraction, std::string message) {
    if (control.progress) control.progress({fraction, "identify", std::move(message), std::nullopt});
}

FitTrace trace_of(const CleanRecord& r, const Fit& fit) {
    FitTrace trace;
    const int n = r.samples(), points = std::min(n, kTracePoints);
    int change = 0;
    double v = 0;
    for (int k = 0; k < points; ++k) {
        const int i = points == 1 ? 0 : static_cast<int>(static_cast<long long>(k) * (n - 1) / (points - 1));
        trace.t.push_back(r.scale.t_origin + r.scale.t_scale * r.t[i]);
        for (; change < r.changes() && r.v_time[change] <= r.t[i]; ++change) v = r.v_level[change];
        trace.u.push_back(r.scale.u_rest + r.scale.u_scale * v);
        trace.y.push_back(r.scale.y_origin + r.scale.y_scale * r.y[i]);
        trace.y_model.push_back(r.scale.y_origin + r.scale.y_scale * fit.model[i]);
    }
    return trace;
}

/// The best-fitting candidate's residual is the nearest to noise: it says how many independent samples there are.
double independent_samples(const std::vector<Fit>& fits) {
    const Fit* best = nullptr;
    for (const Fit& fit : fits) {
        if (fit.determined && (best == nullptr || fit.sse < best->sse)) best = &fit;
    }
    return best == nullptr ? 4 : effective_samples(best->residual);
}

/// Candidates sorted by criterion, and the chosen one's result.
IdentifiedModel assemble(const CleanRecord& record, std::vector<Fit> fits, const std::vector<double>& criteria,
                         const std::vector<double>& percents, const Choice& choice) {
    IdentifiedModel model;
    model.data_quality = describe_record(record);
    const double grid = model.data_quality.quantisation / record.scale.y_scale;
    std::vector<int> order(fits.size());
    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return criteria[a] < criteria[b]; });
    for (int i : order) {
        if (!fits[i].determined) continue;
        jacobian(record, fits[i]);
        FittedPlant fitted = fitted_plant(record, fits[i], grid);
        model.candidates.push_back(
            {fitted.plant, percents[i], criteria[i], fitted.standard_errors, trace_of(record, fits[i]).y_model});
        if (i != choice.index) continue;
        Diagnosis diagnosis = diagnose(record, fits[i], fitted.values, fitted.standard_errors, model.data_quality);
        model.plant = fitted.plant;
        model.fit_percent = percents[i];
        model.standard_errors = std::move(fitted.standard_errors);
        model.choice_reason = choice.reason;
        model.fit = trace_of(record, fits[i]);
        model.data_quality.settled = diagnosis.settled;
        model.warnings = std::move(diagnosis.warnings);
        for (Warning& warning : record_warnings(record, model.data_quality))
            model.warnings.push_back(std::move(warning));
        if (fits[i].form.start != Start::at_rest) {
            const double level = level_of_rest(fits[i]) * record.scale.u_scale + record.scale.u_rest;
            model.data_quality.notes.push_back("The record does not start at rest: y rests at u = " +
                                               number_text(level) + ", as estimated from the record (the first u is " +
                                               number_text(record.scale.u_rest) + "). Give u0 if it is known.");
        }
    }
    return model;
}

/// No sensor is taken to resolve less than a thousandth of what y did.
Excitation excitation_of(const IdentifiedModel& model, double u_rest) {
    const auto [low, high] = std::minmax_element(model.fit.y.begin(), model.fit.y.end());
    const double rounding = model.data_quality.quantisation / std::sqrt(12.0);
    const double noise = std::max({model.data_quality.noise_std, rounding, 1e-3 * (*high - *low)});
    return {model.fit.t, model.fit.u, u_rest, model.data_quality.sample_time, noise};
}

}  // namespace

Expected<IdentifiedModel> identify(const Record& record, const IdentifyOptions& options, const RunControl& control) {
    if (auto error = refuse_method(options)) return *error;
    const Expected<CleanRecord> clean = clean_record(record);
    if (!clean) return clean.error();
    if (auto error = refuse_late_step(*clean)) return *error;
    const CleanRecord thin = thin_out(*clean, kThinSamples);

    const bool automatic = options.model == ModelChoice::automatic;
    const Plan plan = plan_for(options.model, *clean);
    const std::vector<Structure>& structures = plan.fitted;
    std::vector<Fit> fits;
    for (std::size_t i = 0; i < structures.size(); ++i) {
        if (control.stop.stop_requested()) return cancelled();
        report(control, static_cast<double>(i) / static_cast<double>(structures.size()),
               std::string("fitting ") + name_of(structures[i]));
        fits.push_back(fit_structure(*clean, thin, structures[i], fits, control.stop));
    }
    if (control.stop.stop_requested()) return cancelled();
    std::erase_if(fits, [&](const Fit& fit) {
        return std::find(plan.answers.begin(), plan.answers.end(), fit.form.structure) == plan.answers.end();
    });

    const double independent = independent_samples(fits);
    std::vector<double> criteria, percents;
    for (const Fit& fit : fits) {
        criteria.push_back(information_criterion(*clean, fit, independent));
        percents.push_back(fit_percent(*clean, fit));
    }
    Choice choice = choose(fits, criteria, percents, independent);
    if (choice.index < 0 || !responds(*clean, fits[choice.index])) {
        return no_response(*clean, *std::max_element(percents.begin(), percents.end()),
                           automatic ? nullptr : name_of(plan.answers.front()));
    }
    if (plan.answers.size() == 1 || (!automatic && fits[choice.index].form.structure == plan.answers.front())) {
        choice.reason = std::string(name_of(plan.answers.front())) + " was asked for.";
    }
    IdentifiedModel model = assemble(*clean, std::move(fits), criteria, percents, choice);
    model.excited_band = excited_band(excitation_of(model, clean->scale.u_rest), model.plant);
    report(control, 1, "model found");
    return model;
}

}  // namespace tunewright
