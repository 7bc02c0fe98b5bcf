// Two controllers in series: the outer one's output is the set point of the inner one, whose output moves the valve.
//
//   series:   y2 = P2 (u + d2),  y1 = P1 (y2 + d1)          parallel:  y2 = P2 (u + d2),  y1 = P1 (u + d2)
//   u = C2 (r2 - y2),  r2 = C1 (r1 - y1)
//
// Three peaks, none of which bounds the others: Ms_inner of the inner loop with the outer one in manual, Ms_outer of the
// loop broken at r2, Ms_valve of the loop broken at the valve, 1 + Lu = (1 + L2)(1 + L1) (Skogestad and Postlethwaite
// 2005, section 10.5). With integral action in the inner loop a load d1 has IE = -Ti1/Kp1, and a load d2 has IE = 0.
#pragma once

#include <optional>
#include <vector>

#include "engine/blocks/block_diagram.h"
#include "engine/controller/pid.h"
#include "engine/expected.h"
#include "engine/loop/margins.h"
#include "engine/progress.h"
#include "engine/tuning/limits.h"
#include "engine/tuning/method/rule.h"

namespace tunewright::structure {

enum class Arrangement { series, parallel };

struct CascadePlants {
    LinearPlant inner, outer;
    Arrangement arrangement = Arrangement::series;
};

struct CascadeControllers {
    IdealPid inner, outer;
};

/// The diagram and its signals. What enters from outside: r1 at `r1`, d1 at `outer_input` (series), d2 at `valve`.
struct CascadeDiagram {
    BlockDiagram diagram;
    int y1 = 0, y2 = 0, outer_input = 0, r1 = 0, r2 = 0, valve = 0;
};

/// `outer` null: the outer controller is in manual. Errors: those of add_pid().
Expected<CascadeDiagram> cascade_diagram(const CascadePlants& plants, const IdealPid& inner, const IdealPid* outer);

struct LoadFigures {
    double IAE = 0, IE = 0, peak = 0, TV = 0;
};
struct CascadeFigures {
    bool stable = false;
    double Ms_inner = 0, Mt_inner = 0, Ms_outer = 0, Mt_outer = 0, Ms_valve = 0;
    Margins outer_margins{};
    LoadFigures inner_load, outer_load, setpoint;  ///< unit steps; peak of the set-point step: of y1 above 1
    double overshoot_percent = 0;
};

/// Figures of a pair of controllers. Errors: those of cascade_diagram(); unstable loops are no error.
Expected<CascadeFigures> judge_cascade(const CascadePlants& plants, const CascadeControllers& controllers);

struct CascadeLimits {
    double Ms_inner = limits::kDefaultMs, Mt_inner = limits::kDefaultMt;
    double Ms_outer = limits::kDefaultMs, Mt_outer = limits::kDefaultMt;
    std::optional<double> Ms_valve;  ///< empty: 1.15 times the larger of the two Ms
};

struct CascadeDesign {
    ControllerKind inner = ControllerKind::PI, outer = ControllerKind::PI;
    CascadeLimits limits;
    bool joint = false;                        ///< all settings at once after the sequential design
    double weight_outer = 1, weight_inner = 1;  ///< of the IAE after d1 and d2, in a joint design
};

struct CascadeResult {
    CascadeControllers controllers;
    CascadeFigures figures;
    bool partial = false;  ///< stopped: the best so far
};

/// Sequential: the inner loop by the method robust on P2; the outer one for the least IAE after d1 on the exact inner
/// loop, within the limits on Ms_outer, Mt_outer and Ms_valve. Joint: from there the least weighted sum of the IAE after
/// d1 and d2 over all settings, within the limits on the three Ms. Errors: those of the method robust;
/// no_feasible_controller.
Expected<CascadeResult> design_cascade(const CascadePlants& plants, const CascadeDesign& design,
                                       const RunControl& control);

}  // namespace tunewright::structure
