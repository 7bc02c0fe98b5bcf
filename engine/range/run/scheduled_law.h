// The PID law with settings that change, as run_schedule integrates it.
#pragma once

#include <cstddef>
#include <span>

#include "engine/controller/schedule/schedule.h"
#include "engine/range/equations/steady_branch.h"

namespace tunewright::range {

/// States s: I, y_f, Tf y_f'. Without a filter y_f is y, and there is no derivative.
class ScheduledLaw {
public:
    static constexpr int kStates = 3;

    ScheduledLaw(const Schedule& schedule, Along along) : schedule_(schedule), along_(along) {}

    /// The scheduling variable.
    double place(std::span<const double> s, double y, double parameter) const {
        return along_ == Along::output ? y : along_ == Along::input ? s[0] : parameter;
    }
    /// The settings at this value; for `steps` those of the present row.
    IdealPid settings(double place) const;

    double command(const IdealPid& pid, double r, double y, std::span<const double> s) const;
    void rates(const IdealPid& pid, double r, double r_slope, double y, double excess, std::span<const double> s,
               std::span<double> ds) const;

    /// True if the schedule changes to another row at this value of the scheduling variable.
    bool leaves_row(double place) const {
        return schedule_.interpolation == Interpolation::steps && row_after(schedule_, row_, place) != row_;
    }
    void enter_row(double place) { row_ = row_after(schedule_, row_, place); }
    /// Sets the row that contains this value, at the start.
    void begin_at(double place);

private:
    const Schedule& schedule_;
    Along along_;
    std::size_t row_ = 0;
};

}  // namespace tunewright::range
