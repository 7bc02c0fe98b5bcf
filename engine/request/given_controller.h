// A controller that the user gives: today's settings, or settings that the user chose.
#pragma once

#include <concepts>
#include <optional>
#include <utility>

#include "engine/controller/pid.h"
#include "engine/evaluation/evaluation.h"
#include "engine/expected.h"
#include "engine/plant/analysed_plant.h"
#include "engine/progress.h"
#include "engine/request/device_entry.h"
#include "engine/tuning/device/device_model.h"

namespace tunewright {

struct GivenController {
    /// Settings as typed into a product.
    struct Typed {
        device::DeviceModel device;
        device::Fitted fitted;
    };
    Controller law;              ///< that of `typed` in continuous time
    std::optional<Typed> typed;  ///< empty: a law was given

    template <class Law>
    requires std::constructible_from<Controller, Law> GivenController(Law&& given, std::optional<Typed> settings = {})
        : law(std::forward<Law>(given)), typed(std::move(settings)) {}
};

/// Settings typed into a product, which must be set in `device`. Errors: those of device::fit.
Expected<GivenController> typed_controller(const device::DeviceModel& device, const product::Settings& settings);

/// The evaluated controller in the product into which it was typed, whatever `device` is; a law in `device`; empty
/// without either. Adds the warnings of take_device_entry() to `ideal`.
std::optional<DeviceEntry> device_entry_of(const AnalysedPlant& subject, const GivenController& given,
                                           const std::optional<device::DeviceModel>& device,
                                           const EvaluateOptions& options, Evaluation& ideal,
                                           const RunControl& control);

}  // namespace tunewright
