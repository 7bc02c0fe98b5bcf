#include "engine/range/run/profile.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "engine/number_text.h"
#include "engine/range/run/scheduled_run.h"

namespace tunewright::range {
namespace {

constexpr int kHalvings = 50;

}  // namespace

std::optional<Error> profile_fault(const Profile& profile) {
    const auto fault = [](std::string message) {
        return Error{ErrorKind::invalid_argument, "profile", std::move(message)};
    };
    if (profile.empty()) return fault("The profile has no points.");
    for (std::size_t k = 0; k < profile.size(); ++k) {
        if (!std::isfinite(profile[k].t) || !std::isfinite(profile[k].value) || profile[k].t < 0)
            return fault("Point " + std::to_string(k) + " of the profile is not finite, or before t = 0.");
        if (k > 0 && profile[k].t < profile[k - 1].t)
            return fault("The profile's times must be in ascending order; " + text(profile[k].t) + " follows " +
                         text(profile[k - 1].t) + ".");
    }
    return std::nullopt;
}

Expected<SteadyState> rest_at(const SteadyBranch& branch, double value) {
    if (branch.range().along != Along::input) return branch.at(value);
    const auto& states = branch.states();
    for (std::size_t k = 1; k < states.size(); ++k) {
        const double a = states[k - 1].y - value, b = states[k].y - value;
        if (a * b > 0) continue;
        double low = states[k - 1].at, high = states[k].at;
        for (int i = 0; i < kHalvings; ++i) {
            const auto middle = branch.at(0.5 * (low + high));
            if (!middle) return middle.error();
            ((middle->y - value) * a > 0 ? low : high) = middle->at;
        }
        return branch.at(0.5 * (low + high));
    }
    return Error{ErrorKind::invalid_argument, "profile", "No steady state of the range has y = " + text(value) + "."};
}

Expected<std::vector<Passage>> standard_passages(const SteadyBranch& branch, const Schedule& schedule) {
    double low = branch.low(), high = branch.high(), slowest = 0;
    if (branch.range().along == Along::input) {
        const auto first = branch.at(low), last = branch.at(high);
        if (!first) return first.error();
        if (!last) return last.error();
        low = first->y;
        high = last->y;
    }
    for (const ScheduleRow& row : schedule.rows) slowest = std::max(slowest, row.Ti);
    const double pause = 10 * slowest + 10 * branch.system().dead_time();
    std::vector<Passage> passages;
    passages.push_back({"step up", {{0, low}, {0, high}}, 2 * pause});
    passages.push_back({"step down", {{0, high}, {0, low}}, 2 * pause});
    Passage stairs{"stairs", {{0, low}}, 5 * pause};
    for (int k = 0; k < 4; ++k) {
        stairs.profile.push_back({k * pause, low + (high - low) * k / 4});
        stairs.profile.push_back({k * pause, low + (high - low) * (k + 1) / 4});
    }
    passages.push_back(std::move(stairs));
    passages.push_back({"ramp", {{0, low}, {5 * pause, high}, {6 * pause, high}, {11 * pause, low}}, 12 * pause});
    return passages;
}

Schedule one_row(const IdealPid& controller, double at) {
    return {.interpolation = Interpolation::linear_in_gains,
            .hysteresis = 0,
            .rows = {{.at = at,
                      .Kp = controller.Kp,
                      .Ti = controller.Ti,
                      .Td = controller.Td,
                      .Tf = controller.filter.Tf,
                      .b = controller.b}}};
}

}  // namespace tunewright::range
