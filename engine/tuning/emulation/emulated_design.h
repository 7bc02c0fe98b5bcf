// The report on the emulating controller and on the runs from which it was chosen.

#pragma once

#include "engine/tuning/emulation/criterion.h"
#include "engine/tuning/emulation/emulation_report.h"
#include "engine/tuning/emulation/fixed_error_qp.h"

namespace tunewright::emulation {

/// The result of the second level.
struct EmulatedDesign {
    SettingsPoint point;
    Bounds bounds;
    double J = 0, J_u = 0;
    std::optional<double> J_y;
    bool stopped = false;  ///< true: stopped, the best so far
};

/// J as the second level computes it: by simulation, or by Remark 6. Empty, with the reason, if a run ended early.
struct Judgement {
    std::optional<double> J;
    std::string ended;
};
Judgement judge(const Criterion& criterion, const FixedErrorQp& remark6, const SettingsPoint& point);

/// If it was stopped, the missing parts of flatness and of the first level's runs are omitted.
EmulationReport report_of(const Criterion& criterion, const FixedErrorQp& remark6, const EmulatedDesign& design,
                          std::vector<LevelOneRow> level_one, const std::stop_token& stop);

/// Warnings: bounds that contain the optimum, unstable zero dynamics, limits that the nonlinear controller reaches, a
/// run that ended early, and the fit by Remark 7.
std::vector<Warning> remarks(const EmulationReport& report);

}  // namespace tunewright::emulation
