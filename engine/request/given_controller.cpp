#include "engine/request/given_controller.h"

namespace tunewright {

Expected<GivenController> typed_controller(const device::DeviceModel& device, const product::Settings& settings) {
    auto fitted = device::fit(device, settings);
    if (!fitted) return fitted.error();
    Controller law = device::continuous(fitted->controller);
    return GivenController(std::move(law), GivenController::Typed{device, std::move(*fitted)});
}

std::optional<DeviceEntry> device_entry_of(const AnalysedPlant& subject, const GivenController& given,
                                           const std::optional<device::DeviceModel>& device,
                                           const EvaluateOptions& options, Evaluation& ideal,
                                           const RunControl& control) {
    std::optional<DeviceEntry> on_device;
    if (given.typed)
        take_device_entry(judge_device(subject, given.typed->device, given.typed->fitted, options, ideal), ideal,
                          on_device);
    else if (device)
        take_device_entry(device_entry_of(subject, *device, options, ideal, control), ideal, on_device);
    return on_device;
}

}  // namespace tunewright
