#include "engine/request/identified_region.h"

#include <algorithm>

#include "engine/number_text.h"
#include "engine/tuning/limits.h"

namespace tunewright {
namespace {

bool exceeds(double worst_Ms, double limit) { return worst_Ms > (1 + limits::kMaxRelativeExcessShownOfWorst) * limit; }

}  // namespace

bool breaks_limit(const std::optional<RegionFigures>& region, std::optional<double> Ms_limit) {
    if (!region) return false;
    return !region->worst_Ms || (Ms_limit && exceeds(*region->worst_Ms, *Ms_limit));
}

void warn_of_region(Evaluation& evaluation, const std::optional<RegionFigures>& region, std::optional<double> Ms_limit,
                    bool identified) {
    constexpr double kMinBadRatio = 2;  // multiple of the limit
    if (identified)
        for (Warning& warning : evaluation.warnings)
            if (warning.code == "unstable-in-region") warning.level = WarningLevel::bad;
    if (!region || !region->worst_Ms || !Ms_limit) return;
    const double worst = *region->worst_Ms;
    if (!exceeds(worst, *Ms_limit)) return;
    evaluation.warnings.push_back(
        {"above-limit-in-region",
         "On the worst plant of the region Ms is " + text(worst) + ", above the " + text(*Ms_limit) + " asked for.",
         identified && worst > kMinBadRatio * *Ms_limit ? WarningLevel::bad : WarningLevel::warning});
}

void say_choice(Evaluation& held, const RegionFigures& alone) {
    const std::string there =
        alone.worst_Ms ? "Ms may reach " + text(*alone.worst_Ms) : std::string("the loop may be unstable");
    held.warnings.insert(held.warnings.begin(),
                         {"held-on-region",
                          "The limits hold for every plant in the record's confidence region (95 %). On these plants "
                          "the design for the model alone does not keep them: " +
                              there + "."});
}

void warn_of_band(Evaluation& evaluation, const std::optional<ExcitedBand>& band) {
    const auto& crossover = evaluation.robustness.phase_crossover;
    if (!band || !crossover || *crossover <= band->omega_high) return;
    evaluation.warnings.push_back(
        {"beyond-excited-band",
         "The loop's phase crossover, omega " + text(*crossover) +
             ", lies beyond the band that the record excited (up to omega " + text(band->omega_high) +
             "): the model is not reliable there. Lower the limit on Ms, or repeat the test with faster or larger "
             "changes of u."});
}

namespace {

PlantFamily with_alternatives(PlantRegion region, const IdentifiedModel& model) {
    PlantFamily family{{std::move(region)}};
    for (const Plant& other : model.alternatives) family.regions.push_back(PlantRegion::of_ranges(other));
    return family;
}

}  // namespace

Expected<PlantFamily> identified_region(const IdentifiedModel& model) {
    auto region = PlantRegion::of_covariance(model.plant, model.covariance.names, model.covariance.matrix);
    if (!region) return region.error();
    if (!model.covariance.reach.empty()) region->cut(model.covariance.reach);
    return with_alternatives(std::move(*region), model);
}

Expected<AnalysedPlant> subject_of(const IdentifiedModel& model) {
    auto region = identified_region(model);
    return AnalysedPlant::of_family(region ? std::move(*region)
                                           : with_alternatives(PlantRegion::of_ranges(model.plant), model));
}

}  // namespace tunewright
