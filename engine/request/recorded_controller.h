// Today's settings from a record, in the user's own controller.
#pragma once

#include <map>
#include <optional>
#include <string>

#include "engine/controller/product/settings.h"
#include "engine/identification/controller_law/identify_controller.h"
#include "engine/tuning/device/device_model.h"

namespace tunewright {

struct RecordedController {
    IdentifiedController found;
    /// The same in the product of the device. What the record does not show is as the product has it: the set-point
    /// weights unless the set point moves.
    std::optional<product::Converted> settings;
    std::map<std::string, double> settings_errors;  ///< product/settings_errors.h
    std::string not_representable;                  ///< the reason if the product cannot have these settings, else ""
};

/// identify_controller for a loop that `device` controls (null: unknown): with its integral's rule, with its filter if
/// that fits as well as others, and with its sample time if `sample_time` is not given. Errors: those of
/// identify_controller.
Expected<RecordedController> recorded_controller(const Record& record, const device::DeviceModel* device,
                                                 std::optional<double> sample_time = {});

}  // namespace tunewright
