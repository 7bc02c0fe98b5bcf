// A quantity at one instant, as steps need it.
#pragma once

namespace tunewright {

struct Signal {
    double value = 0, slope = 0;
};

}  // namespace tunewright
