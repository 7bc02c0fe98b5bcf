// Step and relay tests at several places of a range, simulated on its equations: the rehearsal of a whole procedure.
#pragma once

#include <optional>
#include <variant>
#include <vector>

#include "engine/expected.h"
#include "engine/progress.h"
#include "engine/range/equations/steady_branch.h"
#include "engine/simulation/experiment/nonlinear_experiments.h"

namespace tunewright::range {

enum class ExperimentKind { step, relay };

struct ExperimentOptions {
    ExperimentKind kind = ExperimentKind::step;
    std::vector<double> at;  ///< places of the range, 1 to 20, ascending
    std::optional<double> size =
        {};                ///< of the step of u, or half of the relay's swing; of either sign for a step, not 0
    double y_part = 0.05;  ///< without `size`: such that y moves by about this part of what it moves over the range
    double hysteresis_part = 0;  ///< of the relay, as a part of that motion of y; a plant without dead time needs one
};

/// Deviations from the steady state at the place.
struct PlaceTest {
    SteadyState rest;
    double size = 0;  ///< of u, as used
    std::variant<StepTest, NonlinearRelayTest> test;
};

/// Each test on the equations about their own steady state; records that identification reads like measured ones.
/// Stops between two tests; progress after each, stage "experiment". Errors: those of SteadyBranch::at,
/// NonlinearSystem::make, simulate_step_test and simulate_relay_test with the place in the sentence; invalid_argument,
/// `where` = "experiment/at", "experiment/size".
Expected<std::vector<PlaceTest>> test_places(const SteadyBranch& branch, const ExperimentOptions& options,
                                             const RunControl& control);

}  // namespace tunewright::range
