#include "tests/records/judgement.h"

#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <cmath>
#include <set>

#include "engine/evaluation/evaluate.h"
#include "engine/plant/linear/linear_plant.h"
#include "engine/plant/plant_family.h"
#include "tests/engine/plant/subject_of.h"

namespace tunewright::records {
namespace {

bool integrates(const Plant& plant) {
    const auto linear = LinearPlant::make(plant);
    return linear && linear->integrators() > 0;
}

/// True if a sentence warns of the gain, or of the model as a whole.
bool names_gain(const Warning& warning) {
    static const std::set<std::string> kWhole = {
        "unsettled-record",         "slow-or-integrating", "slow-part",   "looks-integrating", "structured-residuals",
        "structure-mismatch",       "closed-loop",         "not-at-rest", "saturated-output",  "unstable-in-region",
        "static-gain-contradiction"};
    if (kWhole.contains(warning.code)) return true;
    return warning.detail.find("K = ") != std::string::npos || warning.detail.find("gain") != std::string::npos;
}

/// The relative standard deviation of G(j omega) according to the covariance: half axes of the 95 % region, divided by
/// the quantile of chi-square.
double stated_std(const IdentifiedModel& model, double omega) {
    const auto region = PlantRegion::of_covariance(model.plant, model.covariance.names, model.covariance.matrix);
    const auto centre = LinearPlant::make(model.plant);
    if (!region || !centre || region->dimension() == 0) return 0;
    const std::complex<double> G = centre->at({0, omega});
    double squares = 0;
    for (int k = 0; k < region->dimension(); ++k) {
        PlantRegion::Point z(static_cast<std::size_t>(region->dimension()), 0.0);
        z[static_cast<std::size_t>(k)] = 0.5;
        const auto moved = LinearPlant::make(region->at(z));
        if (moved) squares += 4 * std::norm(moved->at({0, omega}) - G);
    }
    const double quantile = boost::math::quantile(boost::math::chi_squared(region->dimension()), 0.95);
    return std::sqrt(squares / quantile) / std::abs(G);
}

void judge_gain(const MadeRecord& made, const IdentifiedModel& model, Judgement& j) {
    const auto found = LinearPlant::make(model.plant);
    if (!found) return;
    j.K = found->low_frequency_gain();
    j.K_true = made.plant.K;
    j.comparable = integrates(model.plant) == made.plant.integrating;
    if (const auto at = model.standard_errors.find("K"); at != model.standard_errors.end()) j.K_std = at->second;
}

/// The stated error of K if the record shows the time of each move; with the same structure, so that only the moves
/// differ.
void judge_told(const MadeRecord& made, const IdentifiedModel& model, Judgement& j) {
    Record record = *made.with_moves;
    // Rows with only u hide the kind of test from the product, and the uncertainties that depend on the kind.
    if (made.test == Test::relay_between) record.kind = RecordKind::relay;
    const auto told = identify(record, {}, {});
    if (!told || integrates(told->plant) != integrates(model.plant)) return;
    if (const auto at = told->standard_errors.find("K"); at != told->standard_errors.end()) j.K_std_told = at->second;
}

/// The load IAE of the default design for the true plant.
std::optional<double> min_load_IAE(const TruePlant& plant) {
    TuningRequest request;
    request.subject = test::subject_of(PlantModel(Plant(plant.zpk())));
    request.evaluate.points = 0;
    const auto result = tune(request, {});
    if (!result || result->controllers.empty() || !result->controllers.front().evaluation) return std::nullopt;
    return result->controllers.front().evaluation->performance.load.IAE;
}

void judge_design(const MadeRecord& made, const TuningResult& result, Judgement& j) {
    if (result.controllers.empty() || !result.controllers.front().evaluation) return;
    const TuningEntry& first = result.controllers.front();
    j.designed = true;
    for (const Warning& warning : first.evaluation->warnings) {
        j.codes.push_back(warning.code);
        j.detail += "\n      [" + warning.code + "] " + warning.detail;
        j.warned_badly |= warning.level == WarningLevel::bad;
    }
    EvaluateOptions options;
    options.points = 0;
    const auto evaluation = evaluate(PlantModel(Plant(made.plant.zpk())), first.evaluation->controller, options);
    if (evaluation && evaluation->robustness.stable) {
        j.Ms_true = evaluation->robustness.Ms;
        const auto best = min_load_IAE(made.plant);
        if (best && evaluation->performance.load.IAE) j.IAE_ratio = *evaluation->performance.load.IAE / *best;
    }
    const double omega =
        first.evaluation->robustness.gain_crossover.value_or(1 / (made.plant.L + made.plant.lag_sum()));
    const auto found = LinearPlant::make(result.model->plant);
    if (!found) return;
    j.response_error = std::abs(found->at({0, omega}) / made.plant.response(omega) - 1.0);
    j.response_std = stated_std(*result.model, omega);
}

}  // namespace

double Judgement::K_error() const { return comparable ? std::abs(K / K_true - 1) : 1; }

bool Judgement::wrong_in_silence() const {
    return !refused && K_error() > 0.1 && (!comparable || std::abs(K - K_true) > 3 * K_std) && !gain_warned;
}

std::optional<double> Judgement::width() const {
    if (refused || !comparable || !(K_std_told > 0)) return std::nullopt;
    return K_std / K_std_told;
}

bool Judgement::covered() const { return comparable && std::abs(K - K_true) <= 1.96 * K_std; }

Judgement judge(const MadeRecord& made) {
    TuningRequest request;
    request.record = made.record;
    request.evaluate.points = 0;
    const auto result = tune(request, {});
    Judgement j;
    if (!result) {
        j.refused = true;
        j.refusal = result.error().message;
        return j;
    }
    j.detail = result->model->choice_reason;
    for (const Warning& warning : result->model->warnings) {
        j.codes.push_back(warning.code);
        j.gain_warned |= names_gain(warning);
        j.warned_badly |= warning.level == WarningLevel::bad;
        j.detail += "\n      " + warning.code + ": " + warning.detail;
    }
    for (const std::string& note : result->model->data_quality.notes) {
        if (note.find("does not start at rest") != std::string::npos) j.detail += "\n      note: " + note;
    }
    judge_gain(made, *result->model, j);
    if (made.with_moves) judge_told(made, *result->model, j);
    judge_design(made, *result, j);
    return j;
}

}  // namespace tunewright::records
