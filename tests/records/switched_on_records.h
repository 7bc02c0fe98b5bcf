// Records of controllers that are switched on from cold, each from a seed: the usual log of an oven or a boiler. The
// plants are simulated in steps much finer than the rows, and share no code with the product.
#pragma once

#include "tests/records/closed_loop_records.h"

namespace tunewright::testing {

/// P, PI or PID, sampled with the rows, in manual at u = 0 until `on_row`.
struct ColdStart {
    LoopPlant plant{2, 200, 30, 12, false};
    double dt = 1, Kp = 2, Ti = 200, Td = 0, weight = 1, filter = 0;
    double low = 0, high = 100;
    double y0 = 20, r = 80, noise = 0.05, y_grid = 0, u_grid = 0;
    int rows = 800, on_row = 20;
    bool with_r = true;
    unsigned seed = 1;

    Record record() const {
        constexpr int kFine = 10;
        Record out;
        Dice dice(seed);
        PlantRun run(plant, dt / kFine);
        double y = 0, integral = 0, before = 0, slope = 0, filtered = 0, u = 0;
        for (int i = 0; i < rows; ++i) {
            double seen = y0 + y + noise * dice.normal();
            if (y_grid > 0) seen = y_grid * std::round(seen / y_grid);
            if (i == on_row) before = filtered = seen;
            if (i >= on_row) {
                filtered += filter > 0 ? -std::expm1(-dt / filter) * (seen - filtered) : seen - filtered;
                slope += dt / (Td / 8 + dt) * ((before - filtered) / dt - slope);
                before = filtered;
                const double step = Ti > 0 ? Kp * dt / Ti * (r - filtered) : 0;
                const double wanted =
                    Kp * (weight * r + (1 - weight) * y0 - filtered) + integral + step + Kp * Td * slope;
                u = std::clamp(wanted, low, high);
                if (wanted == u || (wanted - u) * step < 0) integral += step;
                if (u_grid > 0) u = u_grid * std::round(u / u_grid);
            }
            out.t.push_back(i * dt);
            out.u.push_back(u);
            out.y.push_back(seen);
            if (with_r) out.r.push_back(r);
            for (int k = 0; k < kFine; ++k) y = run.advance(u);
        }
        return out;
    }
};

/// Heaters and coolers, fast and slow controllers, with the effects in such logs: limits, grids, filters, weights.
inline ColdStart random_cold_start(unsigned seed) {
    Dice dice(seed + 99'000u);
    ColdStart c;
    c.seed = seed;
    c.dt = dice.log_between(0.2, 5);
    LoopPlant& p = c.plant;
    p.T1 = c.dt * dice.log_between(40, 400);
    p.L = p.T1 * dice.log_between(0.03, 0.4);
    p.T2 = dice.chance(0.6) ? p.T1 * dice.between(0.05, 0.4) : 0;
    const double span = dice.between(20, 120);
    p.K = span / dice.between(20, 70);
    c.y0 = dice.between(5, 40);
    c.r = c.y0 + span;
    const double dead = p.L + p.T2 / 2, lag = p.T1 + p.T2 / 2,
                 lambda = std::max(dice.log_between(1, 4) * dead, lag / 20);
    c.Kp = lag / p.K / (lambda + dead);
    c.Ti = std::min(lag, 4 * (lambda + dead));
    const int kind = dice.whole(0, 9);  // 0: P; 1 to 5: PI; 6 to 9: PID
    if (kind == 0) c.Ti = 0;
    if (kind >= 6) c.Td = dice.between(0.1, 0.4) * dead;
    c.weight = c.Ti > 0 && dice.chance(0.25) ? dice.between(0, 0.6) : 1;
    c.filter = dice.chance(0.2) ? dice.between(0.1, 0.5) * dead : 0;
    c.high = dice.chance(0.7) ? 100 : 1000;
    c.noise = dice.chance(0.2) ? 0 : span * dice.log_between(0.0005, 0.01);
    c.y_grid = dice.chance(0.5) ? span * dice.log_between(0.001, 0.01) : 0;
    c.u_grid = dice.chance(0.4) ? 1 : 0;
    c.rows = std::min(3000, static_cast<int>(dice.between(3, 8) * (lag + dead) / c.dt));
    c.on_row = dice.whole(6, 40);
    c.with_r = dice.chance(0.7);
    if (dice.chance(0.15)) p.K = -p.K, c.Kp = -c.Kp, c.r = c.y0 - span;
    return c;
}

}  // namespace tunewright::testing
