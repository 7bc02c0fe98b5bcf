#include "engine/check/action.h"

#include <algorithm>
#include <string_view>

#include "engine/check/record_quality.h"

namespace tunewright::check {
namespace {

std::string valve_work(const LoopCheck& check, const char* what) {
    std::string out = std::string("Have the valve and its positioner looked at: ") + what;
    if (check.cause.size) out += " of about " + check.units.u_text(*check.cause.size);
    return out + ". Do not tune instead: new settings mostly just change the period of the cycle.";
}

bool has_remark(const LoopCheck& check, std::string_view code) {
    return std::ranges::any_of(check.quality.remarks, [&](const Warning& remark) { return remark.code == code; });
}

}  // namespace

Action action_for(const LoopCheck& check, const std::string& source) {
    using enum ActionCode;
    switch (check.cause.verdict) {
        case Verdict::healthy: return {none, Owner::nobody, "Nothing to do."};
        case Verdict::stiction: return {repair_valve, Owner::instruments, valve_work(check, "it sticks, with a band")};
        case Verdict::backlash:
            return {repair_valve, Owner::instruments, valve_work(check, "its linkage has a backlash")};
        case Verdict::tight:
            return {retune, Owner::control, "Reduce the gain: the loop is close to its stability limit."};
        case Verdict::sluggish:
            return {retune, Owner::control, "Tune the loop: it removes disturbances more slowly than it could."};
        case Verdict::external:
            if (!source.empty())
                return {find_source, Owner::process, "Correct " + source + " first: it makes this oscillation."};
            return {
                find_source, Owner::process,
                "Find the source of the disturbance: it comes from outside this loop. Look for a loop with the same "
                "period."};
        case Verdict::saturation:
            return {check_range, Owner::process,
                    "The output is at its limit for part of the time, where nothing is controlled. Look for the reason "
                    "in the process, or at the size of the valve."};
        case Verdict::quantised:
            return {
                check_transmitter, Owner::instruments,
                "The measurement comes in coarse steps. Look at the range of the transmitter, the converter and the "
                "historian."};
        case Verdict::manual:
            return {return_to_automatic, Owner::operations,
                    "Find out why the loop is in manual, correct that, and return it to automatic."};
        case Verdict::frozen:
            return {check_transmitter, Owner::instruments,
                    "The measurement stands still while the output moves. Look at the transmitter and its line."};
        case Verdict::undetermined:
            if (check.performance.variability == 0)
                return {record_again, Owner::operations, "Check this loop again when its unit runs, or leave it out."};
            return {test, Owner::control, "A test tells more: put the loop in manual for some periods, or step it."};
        case Verdict::insufficient_data:
            if (has_remark(check, kMeasurementAtLimit))
                return {check_range, Owner::instruments,
                        "Look at the range of the transmitter: at its end the measurement does not move, and the loop "
                        "does not see what it controls."};
            return {
                record_again, Owner::control,
                check.quality.rows == 0 ? "Check this loop again." : "Record again, for longer or with raw values."};
    }
    return {};
}

}  // namespace tunewright::check
