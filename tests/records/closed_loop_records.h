// Records of simulated loops and of open-loop tests, each from a seed: a sampled controller on a known plant, in steps
// much finer than the rows. Shares no code with the product.
#pragma once

#include <algorithm>
#include <cmath>
#include <deque>
#include <random>
#include <string>
#include <vector>

#include "engine/identification/record/record.h"

namespace tunewright::testing {

/// K e^(-Ls)/((T1 s + 1)(T2 s + 1)), or with 1/s in place of the first lag.
struct LoopPlant {
    double K = 1, T1 = 10, T2 = 0, L = 1;
    bool integrating = false;
};

enum class LoopTest { set_points_with_r, set_points_without_r, load_steps, noise_only };

struct SimulatedTest {
    Record record;
    LoopPlant plant;
    double Kp = 0, Ti = 0, Td = 0;
    std::string what;  ///< for a failed test's message
};

/// The standard library's distributions differ between implementations; these do not.
class Dice {
public:
    explicit Dice(unsigned seed) : bits_(seed * 2654435761u + 12345u) {
        for (int i = 0; i < 20; ++i) bits_();
    }
    double uniform() { return (bits_() + 0.5) / 4294967296.0; }
    double between(double low, double high) { return low + (high - low) * uniform(); }
    double log_between(double low, double high) { return low * std::pow(high / low, uniform()); }
    int whole(int low, int high) { return low + static_cast<int>((high - low + 1) * uniform()); }
    bool chance(double p) { return uniform() < p; }
    double normal() { return std::sqrt(-2 * std::log(uniform())) * std::cos(6.283185307179586 * uniform()); }

private:
    std::mt19937 bits_;
};

/// A plant simulated in steps with its input held.
class PlantRun {
public:
    PlantRun(const LoopPlant& plant, double step)
        : plant_(plant), step_(step), line_(static_cast<std::size_t>(std::lround(plant.L / step)), 0.0) {}

