// The bump: a step of u until y has settled, and back.
#pragma once

#include "engine/code/experiment/frame.h"

namespace tunewright::code {

class BumpTest : public ExperimentFrame {
public:
    explicit BumpTest(const ExperimentOptions& options);

private:
    Block begin() override;
    Block first() override;
    Block move() override;
    Expr impossible() override;
    std::vector<std::string> notes() override;

    Block window();
    Block compare();
    Block go_back();

    Expr y_move_ = 0, level_ = 0, window_end_ = 0, window_sum_ = 0, window_calls_ = 0, mean_ = 0, windows_ = 0,
         steady_ = 0, moved_ = 0, up_time_ = 0;
    // Locals of a call.
    Expr deviation_ = 0, size_ = 0, elapsed_ = 0, mean_now_ = 0, mean_change_ = 0;
};

}  // namespace tunewright::code
