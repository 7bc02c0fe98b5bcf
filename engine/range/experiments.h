// Simulated step and relay tests at several points of a range, on its equations: the rehearsal of a whole procedure.
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
    std::vector<double> at;  ///< values of the scheduling variable, 1 to 20, ascending
    std::optional<double> size =
        {};                ///< size of the step of u, or half the swing of the relay; for a step of either sign, not 0
    double y_part = 0.05;  ///< without `size`: share of the range of y by which y is to move
    double hysteresis_part = 0;  ///< hysteresis of the relay, as a share of that motion of y; a plant without dead time
                                 ///< needs one
};

/// Deviations from the steady state at this point.
struct PlaceTest {
    SteadyState rest;
    double size = 0;  ///< size of the change of u that was used
    std::variant<StepTest, NonlinearRelayTest> test;
};

/// Runs each test on the equations about their own steady state. Identification reads the records like measured ones. A
/// stop takes effect between two tests; progress after each, stage "experiment". Errors: those of SteadyBranch::at,
/// NonlinearSystem::make, simulate_step_test and simulate_relay_test, with the place in the message; invalid_argument,
/// `where` = "experiment/at", "experiment/size".
Expected<std::vector<PlaceTest>> test_places(const SteadyBranch& branch, const ExperimentOptions& options,
                                             const RunControl& control);

}  // namespace tunewright::range
