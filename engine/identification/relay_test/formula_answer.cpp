#include "engine/identification/relay_test/formula_answer.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "engine/identification/record/series.h"
#include "engine/identification/search/model_answer.h"
#include "engine/number_text.h"

namespace tunewright {
namespace {

/// Every model that the formulas give and `asked` allows, the one that reproduces y best first.
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
    // The request has the paper's first-order lag, unless the integrator reproduces the oscillation twice as well, or
    // both reproduce it within kMaxRepeatError: an infinite lag is an integrator.
    constexpr double kMaxRepeatError = 0.01;  // of half a swing: about the error by sampling and noise
    constexpr double kFitRatioOfExact = 0.95,
                     kTieBreak = 1e-5;  // so that of equal misfits the integrator's is smaller
    constexpr double kMinFitRatio = 2;
    auto cost = [&](const RelayModel& model) {
        const bool integrator = any && model.shape.structure == Structure::ipdt;
        if (!integrator) return model.fit_rms;
        return model.fit_rms < kMaxRepeatError * cycle.y_half ? kFitRatioOfExact * model.fit_rms - kTieBreak
                                                              : kMinFitRatio * model.fit_rms;
    };
    std::stable_sort(models.begin(), models.end(), [&](const auto& a, const auto& b) { return cost(a) < cost(b); });
    return models;
}

void warn_formula(const CleanRecord& r, const RecordedCycle& cycle, const RelayModel& chosen, double noise,
                  std::vector<Warning>& warnings) {
    if (cycle.rest.assumed) {
        warnings.push_back({"rest-assumed",
                            "The relay already works at the start of the record: u is assumed to be at "
                            "rest at " +
                                text(r.scale.u_rest + r.scale.u_scale * cycle.rest.v) + " and y at its first values, " +
                                text(r.scale.y_origin + r.scale.y_scale * cycle.rest.y) +
                                ". Give u0 and y0 if they are known."});
    }
    if (cycle.biased() && !chosen.by_static_gain && !is_integrating(chosen.shape.structure)) {
        warnings.push_back({"static-gain-contradiction",
                            "The mean of y over the mean of u is " +
                                text(cycle.static_gain() * r.scale.y_scale / r.scale.u_scale) +
                                ", which contradicts the phase at the oscillation: the record contains a load, a drift "
                                "or a wrong level of rest. Eq. 13 was used instead of Eq. 14; method output_error fits "
                                "such disturbances."});
    }
    // Differences between periods affect the harmonics of their mean.
    const double scatter = noise / std::sqrt(static_cast<double>(std::max(1, r.samples()))) +
                           2 * cycle.period_scatter / cycle.period * cycle.y_half;
    constexpr double kMinMisfitShare = 0.03, kScatterErrors = 4;  // of half a swing, and multiple of the scatter
    if (chosen.fit_rms > kMinMisfitShare * cycle.y_half + kScatterErrors * scatter) {
        warnings.push_back(
            {"structure-mismatch", "The model reproduces the steady oscillation only within " +
                                       text(chosen.fit_rms * r.scale.y_scale, 3) + " (r.m.s.; the amplitude of y is " +
                                       text(cycle.y_half * r.scale.y_scale, 3) +
                                       "), so the plant does not have this structure. Use only the measured frequency "
                                       "point; " +
                                       (chosen.by_static_gain ? "the gain is the ratio of the means of y and u."
                                                              : "the gain is not the plant's static gain.")});
    }
    if (std::abs(cycle.drift) > 0) {
        warnings.push_back(
            {"drift", "The mean of y drifts from period to period by " +
                          text(cycle.drift * cycle.period * r.scale.y_scale, 3) +
                          ": the record contains a load or a drift, which affects Eqs. 9 and 14. Method output_error "
                          "fits it."});
    }
}

Error no_relay_model(const CleanRecord& r, const RecordedCycle& cycle, ModelChoice asked) {
    std::string why = "No ";
    why += asked == ModelChoice::ipdt || asked == ModelChoice::ipdt_lag ? "integrating" : "first-order";
    why += " model with a dead time fits the oscillation (A_u = " +
           text(std::abs(cycle.harmonics.front().G) * r.scale.y_scale / r.scale.u_scale) +
           ", phi_u = " + text(std::arg(cycle.harmonics.front().G)) + ")";
    if (cycle.biased()) {
        why += "; the mean of y over the mean of u is " +
               text(cycle.static_gain() * r.scale.y_scale / r.scale.u_scale) +
               ", which a load or a wrong level of rest would explain";
    }
    return {ErrorKind::not_identifiable, "identify/method", why + ". Use method output_error."};
}

}  // namespace

Expected<double> shift_of(const IdentifyOptions& options, const CleanRecord& record, const RecordedCycle& cycle) {
    if (!options.shift) return 1 / cycle.period;
    if (!(*options.shift > 0) || !std::isfinite(*options.shift))
        return Error{ErrorKind::invalid_argument, "identify/shift", "shift must be a number above 0."};
    return *options.shift * record.scale.t_scale;
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
                          ": it reproduces the steady oscillation best.";
    add_cycle(record, *cycle, {*sigma / record.scale.t_scale, shifted}, model);
    model.limit_cycle->fit_rms = chosen.fit_rms * record.scale.y_scale;
    warn_formula(record, *cycle, chosen, noise, model.warnings);
    return model;
}

}  // namespace tunewright
