// Given controllers, each evaluated on the same plant.
#pragma once

#include <optional>
#include <vector>

#include "engine/evaluation/evaluation.h"
#include "engine/evaluation/own_step.h"
#include "engine/expected.h"
#include "engine/identification/identify.h"
#include "engine/plant/analysed_plant.h"
#include "engine/plant/nonlinear/linearisation.h"
#include "engine/progress.h"
#include "engine/request/entry.h"
#include "engine/request/given_controller.h"

namespace tunewright {

struct EvaluationResult {
    std::optional<OperatingPoint> operating_point;  ///< only for a nonlinear plant
    std::vector<TuningEntry> controllers;           ///< without a method, in the order of the request
    std::optional<double> rank_Ms;                  ///< the common limit on Ms for the standing of all; empty without
                                                    ///< controllers
    std::vector<verdict::Finding> verdict;          ///< over all of them
    std::optional<int> proposed;                    ///< the one to show first; none without controllers
};

/// Each controller is evaluated alone, in the order of the request; a stop request takes effect between two of them.
/// Without controllers the result has none. `options` are the same for all: steps, actuator, horizon, traces.
///
/// Errors: those of evaluate(), `where` = "controllers/<index>/..."; timeout if it was stopped. `labels`: the units in
/// verdicts. `device`: the user's own controller, on which each is evaluated as well. `model`: the identified model
/// that `subject` is made of; null for a given plant. `given_steps`: the steps of `options` that the user set.
/// `own_step`: simulated with every controller.
Expected<EvaluationResult> evaluate_all(const AnalysedPlant& subject, const std::vector<GivenController>& controllers,
                                        const EvaluateOptions& options,
                                        const std::optional<device::DeviceModel>& device, const verdict::Labels& labels,
                                        const RunControl& control, const IdentifiedModel* model = nullptr,
                                        const verdict::GivenSteps& given_steps = {},
                                        const std::optional<OwnStep>& own_step = {});

}  // namespace tunewright
