// A result's traces as CSV, one column each.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace tunewright::api {

enum class Traces {
    responses,  ///< over time: y and u after the set-point and the load step, of each entry
    frequency,  ///< over omega: L, |S|, |T| and |CS|, of each entry
    model,      ///< the record beside the model that was found in it
};

/// The traces of a result as one table, headings in the first line.
///
/// Columns such as "robust setpoint y [degC]", behind the column of their own times: traces of the same times share it
/// ("t [s]"), others stand beside them with their own ("robust t [s]"), and the shorter ones end in empty cells. The
/// second entry of a method is "robust (2)". `result_json` is a result as the service wrote it; its labels of units
/// stand in the headings, seconds where it has none. Nothing where it has no such traces or is not a JSON object.
/// Values have six significant digits, times and frequencies as many as in the result:
///
///     t [s],robust setpoint y [degC],robust setpoint u [%],...
///     0,0,12.5,...
///
/// Traces of `frequency` have "omega [rad/s]" in place of the time, L as its parts and its phase in degrees, the others
/// as absolute values.
std::optional<std::string> traces_csv(std::string_view result_json, Traces traces);

}  // namespace tunewright::api
