// Today's settings from a record of a closed loop: the question and the answer of POST /v1/records/controller.
#pragma once

#include <optional>
#include <string>

#include "api/contract/device/device.h"
#include "api/contract/product/conversion.h"
#include "api/contract/record.h"
#include "api/describe/description.h"
#include "engine/request/recorded_controller.h"

namespace tunewright::api {

struct ControllerRecordRequest {
    std::optional<std::string> name;
    std::optional<Units> units;
    std::optional<GivenRecord> record;
    std::optional<double> sample_time;  ///< of the controller; else that of implement
    std::optional<GivenDevice> implement;
    ReadRecord read;                            ///< of `record`
    std::optional<device::DeviceModel> device;  ///< of `implement`
};
const Description<ControllerRecordRequest>& controller_record_request_contract();

struct ControllerRecordAnswer {
    std::optional<IdentifiedController> found;
    std::optional<std::string> not_identified;  ///< the reason why the record does not show the settings
    std::optional<SettingsAnswer> typing;       ///< in the product of the request
    std::optional<std::string> not_typed;       ///< the reason why its product cannot have these settings
};
const Description<ControllerRecordAnswer>& controller_record_answer_contract();

}  // namespace tunewright::api
