#include "engine/verify/single_loop.h"

#include <cmath>
#include <utility>
#include <vector>

namespace tunewright::verify {
namespace {

LinearPlant transfer_function(std::vector<double> num, std::vector<double> den) {
    return std::move(*LinearPlant::make(Plant(TransferFunction{.num = std::move(num), .den = std::move(den)})));
}

/// Kd s P(s), without a pole at 0 that the derivative cancels.
LinearPlant derivative_of(const LinearPlant& plant, double Kd) {
    Zpk zpk{.K = Kd * plant.gain(),
            .zeros = {plant.zeros().begin(), plant.zeros().end()},
            .poles = {plant.poles().begin(), plant.poles().end()},
            .L = plant.dead_time()};
    const int integrators = plant.integrators() - 1;
    auto& at_0 = integrators > 0 ? zpk.poles : zpk.zeros;
    at_0.insert(at_0.end(), static_cast<std::size_t>(std::abs(integrators)), 0.0);
    return std::move(*LinearPlant::make(Plant(zpk)));
}

std::vector<double> measurement_denominator(const Filter& filter) {
    switch (filter.type) {
        case FilterType::measurement_first_order: return {filter.Tf, 1};
        case FilterType::measurement_second_order: return {filter.Tf * filter.Tf / 2, filter.Tf, 1};
        default: return {1};
    }
}

}  // namespace

Expected<SingleLoop> single_loop(const LinearPlant& plant, const ParallelPid& pid) {
    const Error no_derivative{ErrorKind::unsupported, "controller",
                              "The derivative has no filter; the second method has no form for it on this plant."};
    SingleLoop loop;
    BlockDiagram& diagram = loop.diagram;
    loop.r = diagram.add_signal();
    loop.u = diagram.add_signal();
    loop.y = diagram.add_signal();
    loop.seen = diagram.add_signal();
    const int reference = diagram.add_signal(), measured = diagram.add_signal(), error = diagram.add_signal();
    diagram.add(loop.u, loop.y, plant);
    diagram.add(loop.y, loop.seen, 1);

    if (pid.setpoint_lag > 0)
        diagram.add(loop.r, reference, transfer_function({1}, {pid.setpoint_lag, 1}));
    else
        diagram.add(loop.r, reference, 1);
    const std::vector<double> filter = measurement_denominator(pid.filter);
    if (filter.size() > 1)
        diagram.add(loop.seen, measured, transfer_function({1}, filter));
    else
        diagram.add(loop.seen, measured, 1);

    diagram.add(reference, loop.u, pid.Kp * pid.b);
    diagram.add(measured, loop.u, -pid.Kp);
    if (pid.Ki != 0) {
        diagram.add(reference, error, 1);
        diagram.add(measured, error, -1);
        diagram.add(error, loop.u, transfer_function({pid.Ki}, {1, 0}));
    }
    if (pid.Kd == 0) return loop;

    const bool filtered = pid.filter.type == FilterType::derivative;
    if (filtered) {
        diagram.add(loop.seen, loop.u, transfer_function({-pid.Kd, 0}, {pid.filter.Tf, 1}));
        if (pid.c != 0) diagram.add(reference, loop.u, transfer_function({pid.c * pid.Kd, 0}, {pid.filter.Tf, 1}));
        return loop;
    }
    if (pid.c != 0) {
        if (!(pid.setpoint_lag > 0)) return no_derivative;
        diagram.add(loop.r, loop.u, transfer_function({pid.c * pid.Kd, 0}, {pid.setpoint_lag, 1}));
    }
    if (filter.size() > 1) {
        diagram.add(loop.seen, loop.u, transfer_function({-pid.Kd, 0}, filter));
        return loop;
    }
    if (plant.pole_excess() < 1 || plant.unstable_poles() > 0) return no_derivative;
    loop.has_hidden_poles = true;
    diagram.add(loop.u, loop.u, derivative_of(plant, -pid.Kd), true);
    return loop;
}

}  // namespace tunewright::verify
