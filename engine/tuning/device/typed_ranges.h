// The possible values of the gain and the times of a product's own form: ranges, and for coarse steps the neighbouring
// values.
#pragma once

#include <vector>

#include "engine/controller/product/formula.h"
#include "engine/tuning/device/device_model.h"

namespace tunewright::device {

/// Gain, Ti or Td, if a number of the product sets it directly. Any value is possible for a parallel form, whose
/// numbers for the times are gains, and without a product.
class TypedQuantity {
public:
    TypedQuantity(const DeviceModel& device, product::ParameterRole role);

    /// Range of its size, times in the plant's unit.
    const Shape::Range& range() const { return range_; }
    /// The step of its number, relative to that number; 0: none.
    double step(double size) const;
    /// The next possible values below and above, if there is a step. Only Td can be 0.
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
