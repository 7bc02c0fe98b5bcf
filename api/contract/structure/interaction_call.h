// Loops that interact: POST /v1/interaction.
#pragma once

#include "api/contract/structure/decoupling_part.h"
#include "api/contract/structure/structure_parts.h"

namespace tunewright::api {

/// Either a design, or given controllers to judge, one for each output.
struct InteractionControllers {
    ControllerKind kind = ControllerKind::PI;
    std::vector<std::optional<IdealPid>> given;
};

struct InteractionRequest : StructureRequest {
    structure::PlantMatrix plant;
    std::optional<std::vector<GivenRecord>> given_records;  ///< in place of the plant: one of each output
    std::optional<std::vector<int>> pairing;                ///< of each output the input, from 1
    InteractionControllers controllers;
    struct {
        double mu = structure::kDefaultMu;
    } limit;
    struct {
        std::vector<double> y;
    } weights;
    std::optional<InteractionControllers> baseline;
    std::vector<std::string> compare;
    structure::DecouplerKind decoupler = structure::DecouplerKind::none;

    double weight(std::size_t output) const { return weights.y.empty() ? 1 : weights.y[output]; }
};
const Description<InteractionRequest>& interaction_request_contract();

/// Controllers for comparison, with their figures.
struct ComparedControllers {
    std::string name;
    std::vector<IdealPid> controllers;
    structure::InteractionFigures figures;
    Figure cost;      ///< weighted sum of the IAE after loads
    std::string why;  ///< there are none, for this reason
    std::optional<DecouplingView> decoupling = {};
};

struct InteractionAnswer : StructureAnswer {
    structure::GainAnalysis gains;
    std::size_t chosen = 0;  ///< of gains.pairings
    std::vector<IdealPid> controllers;
    structure::InteractionFigures figures;
    Figure cost;
    Figure F;  ///< of the BLT settings
    std::optional<DecouplingView> decoupling;
    std::vector<ComparedControllers> compared;
};
const Description<InteractionAnswer>& interaction_answer_contract();

}  // namespace tunewright::api
