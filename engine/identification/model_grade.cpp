#include "engine/identification/model_grade.h"

#include <algorithm>

namespace tunewright {

namespace {

bool misses_more_than_noise(const IdentifiedModel& model) {
    return std::ranges::any_of(model.warnings, [](const Warning& w) { return w.code == "structured-residuals"; });
}

}  // namespace

bool explains_its_record(const IdentifiedModel& model) {
    return model.fit_percent >= (misses_more_than_noise(model) ? kMinFitPercentBiased : kMinFitPercent);
}

ModelGrade grade_of(const IdentifiedModel& model) {
    const bool bad = std::ranges::any_of(model.warnings, [](const Warning& w) { return w.level == WarningLevel::bad; });
    if (bad || !explains_its_record(model)) return ModelGrade::doubtful;
    return model.warnings.empty() ? ModelGrade::good : ModelGrade::usable;
}

const char* name_of(ModelGrade grade) {
    switch (grade) {
        case ModelGrade::good: return "good";
        case ModelGrade::usable: return "usable";
        case ModelGrade::doubtful: return "doubtful";
    }
    return "doubtful";
}

}  // namespace tunewright
