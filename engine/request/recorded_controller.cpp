#include "engine/request/recorded_controller.h"

#include <utility>

#include "engine/controller/product/settings_errors.h"

namespace tunewright {
namespace {

/// The filter of the product's law; empty if it has several or none is known.
std::optional<FilterType> filter_of(const product::Product& product) {
    switch (product.filter.kind) {
        case product::FilterKind::none: return FilterType::none;
        case product::FilterKind::measurement: return FilterType::measurement_second_order;
        case product::FilterKind::chosen:
        case product::FilterKind::unknown: return std::nullopt;
        default: return FilterType::derivative;
    }
}

/// A product's usual period is no statement about this loop.
std::optional<double> given_sample_time(const device::DeviceModel& device) {
    if (device.product != nullptr && !device.context.loop_clock_s) return std::nullopt;
    return device.sampled() ? std::optional(device.Ts) : std::nullopt;
}

}  // namespace

Expected<RecordedController> recorded_controller(const Record& record, const device::DeviceModel* device,
                                                 std::optional<double> sample_time) {
    ControllerRecordOptions options{.sample_time = sample_time};
    const product::Product* product = device != nullptr ? device->product : nullptr;
    if (device != nullptr) {
        if (!sample_time) options.sample_time = given_sample_time(*device);
        options.integral = product != nullptr ? product->algorithm.integral : device->integral;
        if (product != nullptr) options.filter = filter_of(*product);
    }
    auto found = identify_controller(record, options);
    if (!found) return found.error();
    RecordedController out{.found = std::move(*found), .settings = {}, .settings_errors = {}, .not_representable = {}};
    if (product == nullptr) return out;
    IdealPid& pid = out.found.pid;
    if (!out.found.b_known) pid.b = product->weights.b, pid.c = product->weights.c;
    auto converted = product::to_settings(*product, pid, device->context, true);
    if (!converted) {
        out.not_representable = converted.error().message;
        return out;
    }
    out.settings = std::move(*converted);
    out.settings_errors = product::settings_errors(*product, pid, out.found.standard_errors, device->context);
    return out;
}

}  // namespace tunewright
