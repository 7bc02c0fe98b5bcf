#include "engine/evaluation/response_pair.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "engine/evaluation/performance_figures.h"

namespace tunewright {
namespace {

constexpr double kMaxHorizonOverShortest = 3;

Trace trace(const KnownResponse& run, double horizon, int points) {
    return trace_of(run.response, std::min(horizon, run.known_to), points);
}

}  // namespace

KnownResponse KnownResponse::of(StepResponse response) {
    KnownResponse run{std::move(response)};
    if (!run.response.settles) run.known_to = run.response.nodes.back().t;
    return run;
}

std::optional<Responses> drawn(KnownResponse setpoint, KnownResponse load, const EvaluateOptions& options) {
    if (options.points < 2) return std::nullopt;
    ResponsePair course{std::move(setpoint), std::move(load), 0, options.points, true};
    course.settles = course.setpoint.response.settles && course.load.response.settles;
    course.horizon = options.horizon.value_or(covering_horizon(course.setpoint.response, course.load.response));
    Responses responses = responses_of(std::make_shared<const ResponsePair>(std::move(course)), course.horizon);
    if (options.horizon) responses.course.reset();
    return responses;
}

Responses responses_of(std::shared_ptr<const ResponsePair> course, double horizon) {
    Responses responses{trace(course->setpoint, horizon, course->points), trace(course->load, horizon, course->points),
                        course->settles};
    responses.course = std::move(course);
    return responses;
}

void draw_together(const std::vector<Responses*>& all) {
    double longest = 0, shortest = INFINITY;
    for (const bool must_settle : {true, false}) {
        for (const Responses* responses : all) {
            if (!responses->course || (must_settle && !responses->settles)) continue;
            longest = std::max(longest, responses->course->horizon);
            shortest = std::min(shortest, responses->course->horizon);
        }
        if (longest > 0) break;
    }
    const double horizon = std::min(longest, kMaxHorizonOverShortest * shortest);
    for (Responses* responses : all) {
        const bool drawn_so = responses->setpoint.t.back() == horizon && responses->load.t.back() == horizon;
        if (responses->course && !drawn_so) *responses = responses_of(responses->course, horizon);
        responses->course.reset();
    }
}

}  // namespace tunewright
