// A table of settings over the scheduling variable, and the settings between its rows.
#pragma once

#include <cstddef>
#include <string_view>
#include <vector>

#include "engine/controller/pid.h"

namespace tunewright {

/// How the user's controller moves between the rows of its schedule.
enum class Interpolation {
    steps,            ///< a row's settings hold from its value on, with hysteresis
    linear_in_gains,  ///< Kp, 1/Ti and Td are linear between rows
    linear_in_times,  ///< Kp, Ti and Td are linear between rows
};

/// Name of the interpolation: "steps", "linear_in_gains", "linear_in_times".
std::string_view to_string(Interpolation interpolation);

/// The ideal form (controller/pid.h). Tf = 0: no filter.
struct ScheduleRow {
    double at = 0;
    double Kp = 0, Ti = 0, Td = 0, Tf = 0, b = 1;
};

/// Below the first row and above the last one, the settings of that row hold.
struct Schedule {
    Interpolation interpolation = Interpolation::linear_in_gains;
    double hysteresis = 0;          ///< for `steps`, in the unit of `at`: a row is left h/2 beyond its border
    std::vector<ScheduleRow> rows;  ///< ascending, at least one
};

/// The controller of one row, with a second-order filter of the measurement.
IdealPid controller_of(const ScheduleRow& row);

/// The controller's settings at a value of the scheduling variable. Linear kinds: b and Tf are linear too. `steps`: the
/// row whose border was passed last, without hysteresis.
IdealPid settings_at(const Schedule& schedule, double at);

/// For `steps`: the row in use at a value, after `row`: a row is left when `at` is half the hysteresis beyond its
/// border.
std::size_t row_after(const Schedule& schedule, std::size_t row, double at);

}  // namespace tunewright
