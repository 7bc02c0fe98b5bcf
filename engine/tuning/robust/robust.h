// Robust design: the least IAE of a load step within limits on Ms and Mt (Garpinger and Hägglund 2008).

#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "engine/certificate/certificate.h"
#include "engine/tuning/limits.h"
#include "engine/tuning/method/method_report.h"
#include "engine/tuning/method/rule.h"
#include "engine/tuning/robust/design.h"
#include "engine/tuning/robust/filter_rule.h"

namespace tunewright {

/// A proof of the optimum, if it is asked for (certificate/certificate.h).
struct CertifyWish {
    std::optional<double> gap = {};  ///< the proof that no controller has an IAE lower by more than this share
};

struct RobustOptions {
    ControllerKind controller = ControllerKind::PID;          ///< PI or PID
    double Ms = limits::kDefaultMs, Mt = limits::kDefaultMt;  ///< limits, in (1, kMaxMs]
    std::optional<double> Mks = {};                           ///< limit on max |C S|
    robust::Constraint constraint = robust::Constraint::circles;
    robust::Objective objective = robust::Objective::load_iae;
    double rho = 0.5;  ///< weight of the load in the weighted objective
    robust::SearchKind search = robust::SearchKind::fast;
    bool surface = false;  ///< also return the cost over the (Ti, Td) plane
    RobustFilterOptions filter = {};
    CertifyWish certify = {};
};

/// The design on the ideal law.
Expected<TunedController> tune_robust(const TuningProblem& tuning, const RobustOptions& options,
                                      const RunControl& control);

/// The method robust for the controller's own law. Its objective is always the load IAE; a warning says so if the
/// options have another one. `ideal`: the method for the ideal law, which gives the start. Errors: those of the method
/// and of device::design.
Expected<DeviceDesign> tune_robust_for_device(const TuningProblem& tuning, const RobustOptions& options,
                                              const device::DeviceModel& device, const RunControl& control);

TuningMethod robust_method();

/// The method's report with `certify`.
struct CertificateReport : MethodReport {
    Certificate certificate;
    double seconds = 0;  ///< of computing; 0: not measured
};

/// The method's report with `surface`: the least cost over all Kp; cost[i][j] belongs to Ti[i] (time) and Td[j] (time).
/// Empty: no Kp keeps the limits.
struct CostSurface : MethodReport {
    std::vector<double> Ti, Td;
    std::vector<std::vector<std::optional<double>>> cost;
};

}  // namespace tunewright

namespace tunewright::robust {

/// The problem of the options on the nominal plant. Errors: no finite optimum, or no possible stable loop.
Expected<DesignProblem> nominal_problem(const TuningProblem& tuning, const RobustOptions& options);

/// The reason why the problem has no optimum, if it is known without a search.
std::optional<Error> without_optimum(const DesignProblem& problem);

/// verified_search() with limits that hold on the tuning problem's whole family: the worst plants found inside it are
/// added to `others`, to which the problem refers and which must outlive it.
Expected<DesignResult> search_everywhere(SearchKind kind, const TuningProblem& tuning, DesignProblem& problem,
                                         std::vector<LinearPlant>& others,
                                         const std::optional<std::pair<double, double>>& start, CostSurface* surface,
                                         const RunControl& control, const DesignResult* before,
                                         std::vector<Warning>& warnings);

/// The options of the filter under their names; at most one of them is given.
OptionSet<RobustFilterOptions> filter_options();

}  // namespace tunewright::robust
