#include "engine/check/valve/valve_loop.h"

#include <cmath>

namespace tunewright::check {

ValveLoop::ValveLoop(const ValveModel& valve, const RowPlant& plant, const PiLaw& law)
    : valve_(valve, 0),
      K_(plant.K),
      a_(plant.lag > 0 ? std::exp(-1 / plant.lag) : 0),
      held_(std::size_t(plant.delay), 0.0),
      law_(law) {}

void ValveLoop::take(const PiLaw& law) {
    law_ = law;
    integral_ = u_ + law.Kp * y_;
}

// The order of a record: the measurement of a row, the output that answers it, and the position that moves the next
// rows.
void ValveLoop::advance(double load) {
    y_ = a_ * y_ + (1 - a_) * K_ * held_[at_];
    const double e = -y_;
    if (std::abs(e) > law_.gap) integral_ += law_.Kp * e / law_.Ti;
    u_ = law_.Kp * e + integral_;
    held_[at_] = valve_.move(u_) + load;
    at_ = at_ + 1 == held_.size() ? 0 : at_ + 1;
}

}  // namespace tunewright::check
