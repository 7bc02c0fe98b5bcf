#include "engine/plant/analysed_plant.h"

#include <string>

#include "engine/plant/linear/factor.h"
#include "engine/plant/nonlinear/linearisation.h"

namespace tunewright {
namespace {

/// Moves an error's place from "plant/..." of one plant to below `place`.
Error moved(Error error, const std::string& place) {
    error.where = place + error.where.substr(std::string("plant").size());
    return error;
}

/// The plants of the model with their places in the request; none for points and equations.
std::vector<std::pair<std::string, Plant>> linear_plants(const PlantModel& plant) {
    std::vector<std::pair<std::string, Plant>> plants;
    if (const auto* single = std::get_if<Plant>(&plant)) plants.emplace_back("plant", *single);
    if (const auto* set = std::get_if<PlantSet>(&plant))
        for (const Plant& member : set->plants)
            plants.emplace_back("plant/plants/" + std::to_string(plants.size()), member);
    return plants;
}

/// The errors of all plants; for those after the first one, also the errors of factoring.
std::vector<Error> faults_of(const std::vector<std::pair<std::string, Plant>>& plants) {
    std::vector<Error> faults;
    for (const auto& [place, plant] : plants)
        for (const Error& fault : plant_faults(plant)) faults.push_back(moved(fault, place));
    if (!faults.empty()) return faults;
    for (std::size_t i = 1; i < plants.size(); ++i)
        if (const auto linear = LinearPlant::make(plants[i].second); !linear)
            faults.push_back(moved(linear.error(), plants[i].first));
    return faults;
}

}  // namespace

std::variant<AnalysedPlant, std::vector<Error>> AnalysedPlant::make(const PlantModel& plant) {
    const auto failed = [](const Error& error) { return std::vector<Error>{error}; };
    if (const auto* points = std::get_if<FrequencyResponse>(&plant)) {
        auto measured = MeasuredPlant::make(*points);
        if (!measured) return failed(measured.error());
        return AnalysedPlant(std::move(*measured));
    }
    if (const auto* equations = std::get_if<NonlinearPlant>(&plant)) {
        auto system = NonlinearSystem::make(*equations);
        if (!system) return failed(system.error());
        auto linear = linearised_plant(*system);
        if (!linear) return failed(linear.error());
        return AnalysedPlant(AnalysedNonlinear{std::move(*system), std::move(*linear)});
    }
    const auto plants = linear_plants(plant);
    if (auto faults = faults_of(plants); !faults.empty()) return faults;
    const auto* set = std::get_if<PlantSet>(&plant);
    auto subject = of_family(set ? tunewright::family_of(*set) : tunewright::family_of(std::get<Plant>(plant)));
    if (!subject) return failed(moved(subject.error(), plants.front().first));
    return std::move(*subject);
}

Expected<AnalysedPlant> AnalysedPlant::of_family(PlantFamily family) {
    auto nominal = LinearPlant::make(family.nominal());
    if (!nominal) return nominal.error();
    return AnalysedPlant(AnalysedLinear{std::move(family), std::move(*nominal)});
}

const NonlinearSystem* AnalysedPlant::equations() const {
    const auto* nonlinear = std::get_if<AnalysedNonlinear>(&content_);
    return nonlinear ? &nonlinear->system : nullptr;
}

const LinearPlant* AnalysedPlant::linear() const {
    return visit(OfKinds{[](const AnalysedLinear& linear) { return &linear.nominal; },
                         [](const MeasuredPlant&) -> const LinearPlant* { return nullptr; },
                         [](const AnalysedNonlinear& nonlinear) { return &nonlinear.linear; }});
}

std::optional<Plant> AnalysedPlant::nominal() const {
    using Nominal = std::optional<Plant>;
    return visit(
        OfKinds{[](const AnalysedLinear& linear) { return Nominal(linear.family.nominal()); },
                [](const MeasuredPlant&) { return Nominal(); },
                [](const AnalysedNonlinear& nonlinear) { return Nominal(Plant(nonlinear.system.linearised())); }});
}

const PlantFamily* AnalysedPlant::family() const {
    const auto* linear = std::get_if<AnalysedLinear>(&content_);
    return linear && !linear->family.single() ? &linear->family : nullptr;
}

}  // namespace tunewright
