// The traces of a result as CSV, one column each.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace tunewright::api {

enum class Traces {
    responses,  ///< over time: y and u after the set-point and the load step, of each entry
    frequency,  ///< over omega: L, |S|, |T| and |CS|, of each entry
    model,      ///< the record and the model that was identified from it
};

/// The traces of a result as one table, headings in the first line.
///
/// Columns such as "robust setpoint y [degC]" follow the column of their times: traces with the same times share it
/// ("t [s]"), others follow with their own ("robust t [s]"), and shorter ones end in empty cells. The second entry of a
/// method is "robust (2)". `result_json` is a result as the service wrote it; its labels of units are in the headings,
/// seconds if it has none. Empty if it has no such traces or is not a JSON object. Values have six significant digits,
/// times and frequencies as many as in the result:
///
///     t [s],robust setpoint y [degC],robust setpoint u [%],...
///     0,0,12.5,...
///
/// Traces of `frequency` have "omega [rad/s]" in place of the time, L as its parts and its phase in degrees, the
/// others as absolute values.
std::optional<std::string> traces_csv(std::string_view result_json, Traces traces);

}  // namespace tunewright::api
