// The report on the emulating controller and on the runs that it was chosen from.

#pragma once

#include "engine/tuning/emulation/criterion.h"
#include "engine/tuning/emulation/emulation_report.h"
#include "engine/tuning/emulation/fixed_error_qp.h"

namespace tunewright::emulation {

/// The answer of the second level.
struct EmulatedDesign {
    SettingsPoint point;
    Bounds bounds;
    double J = 0, J_u = 0;
    std::optional<double> J_y;
    bool stopped = false;  ///< the best so far
};

/// J as the second level counts it: by simulation, or by Remark 6. Empty with the reason where a run ended early.
struct Judgement {
    std::optional<double> J;
    std::string ended;
};
Judgement judge(const Criterion& criterion, const FixedErrorQp& remark6, const SettingsPoint& point);

/// Stopped, it leaves out what is not there yet of flatness and of the first level's runs.
EmulationReport report_of(const Criterion& criterion, const FixedErrorQp& remark6, const EmulatedDesign& design,
                          std::vector<LevelOneRow> level_one, const std::stop_token& stop);

/// Bounds that hold the optimum, unstable zero dynamics, limits in the nonlinear controller's way, a run that ended,
/// and Remark 7's judgement.
std::vector<Warning> remarks(const EmulationReport& report);

}  // namespace tunewright::emulation
