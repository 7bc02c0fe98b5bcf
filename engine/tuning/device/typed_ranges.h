// What can be typed of the gain and the times of a product's own form: ranges, and the values on either side where
// steps are coarse.
#pragma once

#include <vector>

#include "engine/controller/product/formula.h"
#include "engine/tuning/device/device_model.h"

namespace tunewright::device {

/// Gain, Ti or Td, where a number of its own sets it. Of a parallel form, whose numbers for the times are gains, and
/// without a product: anything.
class TypedQuantity {
public:
    TypedQuantity(const DeviceModel& device, product::ParameterRole role);

    /// Of its size, times in the plant's unit.
    const Shape::Range& range() const { return range_; }
    /// The step in which its number can be typed, relative to that number; 0: none.
    double step(double size) const;
    /// What can be typed next below and above, where there is a step. 0 is among them for Td alone.
    std::vector<double> choices(double size) const;

private:
    double number(double size) const;
    double size(double number) const;

    const product::Parameter* parameter_ = nullptr;
    product::Quantities others_;
    double product::Quantities::*quantity_ = nullptr;
    double exponent_ = 1, unit_ = 1;
    bool may_vanish_ = false;
    Shape::Range range_;
};

}  // namespace tunewright::device
