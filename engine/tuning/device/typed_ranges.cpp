#include "engine/tuning/device/typed_ranges.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/controller/product/needs.h"

namespace tunewright::device {
TypedQuantity::TypedQuantity(const DeviceModel& device, product::ParameterRole role) {
    using product::Quantities, product::Term;
    if (device.product == nullptr ||
        product::parameter_of(*device.product, product::ParameterRole::multiplier) != nullptr)
        return;
    const product::Parameter* parameter = product::parameter_of(*device.product, role);
    if (parameter == nullptr || parameter->shape != product::Shape::power) return;
    const Term& term = parameter->term;
    const bool gain = role == product::ParameterRole::gain;
    if (!gain && term.Kp != 0) return;
    quantity_ = gain ? &Quantities::Kp : role == product::ParameterRole::integral ? &Quantities::Ti : &Quantities::Td;
    exponent_ = gain ? term.Kp : role == product::ParameterRole::integral ? term.Ti : term.Td;
    if (exponent_ == 0) return;
    others_ = product::quantities_of(*device.product, device.context);
    unit_ = gain ? 1 : device.context.seconds_per_time;
    may_vanish_ = role == product::ParameterRole::derivative;
    parameter_ = parameter;
    // A gain may be entered with either sign; its size counts.
    constexpr double kUnbounded = std::numeric_limits<double>::infinity();
    const bool turned = term.factor < 0;
    const double low = std::max(turned ? -parameter->range.high : parameter->range.low, 0.0),
                 high = turned ? -parameter->range.low : parameter->range.high;
    const auto end = [&](double number) {
        if (number > 0 && number < kUnbounded) return size(turned ? -number : number);
        return (number > 0) == (exponent_ > 0) ? kUnbounded : 0;
    };
    const double a = end(low), b = end(high);
    range_ = {std::min(a, b), std::max(a, b)};
}

double TypedQuantity::size(double number) const {
    return product::solved(parameter_->term, others_, quantity_, exponent_, number) / unit_;
}

double TypedQuantity::number(double size) const {
    product::Quantities all = others_;
    all.*quantity_ = size * unit_;
    return product::value_of(parameter_->term, all);
}

double TypedQuantity::step(double size) const {
    if (parameter_ == nullptr || !(size > 0)) return 0;
    return parameter_->resolution / std::abs(number(size));
}

std::vector<double> TypedQuantity::choices(double size) const {
    const double step = parameter_->resolution, at = number(size);
    std::vector<double> sizes;
    for (const double near : {std::floor(at / step) * step, std::ceil(at / step) * step}) {
        const bool takes = near >= parameter_->range.low && near <= parameter_->range.high;
        if (!takes || (near == 0 && !may_vanish_)) continue;
        sizes.push_back(near == 0 ? 0 : this->size(near));
    }
    return sizes;
}

}  // namespace tunewright::device
