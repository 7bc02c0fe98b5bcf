// What the method emulation reports beside its controller. Times from the step; y and u absolute; J in the user's
// units.
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

/// Classical settings of the first level, or why there are none.
struct LevelOneRow {
    std::string method;  ///< id of the registry
    std::string test;    ///< step, relay or linear: what its model comes from
    std::string title;
    std::optional<Plant> model;  ///< that its rule worked on
    std::optional<Controller> controller;
    std::string error;            ///< in place of the controller
    std::optional<double> J;      ///< as the second level counts it; empty where the run ended early
    std::string ended;            ///< why it did
    std::vector<double> t, y, u;  ///< of the first scenario
};

/// How much of the nonlinear controller's action the PID's leaves, and whether that is little (Remark 7).
struct EmulationFit {
    double u_left = 0;  ///< int (u_nl - u)^2 over int (u_nl - u_rest)^2, mean over the scenarios
    double y_left = 0;  ///< the same of y
    bool adequate = true;
    std::string sentence;
};

struct EmulatedScenario {
    double setpoint_step = 0;
    std::map<std::string, double> initial, parameters;
    double y_rest = 0, u_rest = 0;  ///< its plant's steady state
    std::vector<double> t, y_nl, u_nl, y, u;
    bool limited = false;  ///< a limit of the input clipped the nonlinear controller
    std::string ended;     ///< why the PID's run ended early; empty: it did not
};

struct EmulationReport : MethodReport {
    std::string formulation;    ///< full or remark6
    double J = 0, J_u = 0;      ///< J = wy J_y + wu J_u
    std::optional<double> J_y;  ///< empty with remark6
    double wy = 0, wu = 0;
    double horizon = 0;
    std::vector<ActiveBound> active_bounds;
    std::map<std::string, NumberRange> bounds;     ///< of Kp, Ti, and Td, Tf where they are free
    std::map<std::string, double> flatness;        ///< change of a parameter for J + 5 %, the others re-optimised
    std::map<std::string, double> flatness_alone;  ///< the others fixed
    int relative_degree = 0;
    bool zero_dynamics_stable = true;
    std::vector<std::complex<double>> zeros;
    std::vector<double> beta;  ///< of the target beta_r y^(r) + ... + y = v
    EmulationFit fit;
    std::vector<LevelOneRow> level1;
    std::vector<EmulatedScenario> scenarios;

    /// Without points, leaves out all traces but what was emulated in the first scenario.
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
