// Converts a controller of the ideal form, or limits, to the settings that a user enters into a controller, and to the
// law that it then computes.
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

/// The user's controller: a product, or a sampled program of the ideal form.
struct DeviceModel {
    const product::Product* product = nullptr;
    product::Context context = {};                   ///< context of the product
    double Ts = 0;                                   ///< sample time, in the plant's unit; 0: continuous
    IntegralRule integral = IntegralRule::backward;  ///< this and the next two only without a product
    std::optional<DerivativeRule> derivative = {};   ///< empty: chosen by the controller's filter
    bool velocity = false;
    double computation_delay = 0;  ///< time
    ProgramLimits program = {};    ///< nonlinear parts of the program

    bool sampled() const { return Ts > 0; }
};

/// A controller with its settings as entered.
struct Fitted {
    const product::Product* product = nullptr;
    product::Context context = {};    ///< of the conversion
    IdealPid controller = {};         ///< the exact ideal equivalent of these settings
    Law law = {};                     ///< the law that it computes
    product::Settings settings = {};  ///< in full precision, before rounding; empty without a product
    product::Settings typed = {};     ///< the values of the texts
    std::vector<std::string> texts = {};
    std::vector<product::Note> notes = {};
};

/// Converts and rounds, without a search. Errors: those of product::to_settings.
Expected<Fitted> fit(const DeviceModel& device, const IdealPid& pid, bool nearest = false);

/// The same for given settings of the product.
Expected<Fitted> fit(const DeviceModel& device, const product::Settings& typed);

/// The controller for the same loop in continuous time: a difference of r without a filter has no finite step response
/// there, so c becomes 0.
IdealPid continuous(IdealPid pid);

/// The specification of a design.
struct Wish {
    PeakLimits limits;
    bool pid = true;  ///< false: PI
    double sign = 1;  ///< of Kp
    double b = 1;     ///< set-point weight; the controller has the nearest possible one
    /// Tf for a Td of the controller's own form, if its filter can be set; empty: no filter.
    std::function<double(double Td)> filter_time = {};
    FilterType filter = FilterType::none;  ///< only without a product
    IdealPid start;                        ///< a design of the ideal form, from which the search starts
};

/// An error if the sample time is too short for the plant's dead time (loop/sampled/held_plant.h).
std::optional<Error> refuse_sampling(const DeviceModel& device, const LinearPlant& plant);

/// The settings with the least load IAE on the first plant that keep the limits on all plants, with the controller's
/// own law and the resolution of its settings. Errors: no_feasible_controller, not_representable, cancelled.
Expected<Fitted> design(const DeviceModel& device, const std::vector<const LinearPlant*>& plants, const Wish& wish,
                        const RunControl& control);

}  // namespace tunewright::device
