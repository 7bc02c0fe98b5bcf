// Two controllers in series: the outer one's output is the set point of the inner one, whose output moves the valve.
//
//   series:   y2 = P2 (u + d2),  y1 = P1 (y2 + d1)          parallel:  y2 = P2 (u + d2),  y1 = P1 (u + d2)
//   u = C2 (r2 - y2),  r2 = C1 (r1 - y1)
//
// Three peaks, none of which bounds the others: Ms_inner of the inner loop with the outer one in manual, Ms_outer of
// the loop broken at r2, Ms_valve of the loop broken at the valve, 1 + Lu = (1 + L2)(1 + L1) (Skogestad and
// Postlethwaite 2005, section 10.5). With integral action in the inner loop a load d1 has IE = -Ti1/Kp1, and a load d2
// has IE = 0.
#pragma once

#include <optional>

#include "engine/controller/pid.h"
#include "engine/expected.h"
#include "engine/figure.h"
#include "engine/loop/margins.h"
#include "engine/plant/linear/linear_plant.h"
#include "engine/progress.h"
#include "engine/structure/loop_design.h"

namespace tunewright::structure {

enum class Arrangement { series, parallel };

struct CascadePlants {
    LinearPlant inner, outer;
    Arrangement arrangement = Arrangement::series;
};

struct CascadeControllers {
    IdealPid inner, outer;
};

/// Figures of y1 after a unit step; TV of the valve.
struct LoadFigures {
    Figure IAE = 0.0, IE = 0.0;
    double peak = 0, TV = 0;
};
struct CascadeFigures {
    bool stable = false;
    double Ms_inner = 0, Mt_inner = 0, Ms_outer = 0, Mt_outer = 0, Ms_valve = 0;
    Margins outer_margins{};
    Figure speed_ratio;                            ///< gain crossover of the inner over that of the outer loop
    LoadFigures inner_load, outer_load, setpoint;  ///< of a set point the peak is that above 1
};

/// Figures of a pair of controllers. Errors: those of cascade_diagram(); unstable loops are no error.
Expected<CascadeFigures> judge_cascade(const CascadePlants& plants, const CascadeControllers& controllers);

/// The limit on Ms_valve if none is given, over the larger of the two Ms.
inline constexpr double kDefaultValveOverLoops = 1.15;
double default_valve_limit(double Ms_inner, double Ms_outer);

struct CascadeDesign {
    LoopDesign inner, outer;
    std::optional<IdealPid> given_inner = {};   ///< kept, in place of a design
    std::optional<double> Ms_valve = {};        ///< empty: default_valve_limit()
    bool joint = false;                         ///< all settings at once after the sequential design
    double weight_outer = 1, weight_inner = 1;  ///< of the IAE after d1 and d2, in a joint design

    double valve_limit() const;
};

struct CascadeResult {
    CascadeControllers controllers;
    CascadeFigures figures;
    bool partial = false;  ///< stopped: the best so far
};

/// Sequential: the inner loop by the method robust on P2; the outer one for the least IAE after d1 on the exact inner
/// loop, within the limits on Ms_outer, Mt_outer and Ms_valve. Where none keeps them the inner loop is weakened. Joint:
/// from there the least weighted sum of the IAE after d1 and d2 over all settings, within the limits on the three Ms.
/// Errors: those of the method robust; no_feasible_controller.
Expected<CascadeResult> design_cascade(const CascadePlants& plants, const CascadeDesign& design,
                                       const RunControl& control);

/// One controller from y1 to the valve, without the inner loop.
struct SingleLoop {
    IdealPid controller;
    bool stable = false;
    double Ms = 0, Mt = 0;
    LoadFigures inner_load, outer_load, setpoint;
};

/// The method robust on the whole plant. Errors: those of the method.
Expected<SingleLoop> design_single_loop(const CascadePlants& plants, const LoopDesign& design,
                                        const RunControl& control);

}  // namespace tunewright::structure
