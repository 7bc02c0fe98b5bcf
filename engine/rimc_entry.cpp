#include "engine/rimc_entry.h"

namespace tunewright {

RimcEntry rimc_entry(const RimcReport& report) {
    RimcEntry entry;
    entry.lambda = report.full_controller.lambda;
    entry.Ms = report.Ms;
    entry.disturbance_peak = report.disturbance_peak;
    entry.dead_time_error = report.dead_time_error;
    entry.stability_limit = report.stability_limit;
    entry.disturbance_peak_curve = report.curve;
    entry.why_null = report.why_null;
    return entry;
}

}  // namespace tunewright
