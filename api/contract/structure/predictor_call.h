// Dead-time compensation: POST /v1/predictor.
#pragma once

#include "api/contract/structure/structure_parts.h"

namespace tunewright::api {

struct PredictorRequest : StructureRequest {
    std::optional<LinearPlant> plant, model;
    structure::PredictorDesign design;
    std::optional<structure::PredictorController> controller;  ///< its model is that of the request

    structure::PredictorModel of_model = {};  ///< `model`, or the plant
};
const Description<PredictorRequest>& predictor_request_contract();

struct PredictorAnswer : StructureAnswer {
    structure::PredictorController controller;
    structure::PredictorFigures figures;
    OrReason<IdealPid> pid;
    Figure pid_IAE;
};
const Description<PredictorAnswer>& predictor_answer_contract();

}  // namespace tunewright::api
