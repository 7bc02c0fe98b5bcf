// The trade-off between servo and regulation: the distance of a controller from the point that is best for both.
//
// J_r is the IAE of a unit set-point step, J_d that of a unit load step on the plant scaled to static gain 1 (the IAE
// over |K|): both are times, whatever the units of u and y. (J_r_opt, J_d_opt) is the best point: J_r of the
// servo-optimal and J_d of the load-optimal controller of the *model*.
//
//   J_rd = sqrt((J_r - J_r_opt)^2 + (J_d - J_d_opt)^2)      I_perf = J_rd(free)/J_rd      Deg = 1 - I_perf
//
// with "free" the rule of Table 1 without a limit on Ms, which was fitted for the least J_rd. Because it is a fit,
// I_perf may exceed 1. Source: Arrieta, Vilanova and Alfaro (2012), Eqs. 5, 10, 11; there the plant's gain and the load
// are 1.

#pragma once

#include <optional>
#include <string>

#include "engine/controller/pid.h"
#include "engine/expected.h"
#include "engine/figure.h"
#include "engine/plant/linear/linear_plant.h"
#include "engine/plant/plant.h"

namespace tunewright {

/// The PID controllers that are best for set points alone and for loads alone on a first-order model. Both have b = 1,
/// c = 0 and the derivative of the measurement filtered with Tf = Td/10.
struct IdealControllers {
    IdealPid servo;  ///< least IAE of a set-point step
    IdealPid load;   ///< least IAE of a load step
};

/// Short local searches from tabulated optima; the IAE on the model is within 1e-4 of the least one (mostly 1e-6). In
/// scaled form the result depends only on L/T.
///
/// Errors: unsupported if the model is not stable, has no dead time (no optimum: a higher gain is always better) or has
/// L/T above 50.
Expected<IdealControllers> ideal_controllers(const Fopdt& model);

struct TradeoffFigures {
    Figure J_r, J_d, J_rd, J_r_opt, J_d_opt, I_perf, Deg, Ms;
};

/// Figures that are all empty, for one reason.
TradeoffFigures no_tradeoff(const std::string& reason);

/// The reference controllers of a model, with which others are compared.
struct ReferenceControllers {
    Fopdt model;
    IdealControllers ideal;
    std::optional<IdealPid> free;  ///< empty below L/T of 0.045, where the rule gives Td < 0
};

/// Errors: those of ideal_controllers().
Expected<ReferenceControllers> reference_controllers(const Fopdt& model);

/// One plant with the figures of the reference controllers on it.
class TradeoffScale {
public:
    /// With an error in place of the references, only J_r, J_d and Ms are given.
    TradeoffScale(LinearPlant plant, const Expected<ReferenceControllers>& references);

    TradeoffFigures figures(const ParallelPid& controller) const;

    /// The same for a controller whose Ms, J_r and J_d are already known; `no_J` is the reason if one of these is
    /// empty.
    TradeoffFigures placed(std::optional<double> Ms, std::optional<double> J_r, std::optional<double> J_d,
                           const std::string& no_J) const;

    /// Empty if the plant integrates or its gain is 0; then all figures are empty.
    std::optional<double> static_gain() const { return K_.value; }

    /// Deg alone, for searches; empty if `figures` has none.
    std::optional<double> degradation(const ParallelPid& controller) const;

private:
    LinearPlant plant_;
    Figure K_;                              // static gain
    Figure J_r_opt_, J_d_opt_, J_rd_free_;  // of the references on this plant
};

}  // namespace tunewright
