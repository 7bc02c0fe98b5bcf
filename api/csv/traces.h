// A result's traces as CSV, one column each.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace tunewright::api {

enum class Traces {
    responses,  ///< y and u after the set-point and the load step, of each entry
    frequency,  ///< L, |S|, |T| and |CS|, of each entry
    model,      ///< the record beside the model that was found in it
};

/// Columns such as "robust setpoint y [degC]", behind the column of their own times: traces of the same times share it
/// ("t [s]"), others stand beside them with their own ("robust t [s]"), and the shorter ones end in empty cells. The
/// second entry of a method is "robust (2)". Nothing where the result has no such traces.
std::optional<std::string> traces_csv(std::string_view result_json, Traces traces);

}  // namespace tunewright::api
