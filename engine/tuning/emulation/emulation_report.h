// The report of the method emulation. Times from the step; y and u absolute; J in the user's units.
#pragma once

#include <complex>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "engine/controller/pid.h"
#include "engine/plant/plant.h"
#include "engine/tuning/method/method_report.h"
#include "engine/tuning/method/options.h"

namespace tunewright {

struct ActiveBound {
    std::string parameter;  ///< Kp, Ti, Td or Tf
    bool high = false;
    double value = 0;
};

/// Classical settings of the first level, or the error in their place.
struct LevelOneRow {
    std::string method;  ///< id of the registry
    std::string test;    ///< step, relay or linear: the origin of its model
    std::string title;
    std::optional<Plant> model;  ///< the model that its rule used
    std::optional<Controller> controller;
    std::string error;            ///< in place of the controller
    std::optional<double> J;      ///< as the second level computes it; empty if the run ended early
    std::string ended;            ///< the reason for that
    std::vector<double> t, y, u;  ///< the run of the first scenario
};

/// The part of the nonlinear controller's action that the PID does not reproduce, and whether it is small (Remark 7).
struct EmulationFit {
    double u_left = 0;  ///< int (u_nl - u)^2 over int (u_nl - u_rest)^2, mean over the scenarios
    double y_left = 0;  ///< the same for y
    bool adequate = true;
    std::string sentence;
};

struct EmulatedScenario {
    double setpoint_step = 0;
    std::map<std::string, double> initial, parameters;
    double y_rest = 0, u_rest = 0;  ///< steady state of its plant
    std::vector<double> t, y_nl, u_nl, y, u;
    bool limited = false;  ///< a limit of the input clipped the nonlinear controller's u
    std::string ended;     ///< the reason why the PID's run ended early; empty: it did not
};

struct EmulationReport : MethodReport {
    std::string formulation;    ///< full or remark6
    double J = 0, J_u = 0;      ///< J = wy J_y + wu J_u
    std::optional<double> J_y;  ///< empty with remark6
    double wy = 0, wu = 0;
    double horizon = 0;
    std::vector<ActiveBound> active_bounds;
    std::map<std::string, NumberRange> bounds;     ///< of Kp, Ti, and of Td and Tf if they are free
    std::map<std::string, double> flatness;        ///< change of a parameter for J + 5 %, with the others re-optimised
    std::map<std::string, double> flatness_alone;  ///< the same with the others fixed
    int relative_degree = 0;
    bool zero_dynamics_stable = true;
    std::vector<std::complex<double>> zeros;
    std::vector<double> beta;  ///< coefficients of the target beta_r y^(r) + ... + y = v
    EmulationFit fit;
    std::vector<LevelOneRow> level1;
    std::vector<EmulatedScenario> scenarios;

    /// Without points, removes all traces except the emulated one of the first scenario.
    void complete(const ReportContext& context, Evaluation&) override {
        if (context.options.points > 0) return;
        for (LevelOneRow& row : level1) row.t = row.y = row.u = {};
        for (EmulatedScenario& run : scenarios) {
            run.y = run.u = {};
            if (&run != &scenarios.front()) run.t = run.y_nl = run.u_nl = {};
        }
    }
};

}  // namespace tunewright
