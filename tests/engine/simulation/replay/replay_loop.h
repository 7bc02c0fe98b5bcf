// A sampled loop written a second time: a lag with dead time in closed form, and a PI as a few lines.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "engine/plant/plant.h"
#include "engine/simulation/replay/loop_replay.h"

namespace tunewright::test {

struct OwnPi {
    double Kp = 1, Ki = 0.1, b = 1;
    int every = 1;  ///< rows from one computation to the next
    double low = -1e9, high = 1e9;
};

/// At the rows: r, load at the plant's input, disturbance and noise at its output. Equal lengths.
struct OwnHour {
    double h = 1;
    std::vector<double> r, load, output;
};

/// y and u at the rows. The loop rests at r[0] and u = u0 before the first. The integral waits at the limits.
inline LoopRows own_loop(const Fopdt& plant, const OwnPi& pi, const OwnHour& hour, double u0) {
    const double a = std::exp(-hour.h / plant.T);
    const int whole = static_cast<int>(std::floor(plant.L / hour.h + 1e-9));
    const double late = std::exp(-(hour.h - (plant.L - whole * hour.h)) / plant.T);
    LoopRows rows{.t0 = 0, .h = hour.h, .u = {}, .y = {}, .r = hour.r};
    const double y0 = hour.r.front();
    double x = 0, integral = u0 - pi.Kp * (pi.b - 1) * y0, u = u0;
    const auto given = [&](int k) { return k < 0 ? 0 : rows.u[static_cast<std::size_t>(k)] - u0; };
    for (int k = 0; k < static_cast<int>(hour.r.size()); ++k) {
        const auto row = static_cast<std::size_t>(k);
        const double r = hour.r[row], y = y0 + x + hour.output[row];
        if (k % pi.every == 0) {
            const double step = pi.Ki * hour.h * pi.every * (r - y);
            const double wanted = pi.Kp * (pi.b * r - y) + integral + step;
            u = std::clamp(wanted, pi.low, pi.high);
            if (u == wanted || (wanted > u) != (step > 0)) integral += step;
        }
        rows.y.push_back(y);
        rows.u.push_back(u);
        x = a * x +
            plant.K * ((late - a) * given(k - whole - 1) + (1 - late) * given(k - whole) + (1 - a) * hour.load[row]);
    }
    return rows;
}

/// Two set-point steps, a step of the load, and a ramp with an oscillation at the output.
inline OwnHour eventful_hour(int rows, double h) {
    OwnHour hour{.h = h, .r = {}, .load = {}, .output = {}};
    for (int k = 0; k < rows; ++k) {
        hour.r.push_back(20 + (k > rows / 10 ? 5 : 0) - (k > rows / 2 ? 8 : 0));
        hour.load.push_back(k > rows / 3 ? 1.5 : 0);
        hour.output.push_back(k == 0 ? 0 : 2.0 * k / rows + 0.05 * std::sin(0.17 * k));
    }
    return hour;
}

inline SampledPid law_of(const OwnPi& pi, double h) {
    return {.gains = {.Kp = pi.Kp, .Ki = pi.Ki, .b = pi.b}, .Ts = h * pi.every};
}

}  // namespace tunewright::test
