// From a controller of the ideal form, or from limits, to the settings that a user types into his own controller, and
// to the law that it then computes.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "engine/controller/product/settings.h"
#include "engine/controller/sampled/pid_program.h"
#include "engine/expected.h"
#include "engine/progress.h"
#include "engine/tuning/device/settings_search.h"

namespace tunewright::device {

/// How the user's controller computes: a product, or a sampled program of the ideal form.
struct DeviceModel {
    const product::Product* product = nullptr;
    product::Context context = {};                   ///< of the product
    double Ts = 0;                                   ///< sample time, in the plant's unit; 0: continuous
    IntegralRule integral = IntegralRule::backward;  ///< this and the next two: without a product
    std::optional<DerivativeRule> derivative = {};   ///< empty: by the controller's filter
    bool velocity = false;
    double computation_delay = 0;  ///< time
    ProgramLimits program = {};    ///< what the program has beside the law

    bool sampled() const { return Ts > 0; }
};

/// A controller as it is typed.
struct Fitted {
    const product::Product* product = nullptr;
    IdealPid controller;         ///< the exact ideal twin of what is typed
    Law law;                     ///< what it computes
    product::Settings settings;  ///< in full precision, before they are rounded; empty without a product
    product::Settings typed;     ///< as the texts say
    std::vector<std::string> texts;
    std::vector<product::Note> notes;
};

/// Converted and rounded, nothing searched. Errors: those of product::to_settings.
Expected<Fitted> fit(const DeviceModel& device, const IdealPid& pid, bool nearest = false);

/// The same of settings as they stand in the product.
Expected<Fitted> fit(const DeviceModel& device, const product::Settings& typed);

/// The same loop as a continuous one can be: a difference of r without a filter has no finite step response there, so c
/// is 0 then.
IdealPid continuous(IdealPid pid);

/// What a design is asked for.
struct Wish {
    PeakLimits limits;
    bool pid = true;  ///< false: PI
    double sign = 1;  ///< of Kp
    double b = 1;     ///< set-point weight, as near as the controller has it
    /// Tf for a Td of the controller's own form, where it has a filter to set; empty: none.
    std::function<double(double Td)> filter_time = {};
    FilterType filter = FilterType::none;  ///< without a product
    IdealPid start;                        ///< a design of the ideal form nearby
};

/// Where the plant's dead time is no dead time for this sample time (loop/sampled/held_plant.h).
std::optional<Error> refuse_sampling(const DeviceModel& device, const LinearPlant& plant);

/// The settings with the least load IAE on the first plant, limits held on all, as typed: on the controller's own law
/// and grid of settings. Errors: no_feasible_controller, not_representable, cancelled.
Expected<Fitted> design(const DeviceModel& device, const std::vector<const LinearPlant*>& plants, const Wish& wish,
                        const RunControl& control);

}  // namespace tunewright::device
