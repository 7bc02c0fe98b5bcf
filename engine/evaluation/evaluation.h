// Everything known about one controller on one plant: robustness, performance, traces; and the options for them.
#pragma once

#include <memory>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "engine/controller/pid.h"
#include "engine/figure.h"
#include "engine/plant/plant_family.h"
#include "engine/warning.h"

namespace tunewright {

struct NoiseOptions {
    double std = 0;          ///< standard deviation of the white measurement noise, >= 0
    double sample_time = 0;  ///< > 0; 0: the default of the loop (loop/noise.h)
};

struct EvaluateOptions {
    double setpoint_step = 1;       ///< != 0
    double load_step = 1;           ///< != 0
    std::optional<double> horizon;  ///< > 0; empty: chosen automatically, and indices are integrals to infinity
    int points = 400;               ///< points of each trace: 0 (none) or 2 to 20,000
    std::optional<ActuatorLimits> actuator;
    std::optional<NoiseOptions> noise;
    std::optional<double> rank_Ms;      ///< entries with Ms above it rank last; empty: the default of every ranking
    std::optional<bool> optimum_at_Ms;  ///< compare with the robust optimum at the same Ms; empty: only several designs
    bool tradeoff =
        false;  ///< entries have the trade-off between servo and regulation (tuning/arrieta/tradeoff_report.h)
    std::stop_token stop;  ///< checked between the parts of an evaluation, which then returns the error `cancelled`
};

/// Suprema over 0 <= omega <= infinity, both ends included. Empty if the loop is not stable or the quantity is
/// infinite. Ms, Mt and the gain margins are ratios; Mks in u/y, frequencies in rad/time, the phase margin in degrees,
/// the delay margin in time.
struct Robustness {
    bool stable = false;
    Figure Ms, omega_Ms, Mt, omega_Mt, Mks;
    Figure gain_margin, gain_margin_low, phase_margin_deg, delay_margin;
    Figure gain_crossover, phase_crossover;
    std::string binding;  ///< e.g. "Ms at omega 12.3"
    struct Tolerates {
        Figure gain_low, gain_high, extra_dead_time;
    } tolerates;
};

struct SetpointPerformance {
    Figure IAE, ISE, ITAE, overshoot_percent, rise_time, rise_time_5_95, settling_time, TV, first_move;
};

struct LoadPerformance {
    Figure IAE, ISE, ITAE, peak, recovery_time, TV;
};

struct NoisePerformance {
    Figure u_std, gain;
};

struct Performance {
    SetpointPerformance setpoint;
    LoadPerformance load;
    std::optional<NoisePerformance> noise;
};

struct Trace {
    std::vector<double> t, y, u;
};

struct ResponsePair;  // response_pair.h

struct Responses {
    Trace setpoint, load;
    bool settles = true;
    std::shared_ptr<const ResponsePair> course =
        {};  ///< until the horizon of all entries is known; not part of the answer
};

struct FrequencyTraces {
    std::vector<double> omega, L_re, L_im, L_phase_deg, S_abs, T_abs, CS_abs;
};

/// Relative errors of a response's indices: the change in the last halving of the time steps, quadrature included
/// (measured_response.h). Empty if the index has no value.
struct IndexErrors {
    std::optional<double> IAE, ISE, ITAE, TV;
};

/// Results of the checks of the figures; empty if a check does not apply.
struct Verification {
    IndexErrors setpoint_errors, load_errors;
    std::optional<double> iae_step_halving;     ///< relative change of the load IAE in that halving
    std::optional<bool> load_error_keeps_sign;  ///< true: the IAE is exactly |d| Ti/|Kp|; only with integral action
    std::optional<double> ie_identity;          ///< |int y dt - d Ti/Kp| / (d Ti/|Kp|)
    std::optional<double> ms_grid_difference;   ///< relative difference of Ms on an independent grid
    std::optional<bool> stability_methods_agree;
};

/// Figures of the nonlinear PID beyond its linear part. Sector: the integral acts on k e with k in (0, 1].
struct NonlinearFigures {
    double delta_r = 0;
    bool stable_without_integral = false;  ///< the loop with P and D action only, the limit for very large errors
    bool circle_criterion = false;         ///< holds: every error decays, whatever its size
    bool popov_criterion = false;          ///< the same, less conservative
    Figure popov_q;                        ///< q in Re (1 + j omega q) G > -1
    bool limit_cycle_predicted = false;    ///< by the describing function
    Figure limit_cycle_amplitude, limit_cycle_omega;  ///< amplitude in y; larger errors may not decay
    std::string statement;                            ///< all these figures as a sentence
};

struct Equivalents {
    ParallelPid parallel;
    std::optional<SeriesPid> series;
    std::string why_no_series;
};

/// The response of a nonlinear plant's linearisation with the same controller, steps and limits.
struct LinearisedResponse {
    Performance performance;
    std::optional<Responses> responses;
};

/// Everything known about one controller on one plant, or on the nominal plant of a family.
struct Evaluation {
    Controller controller;
    Equivalents equivalents;
    Robustness robustness;
    Performance performance;
    std::optional<Responses> responses;        ///< with points > 0 and a stable loop
    std::optional<FrequencyTraces> frequency;  ///< with points > 0
    Verification verification;
    std::optional<NonlinearFigures> nonlinear;  ///< for an Npid whose linear part is stable
    std::optional<LinearisedResponse> linear;   ///< for a nonlinear plant
    std::optional<RegionFigures> region;        ///< for a family of more than one plant
    std::vector<Warning> warnings;
    double compute_ms = 0;
};

}  // namespace tunewright