    double advance(double input) {
        line_.push_back(input);
        const double delayed = line_.front();
        line_.pop_front();
        if (plant_.integrating)
            first_ += step_ * plant_.K * delayed;
        else
            first_ += -std::expm1(-step_ / plant_.T1) * (plant_.K * delayed - first_);
        if (plant_.T2 > 0)
            second_ += -std::expm1(-step_ / plant_.T2) * (first_ - second_);
        else
            second_ = first_;
        return second_;
    }

private:
    LoopPlant plant_;
    double step_, first_ = 0, second_ = 0;
    std::deque<double> line_;
};

inline LoopPlant random_plant(Dice& dice, double spacing) {
    LoopPlant plant;
    plant.T1 = spacing * dice.log_between(6, 80);
    plant.L = plant.T1 * dice.log_between(0.05, 1.0);
    if (dice.chance(0.4)) plant.T2 = plant.T1 * dice.between(0.1, 0.8);
    plant.K = dice.log_between(0.05, 20) * (dice.chance(0.5) ? 1 : -1);
    if (dice.chance(0.15)) {
        plant.integrating = true;
        plant.K /= plant.T1;
    }
    return plant;
}

/// P, PI or PID in the sampled loop, with real effects: limits, a grid of u, a filter, a slower or faster clock than
/// the rows', set-point weights, measurement noise, loads that drift and step.
inline SimulatedTest simulated_loop(unsigned seed, LoopTest excitation) {
    Dice dice(seed * 4u + static_cast<unsigned>(excitation));
    SimulatedTest out;
    const double spacing = dice.log_between(0.1, 10);
    const int rows = static_cast<int>(dice.log_between(250, 2500));
    const LoopPlant plant = out.plant = random_plant(dice, spacing);

    const int fine = 10;
    const double step = spacing / fine;
    const int clock_kind = dice.whole(0, 5);
    const int clock = clock_kind <= 2   ? fine
                      : clock_kind == 3 ? fine * dice.whole(2, 6)
                      : clock_kind == 4 ? 2
                                        : fine / 2;
    const double h = clock * step;
    const double y_filter = dice.chance(0.2) ? dice.between(0.1, 0.5) * plant.L + h : 0;

    // lambda tuning, from fast to slow, for plant, clock and filter together
    const double lag = plant.T1 + plant.T2 / 2, dead = plant.L + plant.T2 / 2 + 1.5 * h + y_filter;
    const double lambda = std::max(dice.log_between(0.8, 4) * dead, 0.1 * plant.T1);
    double weight = dice.chance(0.25) ? 0 : 1;
    const int kind = dice.whole(0, 9);  // 0, 1: P; 2 to 7: PI; 8, 9: PID
    const double rate = plant.integrating ? plant.K : plant.K / plant.T1;
    out.Kp = 1 / (rate * (lambda + dead));
    out.Ti = plant.integrating ? 4 * (lambda + dead) : std::min(lag, 4 * (lambda + dead));
    if (kind <= 1) out.Ti = 0, out.Kp *= 0.8, weight = 1;
    if (kind >= 8) out.Td = dice.between(0.1, 0.3) * std::max(plant.L, plant.T2);
    const double filter = out.Td / dice.between(3, 8) + h;

    const bool on_error = dice.chance(0.3);  // derivative action on the error, otherwise on y

    // magnitudes: y moves by about `swing`
    const double swing = dice.log_between(0.5, 50);
    const double u_swing = plant.integrating ? swing / std::abs(plant.K) / (lambda + dead) : swing / std::abs(plant.K);
    const bool moves = excitation == LoopTest::set_points_with_r || excitation == LoopTest::set_points_without_r;
    const double noise = swing * (moves ? dice.log_between(0.001, 0.08) : dice.log_between(0.01, 0.2));
    const double wander = swing * (dice.chance(0.5) ? dice.log_between(0.002, moves ? 0.05 : 0.3) : 0);
    const double wander_time = plant.T1 * dice.log_between(0.2, 5);
    const bool loads = excitation == LoopTest::load_steps || (moves && dice.chance(0.25));
    const double load_size = u_swing * (moves ? dice.between(0.05, 0.4) : dice.between(0.3, 1.5));
    const double load_gap = (lag + dead) * dice.between(4, 15);
    const double move_gap = std::min((lag + 4 * (lambda + dead)) * dice.between(1.0, 3), rows * spacing / 2.5);
    const double u_grid = dice.chance(0.3) ? u_swing * dice.log_between(0.002, 0.05) : 0;
    const double y_grid = dice.chance(0.3) ? swing * dice.log_between(0.001, 0.02) : 0;
    const bool seen_rounded = dice.chance(0.5);
    const bool own_noise = dice.chance(0.15);  // the log samples y separately
    const double limit = dice.chance(0.3) ? u_swing * dice.between(1.1, 2.0) : 1e300;
    const double u_offset = dice.between(-1, 3) * u_swing, y_offset = dice.between(-5, 5) * swing;

    PlantRun run(plant, step);
    double r = 0, load = 0, wandering = 0, u = 0, integral = 0, slope = 0, before = 0, r_before = 0, filtered = 0;
    double y_true = 0, logged = 0;
    const double start = (lag + dead) * dice.between(0.3, 2);
    double next_move = moves ? start : 1e300, next_load = loads ? start + load_gap * dice.uniform() : 1e300;
    const double keep = std::exp(-step / wander_time);
    for (int i = 0; i < rows * fine; ++i) {
        const double t = i * step;
        if (t >= next_move) {
            r = r == 0 || dice.chance(0.4) ? swing * dice.between(0.5, 1) * (dice.chance(0.5) ? 1 : -1) : 0;
            next_move = t + move_gap * dice.between(0.8, 1.4);
        }
        if (t >= next_load) {
            load = load == 0 || dice.chance(0.3) ? load_size * dice.between(0.5, 1) * (dice.chance(0.5) ? 1 : -1) : 0;
            next_load = t + load_gap * dice.between(0.5, 1.5);
        }
        if (wander > 0) wandering = keep * wandering + std::sqrt(1 - keep * keep) * wander * dice.normal();
        const double y_here = y_true + wandering;
        if (i % clock == 0) {
            double seen = y_here + noise * dice.normal();
            if (y_grid > 0 && seen_rounded) seen = y_grid * std::round(seen / y_grid);
            logged = seen;
            if (y_filter > 0) filtered += -std::expm1(-h / y_filter) * (seen - filtered), seen = filtered;
            const double error = r - seen;
            const double change = -(seen - before) + (on_error ? r - r_before : 0);
            slope += (h / (filter + h)) * (change / h - slope);
            const double free = out.Kp * (weight * r - seen) + integral + out.Kp * out.Td * slope;
            const double step_i = out.Ti > 0 ? out.Kp * h / out.Ti * error : 0;
            const double wanted = free + step_i;
            u = std::clamp(wanted, -limit, limit);
            if (wanted == u || (wanted - u) * step_i < 0) integral += step_i;
            before = seen, r_before = r;
            if (u_grid > 0) u = u_grid * std::round(u / u_grid);
        }
        if (i % fine == 0) {
            double y = own_noise || clock > fine ? y_here + noise * dice.normal() : logged;
            if (clock > fine && !own_noise && i % clock == 0) y = logged;
            if (y_grid > 0) y = y_grid * std::round(y / y_grid);
            out.record.t.push_back(t);
            out.record.u.push_back(u_offset + u);
            out.record.y.push_back(y_offset + y);
            if (excitation == LoopTest::set_points_with_r) out.record.r.push_back(y_offset + r);
        }
        y_true = run.advance(u + load);
    }
    out.what = "seed " + std::to_string(seed) +
               (kind <= 1   ? " P"
                : kind <= 7 ? " PI"
                            : " PID") +
               " clock " + std::to_string(clock) + "/10 T1/dt " + std::to_string(plant.T1 / spacing) + " L/T1 " +
               std::to_string(plant.L / plant.T1) + (plant.integrating ? " integrating" : "") + " rows " +
               std::to_string(rows) + " noise " + std::to_string(noise / swing) + " wander " +
               std::to_string(wander / swing) + " weight " + std::to_string(weight) + " own_noise " +
               std::to_string(own_noise) + " yfilter " + std::to_string(y_filter / spacing) + " ugrid " +
               std::to_string(u_grid / u_swing) + " ygrid " + std::to_string(y_grid / swing) + " limit " +
               std::to_string(limit / u_swing) + " loads " + std::to_string(loads);
    return out;
}

/// A test in which u never responds to y: steps, staircases, bumps, ramps, pseudo-random levels, sines, heaters with
/// pulse width, slewing and lagging valves; with noise, drift, rounding, dead bands, uneven times.
inline SimulatedTest open_loop_test(unsigned seed) {
    Dice dice(seed + 7'000'000u);
    SimulatedTest out;
    const double spacing = dice.log_between(0.1, 10);
    const int rows = static_cast<int>(dice.log_between(200, 2500)), fine = 10;
    const double step = spacing / fine, end = rows * spacing;
    const LoopPlant plant = out.plant = random_plant(dice, spacing * dice.log_between(0.1, 1.5));
    const double size = dice.log_between(0.1, 50);
    const int shape = dice.whole(0, 12);
    static const char* const kNames[] = {"step",    "staircase", "bump",      "doublet", "prbs", "levels",
                                         "ramp",    "sine",      "multisine", "chirp",   "pwm",  "stairs and ramps",
                                         "slow pwm"};
    const double clock = spacing * std::round(dice.log_between(1, 60));
    double level = 0, next = end * dice.between(0.02, 0.2);
    const double first = next;
    double target = 0;
    const int steps = dice.whole(2, 8);
    const double w = 6.283185307179586 / (end / dice.log_between(2, 40));
    double phases[6], sizes[6];
    for (int k = 0; k < 6; ++k) phases[k] = dice.between(0, 6.28), sizes[k] = dice.between(0.3, 1);
    const double slew = dice.chance(0.15) ? size / (plant.T1 * dice.between(0.05, 1)) : 0;
    const double lag = dice.chance(0.12) ? plant.T1 * dice.between(0.02, 0.4) : 0;
    const double jitter = dice.chance(0.2) ? size * dice.log_between(0.0005, 0.02) : 0;
    const double u_grid = dice.chance(0.2) ? size * dice.log_between(0.002, 0.05) : 0;
    const double swing = std::abs(plant.integrating ? plant.K * plant.T1 : plant.K) * size;
    const double noise = dice.chance(0.15) ? 0 : swing * dice.log_between(0.001, 0.2);
    const double pole = dice.chance(0.4) ? dice.between(0.5, 0.99) : 0;
    const double drift = dice.chance(0.2) ? swing * dice.between(-0.5, 0.5) / end : 0;
    const double y_grid = dice.chance(0.3) ? swing * dice.log_between(0.001, 0.05) : 0;
    const double band = dice.chance(0.1) ? 0.1 * size : 0;  // for a sticking valve, between u and the plant
    const bool uneven = dice.chance(0.2), late = dice.chance(0.2);
    const double load = dice.chance(0.15) ? size * dice.between(-0.4, 0.4) : 0,
                 load_time = end * dice.between(0.3, 0.9);
    const double wander = dice.chance(0.2) ? swing * dice.log_between(0.005, 0.1) : 0;
    const double keep = std::exp(-step / (plant.T1 * dice.log_between(0.2, 5)));

    PlantRun run(plant, step);
    double u = 0, y = 0, valve = 0, wandering = 0, colour = 0, duty = 0.5, u_before = 0;
    int next_row = 0, moves = 0;
    for (int i = 0; i < rows * fine; ++i) {
        const double t = i * step;
        switch (shape) {
            case 0: target = t >= first ? size : 0; break;
            case 1:
            case 11:
                if (t >= next && moves < steps) {
                    level += size / steps * dice.between(0.3, 1) * (shape == 1 || dice.chance(0.7) ? 1 : -1);
                    next += (end - first) / steps, ++moves;
                }
                if (shape == 1)
                    target = level;
                else
                    target += std::clamp(level - target, -size * step / (0.1 * end), size * step / (0.1 * end));
                break;
            case 2: target = t >= first && t < first + 0.3 * end ? size : 0; break;
            case 3: target = t < first ? 0 : t < first + 0.2 * end ? size : t < first + 0.4 * end ? -size : 0; break;
            case 4:
                if (t >= next) target = dice.chance(0.5) ? size : -size, next += clock;
                break;
            case 5:
                if (t >= next) target = size * dice.between(-1, 1), next += clock * dice.whole(1, 5);
                break;
            case 6: target = size * std::clamp((t - first) / (0.4 * end), 0.0, 1.0); break;
            case 7: target = t < first ? 0 : size * std::sin(w * (t - first)); break;
            case 8:
                target = 0;
                for (int k = 0; k < 6; ++k) target += size / 3 * sizes[k] * std::sin((k + 1) * w * t + phases[k]);
                break;
            case 9: target = size * std::sin(w * t * (1 + 4 * t / end)); break;
            default: {
                const double period = clock * (shape == 12 ? 4 : 1);
                if (t >= next) next += period, duty = 0.5 + 0.4 * std::sin(w * t);
                target = (t - (next - period)) < duty * period ? size : 0;
            }
        }
        if (slew > 0)
            u += std::clamp(target - u, -slew * step, slew * step);
        else if (lag > 0)
            u += -std::expm1(-step / lag) * (target - u);
        else
            u = target;
        if (wander > 0) wandering = keep * wandering + std::sqrt(1 - keep * keep) * wander * dice.normal();
        if (i >= next_row) {
            const double white = dice.normal();
            colour = pole * colour + std::sqrt(1 - pole * pole) * white;
            double shown = y + wandering + noise * colour + drift * t;
            if (y_grid > 0) shown = y_grid * std::round(shown / y_grid);
            // `late`: the script that reads y at the end of the row's interval logs the u of that interval
            double logged = (late ? u_before : u) + jitter * dice.normal();
            if (u_grid > 0) logged = u_grid * std::round(logged / u_grid);
            out.record.t.push_back(t);
            out.record.u.push_back(logged);
            out.record.y.push_back(10 * swing + shown);
            next_row = i + (uneven ? dice.whole(3, 20) : fine);
            u_before = u;
        }
        if (std::abs(u - valve) > band) valve = u;
        y = run.advance(valve + (t >= load_time ? load : 0));
    }
    out.what = std::string("open ") + kNames[shape] + " seed " + std::to_string(seed) + " T1/dt " +
               std::to_string(plant.T1 / spacing) + " clock/dt " + std::to_string(clock / spacing) + " noise " +
               std::to_string(noise / swing) + (late ? " late" : "") + (uneven ? " uneven" : "") + " jitter " +
               std::to_string(jitter / size) + " ugrid " + std::to_string(u_grid / size) + " slew " +
               std::to_string(slew) + " lag " + std::to_string(lag);
    return out;
}

}  // namespace tunewright::testing
