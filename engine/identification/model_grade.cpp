#include "engine/identification/model_grade.h"

#include <algorithm>

namespace tunewright {

namespace {

bool misses_more_than_noise(const IdentifiedModel& model) {
    return std::ranges::any_of(model.warnings, [](const Warning& w) { return w.code == "structured-residuals"; });
}

bool explains_its_record(const IdentifiedModel& model) {
    return model.fit_percent >= (misses_more_than_noise(model) ? kMinFitPercentBiased : kMinFitPercent);
}

}  // namespace

std::optional<DoubtReason> reason_of_doubt(const IdentifiedModel& model) {
    if (!explains_its_record(model)) return DoubtReason::fit;
    const bool bad = std::ranges::any_of(model.warnings, [](const Warning& w) { return w.level == WarningLevel::bad; });
    return bad ? std::optional(DoubtReason::warning) : std::nullopt;
}

ModelGrade grade_of(const IdentifiedModel& model) {
    if (reason_of_doubt(model)) return ModelGrade::doubtful;
    return model.warnings.empty() ? ModelGrade::good : ModelGrade::usable;
}

void grade_candidates(IdentifiedModel& model) {
    if (model.candidates.empty()) return;
    const double best = std::ranges::max_element(model.candidates, {}, &Candidate::fit_percent)->fit_percent;
    const double length = model.fit.t.empty() ? 0 : model.fit.t.back() - model.fit.t.front();
    for (Candidate& candidate : model.candidates) {
        candidate.much_worse = candidate.fit_percent < best - kMuchWorsePercent;
        candidate.undetermined.clear();
        for (const char* time : {"L", "T", "T1", "T2"})
            if (const auto error = candidate.standard_errors.find(time);
                error != candidate.standard_errors.end() && error->second > length)
                candidate.undetermined.emplace_back(time);
    }
}

const char* name_of(ModelGrade grade) {
    switch (grade) {
        case ModelGrade::good: return "good";
        case ModelGrade::usable: return "usable";
        case ModelGrade::doubtful: return "doubtful";
    }
    return "doubtful";
}

const char* name_of(DoubtReason reason) { return reason == DoubtReason::fit ? "fit" : "warning"; }

}  // namespace tunewright
