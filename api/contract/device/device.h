// The user's own controller: in a request a product with its spans, or a program of the ideal form; in an answer the
// implemented loop.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "api/describe/description.h"
#include "engine/request/device_entry.h"

namespace tunewright::api {

inline constexpr std::size_t kMaxProductIdLength = 80;

/// The device as sent.
struct GivenDevice {
    std::optional<std::string> product;
    std::optional<std::vector<double>> y_span, u_span;
    std::optional<double> sample_time;
    std::optional<IntegralRule> integral;
    enum class Derivative { difference, filtered };
    std::optional<Derivative> derivative;
    std::optional<bool> velocity;
    double computation_delay = 0;
    double u_resolution = 0, y_resolution = 0, dead_band = 0;
};

const Description<GivenDevice>& implement_contract();

/// Reports at the reader's place if the product needs a span or a sample time that is not given.
void check_needs(const device::DeviceModel& device, Reader& reader);

/// The device of a request whose times are in `time_label` (units.time). Faults at the reader's place: an unknown
/// product, a label that is not a unit of time.
std::optional<device::DeviceModel> device_of(const GivenDevice& given, const std::string& time_label, Reader& reader);

/// {"sample_time", "robustness", "performance", "responses", "difference"}.
const Description<DeviceEntry>& implemented_contract();

}  // namespace tunewright::api
