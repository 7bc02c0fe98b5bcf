// The relay test: u switches between two levels as y leaves a band about its level, until the cycle is steady.
#pragma once

#include "engine/code/experiment/frame.h"

namespace tunewright::code {

class RelayTest : public ExperimentFrame {
public:
    explicit RelayTest(const ExperimentOptions& options);

private:
    void declare_states();
    Block begin() override;
    Block first() override;
    Block move() override;
    Expr impossible() override;
    std::vector<std::string> notes() override;

    Block find_sign();
    Block relay();
    Block switched();
    Block end_of_cycle();
    Block compare();
    Block stuck();

    Expr asymmetry_ = 0, cycles_wanted_ = 0, sign_ = 0, sign_found_ = 0, up_ = 0, u_up_ = 0, u_down_ = 0, turned_ = 0;
    Expr y_high_ = 0, y_low_ = 0, cycles_ = 0, period_ = 0, amplitude_ = 0, steady_ = 0, t_cycle_ = 0;
    Expr longest_half_ = 0, beyond_ = 0;
    // Locals of a call.
    Expr deviation_ = 0, error_ = 0, half_ = 0, size_ = 0, period_now_ = 0, amplitude_now_ = 0, period_change_ = 0,
         amplitude_change_ = 0;
};

}  // namespace tunewright::code
