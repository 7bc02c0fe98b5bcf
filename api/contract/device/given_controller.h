// A controller that a request gives: a law in one of the forms, or settings as typed into a product.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "api/contract/device/device.h"
#include "engine/request/given_controller.h"

namespace tunewright::api {

/// Settings as typed into a product.
struct TypedSettings {
    std::string product;
    product::Settings settings;
    std::optional<std::vector<double>> y_span, u_span;
    std::optional<double> sample_time;

    /// The device that holds these settings; spans and sample time that are not given are those of `others`.
    GivenDevice device(const std::optional<GivenDevice>& others) const;
};

/// The controller as sent: one of the first two.
struct SentController {
    std::optional<Controller> law;
    std::optional<TypedSettings> typed;
    std::optional<GivenController> given;  ///< made of it by resolve()
};

Codec<SentController> sent_controller();

/// Sets `given`; empty after a fault, which the reader then has at its place. `implement`: of the request, for spans
/// and sample time. `time_label`: units.time, a unit of time if there are typed settings.
void resolve(SentController& sent, const std::optional<GivenDevice>& implement, const std::string& time_label,
             Reader& reader);

}  // namespace tunewright::api
