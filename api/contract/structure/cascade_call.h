// Cascades: POST /v1/cascade.
#pragma once

#include "api/contract/structure/structure_parts.h"

namespace tunewright::api {

/// One loop of a cascade: its plant, and a design or a controller.
struct CascadeLoop {
    std::optional<LinearPlant> plant;
    std::optional<GivenRecord> record;  ///< in place of the plant
    structure::LoopDesign tune;
    std::optional<IdealPid> controller;
};

/// Two controllers that are judged.
struct CascadePair {
    std::optional<IdealPid> inner, outer;
};

struct CascadeRequest : StructureRequest {
    CascadeLoop inner, outer;
    std::optional<GivenRecord> record;  ///< of both: u, the inner measurement as d, the outer one as y
    structure::Arrangement arrangement = structure::Arrangement::series;
    struct {
        std::optional<double> Ms_valve;
    } limits;
    bool joint = false;
    struct {
        double d1 = 1, d2 = 1;
    } weights;
    std::optional<CascadePair> baseline;
    bool compare_single = true;

    structure::CascadeDesign design() const;
    structure::CascadePlants plants() const { return {*inner.plant, *outer.plant, arrangement}; }
};
const Description<CascadeRequest>& cascade_request_contract();

struct CascadeAnswer : StructureAnswer {
    structure::CascadeResult result;
    double limit_valve = 0;
    std::optional<structure::CascadeFigures> baseline;
    OrReason<structure::SingleLoop> single;
};
const Description<CascadeAnswer>& cascade_answer_contract();

}  // namespace tunewright::api
