// Reads a controller from a text of control software.
//
//   read_controller("pidstd(1.5, 120, 20, 10)")                     settings of the product matlab_pidstd
//   read_controller("C = 1.5 + 0.0125/s + 30*s/(2*s + 1)")          settings of the product python_control
#pragma once

#include <string>
#include <string_view>

#include "engine/controller/product/settings.h"
#include "engine/expected.h"

namespace tunewright::api {

struct TypedController {
    std::string product;  ///< id
    product::Settings settings;
};

/// A text of at most typed::kMaxLength bytes: the call of a product's constructor (catalogue.h), or a transfer
/// function of PID form in the words of a plant (typed_plant.h), which becomes Kp, Ki, Kd and Tf. Its times are in the
/// unit of the product, s. An infinite time or ratio is left out of the settings. Errors (invalid_argument): the
/// position and the cure; a call that belongs to several products; a controller with a dead time, or of another
/// structure.
Expected<TypedController> read_controller(std::string_view text);

}  // namespace tunewright::api
