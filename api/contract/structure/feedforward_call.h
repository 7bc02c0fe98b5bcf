// Feedforward from a measured disturbance: POST /v1/feedforward.
#pragma once

#include "api/contract/structure/structure_parts.h"

namespace tunewright::api {

/// The controller of the loop: given, or designed on the plant.
struct FeedbackWish {
    std::optional<IdealPid> controller;
    std::optional<structure::LoopDesign> tune;
};

struct FeedforwardRequest : StructureRequest {
    std::optional<LinearPlant> plant, disturbance;
    std::optional<GivenRecord> record;  ///< in place of both, with the disturbance as d
    FeedbackWish feedback;
    struct {
        double jump = structure::kDefaultJump;
        structure::FeedforwardKind method = structure::FeedforwardKind::optimum;
    } feedforward;
    std::optional<structure::Feedforward> controller;
    double uncertainty = structure::kDefaultWrong;
};
const Description<FeedforwardRequest>& feedforward_request_contract();

struct FeedforwardAnswer : StructureAnswer {
    IdealPid feedback;
    structure::FeedforwardResult result;
    structure::FeedforwardKind chosen = structure::FeedforwardKind::optimum;
};
const Description<FeedforwardAnswer>& feedforward_answer_contract();

}  // namespace tunewright::api
