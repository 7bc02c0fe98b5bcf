#include "engine/range/experiments.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "engine/number_text.h"
#include "engine/plant/linear/linear_plant.h"
#include "engine/range/problem.h"

namespace tunewright::range {
namespace {

std::optional<Error> fault_of(const SteadyBranch& branch, const ExperimentOptions& options) {
    const auto fault = [](const char* where, std::string message) {
        return Error{ErrorKind::invalid_argument, where, std::move(message)};
    };
    if (options.at.empty() || options.at.size() > std::size_t(kMaxPoints))
        return fault("experiment/at", "There are " + std::to_string(options.at.size()) + " places; give 1 to 20.");
    for (std::size_t k = 0; k < options.at.size(); ++k) {
        const double at = options.at[k];
        if (!(at >= branch.low() && at <= branch.high()))
            return fault("experiment/at", "The place " + text(at) + " lies outside the range of " + text(branch.low()) +
                                              " to " + text(branch.high()) + ".");
        if (k > 0 && !(at > options.at[k - 1]))
            return fault("experiment/at", "The places must be in ascending order; " + text(at) + " follows " +
                                              text(options.at[k - 1]) + ".");
    }
    if (options.size && !(std::abs(*options.size) > 0 && std::isfinite(*options.size)))
        return fault("experiment/size", "The size of the input's change is " + text(*options.size) +
                                            "; it must be a number other than 0.");
    return std::nullopt;
}

/// The interval of y over the operating range.
double y_span(const SteadyBranch& branch) {
    const auto [low, high] = std::ranges::minmax(branch.states(), {}, &SteadyState::y);
    return high.y - low.y;
}

/// The change of the input that finally moves y by dy; for an integrating plant, that moves it within the plant's own
/// time.
double size_for(const LinearPlant& plant, double dy) {
    const double gain = std::abs(plant.low_frequency_gain());
    return plant.integrators() > 0 ? dy / (gain * std::max(plant.time_scale(), 1e-300)) : dy / gain;
}

Error at_place(Error error, const SteadyBranch& branch, double at) {
    error.message = "At " + branch.scheduling_name() + " = " + text(at, 6) + ": " + error.message;
    return error;
}

Expected<PlaceTest> test_at(const SteadyBranch& branch, double at, const ExperimentOptions& options,
                            const RunControl& control) {
    auto rest = branch.at(at);
    if (!rest) return rest.error();
    const auto system = NonlinearSystem::make(branch.plant_at(*rest));
    if (!system) return system.error();
    const auto linear = LinearPlant::make(branch.linearised(*rest));
    if (!linear) return linear.error();
    // Along a constant output y has no range: then the size is that of y itself.
    const double span = y_span(branch), dy = span > 0 ? span : std::abs(rest->y);
    const double size = options.size.value_or(size_for(*linear, options.y_part * dy));
    PlaceTest result{.rest = *rest, .size = size, .test = {}};
    if (options.kind == ExperimentKind::step) {
        auto test = simulate_step_test(*system, size, control);
        if (!test) return test.error();
        result.size = test->du;
        result.test = std::move(*test);
        return result;
    }
    auto test = simulate_relay_test(*system, std::abs(size), options.hysteresis_part * dy, control);
    if (!test) return test.error();
    result.test = std::move(*test);
    return result;
}

}  // namespace

Expected<std::vector<PlaceTest>> test_places(const SteadyBranch& branch, const ExperimentOptions& options,
                                             const RunControl& control) {
    if (auto fault = fault_of(branch, options)) return *fault;
    const RunControl quiet{.stop = control.stop, .progress = {}, .now_ms = {}};
    std::vector<PlaceTest> tests;
    for (const double at : options.at) {
        auto test = test_at(branch, at, options, quiet);
        if (!test) return at_place(test.error(), branch, at);
        tests.push_back(std::move(*test));
        if (control.progress)
            control.progress(Progress{
                .fraction = double(tests.size()) / double(options.at.size()),
                .stage = "experiment",
                .message = std::to_string(tests.size()) + " of " + std::to_string(options.at.size()) + " tests done.",
                .best = {}});
    }
    return tests;
}

}  // namespace tunewright::range
