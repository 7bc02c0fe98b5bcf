// The plant of a request with what the methods need of it. Made once for each request; reports every error of the
// plant.
#pragma once

#include <optional>
#include <utility>
#include <variant>
#include <vector>

#include "engine/plant/frequency_response.h"
#include "engine/plant/linear/linear_plant.h"
#include "engine/plant/nonlinear/nonlinear_system.h"
#include "engine/plant/plant.h"
#include "engine/plant/plant_family.h"

namespace tunewright {

/// One linear plant or several; figures are those of the nominal plant.
struct AnalysedLinear {
    PlantFamily family;
    LinearPlant nominal;  ///< of `family`
};

/// Equations, with their linearisation about the steady state.
struct AnalysedNonlinear {
    NonlinearSystem system;
    LinearPlant linear;
};

class AnalysedPlant {
public:
    /// All errors at once, `where` = "plant/...": plant_faults, MeasuredPlant::make, NonlinearSystem::make,
    /// linearised_plant, and unsupported for modes that input or output cannot reach.
    static std::variant<AnalysedPlant, std::vector<Error>> make(const PlantModel& plant);

    /// An identified plant with the uncertainty that its record leaves. Errors: as LinearPlant::make of the nominal
    /// plant.
    static Expected<AnalysedPlant> of_family(PlantFamily family);

    /// The only place that distinguishes the kinds: calls a function for each of AnalysedLinear, MeasuredPlant,
    /// AnalysedNonlinear.
    template <class Visitor>
    decltype(auto) visit(Visitor&& visitor) const {
        return std::visit(std::forward<Visitor>(visitor), content_);
    }

    const MeasuredPlant* measured() const { return std::get_if<MeasuredPlant>(&content_); }
    /// Null if the plant is not given by equations.
    const NonlinearSystem* equations() const;
    /// The plant, the nominal one of several, or the linearisation; null and empty for measured points.
    const LinearPlant* linear() const;
    std::optional<Plant> nominal() const;
    /// All plants that one controller must serve, if there are several; else null.
    const PlantFamily* family() const;

private:
    using Content = std::variant<AnalysedLinear, MeasuredPlant, AnalysedNonlinear>;
    explicit AnalysedPlant(Content content) : content_(std::move(content)) {}

    Content content_;
};

/// Combines lambdas into the visitor that AnalysedPlant::visit takes.
template <class... Functions>
struct OfKinds : Functions... {
    using Functions::operator()...;
};
template <class... Functions>
OfKinds(Functions...) -> OfKinds<Functions...>;

}  // namespace tunewright
